// Photons and groups saved and loaded: the same bits, and nothing that is not.
#include "saved_maps/saved_maps.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <limits>

#include "file_bytes.hpp"
#include "photile/errors.hpp"
#include "photile/renderer.hpp"
#include "temporary_folder.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

const saved_maps::Settings words{"words", "of groups"};

RenderParameters small(MapMode maps = MapMode::automatic) {
  RenderParameters parameters;
  parameters.photons.emitted_photons = 2'000;
  parameters.maps = maps;
  parameters.film.width = 24;
  parameters.film.height = 16;
  return parameters;
}

/// A file saved while a picture's maps are built.
struct Saved {
  explicit Saved(const Scene& scene, const RenderParameters& parameters = small())
      : file(folder.path / "maps.photile") {
    SceneRenderer renderer(
        scene, std::span(&device(), 1), parameters, nullptr,
        [&](const TracedPhotons& prepared) { saved_maps::save(file, scene, words, prepared); });
    layers = renderer.render(scene_camera(), parameters.film).layers;
  }

  static Camera scene_camera() {
    return Camera::look_at({0.5, 0.3, 1.5}, {2, 2, 0.5}, {0, 0, 1}, 1.0);
  }
  std::string bytes() const { return bytes_of(file); }
  void write(const std::string& bytes) const { put(file, bytes); }

  TemporaryFolder folder;
  std::filesystem::path file;
  LightLayers layers;
};

TEST_CASE("saving twice gives the same bytes") {
  const Scene scene = furnished_room();
  CHECK(Saved(scene).bytes() == Saved(scene).bytes());
}

TEST_CASE("a file cut off anywhere is refused") {
  const Scene scene = furnished_room();
  const Saved saved(scene);
  const std::string whole = saved.bytes();
  for (std::size_t i = 0; i < 300; ++i) {
    const std::size_t length = i < 100 ? i : (i - 100) * whole.size() / 200;
    saved.write(whole.substr(0, length));
    INFO(length << " of " << whole.size() << " bytes");
    REQUIRE_THROWS_AS(saved_maps::load(saved.file, scene, words), InputError);
  }
}

TEST_CASE("a file with any byte changed, or with more of them, is refused") {
  const Scene scene = furnished_room();
  const Saved saved(scene);
  const std::string whole = saved.bytes();
  for (std::size_t i = 0; i < 300; ++i) {
    std::string spoilt = whole;
    const std::size_t at = i < 120 ? i : (i - 120) * whole.size() / 180;
    spoilt[at] = static_cast<char>(spoilt[at] ^ (i % 2 == 0 ? 0x80 : 1));
    saved.write(spoilt);
    INFO("byte " << at);
    REQUIRE_THROWS_AS(saved_maps::load(saved.file, scene, words), InputError);
  }
  saved.write(whole + "x");
  CHECK_THROWS_WITH(saved_maps::load(saved.file, scene, words), Contains("after its end"));
}

/// Light maps of one view of a room, kept with their photons, and pictures from them.
struct SavedRoom {
  explicit SavedRoom(int light_map_rays) : parameters(small()) {
    parameters.light_maps = LightMapMode::on;
    parameters.light_map_rays = light_map_rays;
    SceneRenderer renderer = made(parameters, nullptr, [&](const TracedPhotons& photons) {
      saved_maps::save(file, scene, words, photons);
    });
    CHECK_FALSE(renderer.light_maps());
    first = draw(renderer, Saved::scene_camera(), all);
    saved_maps::add_light_maps(file, *renderer.light_maps());
    saved_maps::add_light_maps(file, *renderer.light_maps());  // in place of the first
    aside = draw(renderer, towards_a_corner(), all);
    layers = renderer.render(Saved::scene_camera(), parameters.film).layers;
  }

  static Camera towards_a_corner() {
    return Camera::look_at({0.5, 0.3, 1.5}, {0.1, 2.9, 0.2}, {0, 0, 1}, 1.0);
  }
  SceneRenderer made(const RenderParameters& with, TracedPhotons* prepared,
                     const KeepPhotons& keep = {}) const {
    return SceneRenderer(scene, std::span(&device(), 1), with, prepared, keep);
  }
  TracedPhotons loaded() const { return saved_maps::load(file, scene, words); }
  std::vector<glm::vec3> draw(SceneRenderer& renderer, const Camera& camera, double seconds) {
    std::vector<glm::vec3> picture(24 * 16);
    const std::vector<glm::vec3> powers(2, glm::vec3(1.0f));
    drawn = renderer.draw(camera, {24, 16, 1}, powers, seconds, picture);
    return picture;
  }
  std::string bytes() const { return bytes_of(file); }
  void refused(const std::string& bytes) const {
    put(file, bytes);
    REQUIRE_THROWS_AS(loaded(), InputError);
  }

  static constexpr double all = std::numeric_limits<double>::infinity();
  const Scene scene = furnished_room();
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "maps.photile";
  RenderParameters parameters;
  std::vector<glm::vec3> first, aside;  ///< frames of two views
  LightLayers layers;                   ///< of the first
  DrawnFrame drawn;
};

TEST_CASE("light maps are kept with their photons, and read again without an estimate") {
  SavedRoom room(GENERATE(0, 16));  // nodes by photons, and by rays
  TracedPhotons prepared = room.loaded();
  REQUIRE(prepared.light_maps);
  SECTION("the same settings") {
    SceneRenderer renderer = room.made(room.parameters, &prepared);
    CHECK(room.draw(renderer, Saved::scene_camera(), 0) == room.first);
    CHECK(room.drawn.lacking == 0);
    room.draw(renderer, SavedRoom::towards_a_corner(), 0);
    CHECK(room.drawn.lacking > 0);
    CHECK(room.draw(renderer, SavedRoom::towards_a_corner(), SavedRoom::all) == room.aside);
    const LightLayers again = renderer.render(Saved::scene_camera(), room.parameters.film).layers;
    CHECK(again.layers[1].radiance == room.layers.layers[1].radiance);
  }
  SECTION("another k, or other rays: nodes are made anew") {
    RenderParameters other = room.parameters;
    SECTION("k") { other.neighbours /= 2; }
    SECTION("rays") { other.light_map_rays = other.light_map_rays > 0 ? 0 : 16; }
    if (other.light_map_rays > 0 && !prepared.caustics) {
      CHECK_THROWS_WITH(room.made(other, &prepared), Contains("caustics"));
      return;
    }
    SceneRenderer renderer = room.made(other, &prepared);
    room.draw(renderer, Saved::scene_camera(), 0);
    CHECK(room.drawn.lacking > 0);
  }
  SECTION("light maps off: photons alone") {
    SceneRenderer renderer = room.made(small(), &prepared);
    const RenderResult result = renderer.render(Saved::scene_camera(), room.parameters.film);
    CHECK(result.layers.layers.size() == 2);
  }
}

TEST_CASE("a file whose light maps are damaged, or cut off anywhere, is refused") {
  const SavedRoom room(16);
  const std::string whole = room.bytes();
  std::uint64_t photon_bytes = 0;
  std::memcpy(&photon_bytes, whole.data() + 40, sizeof photon_bytes);
  const std::size_t photons_end = 104 + photon_bytes;
  REQUIRE(photons_end + 1000 < whole.size());
  room.refused(whole.substr(0, photons_end));  // all photons, and nothing after them
  for (std::size_t i = 0; i < 100; ++i) {
    const std::size_t at =
        photons_end + (i < 40 ? i : 32 + (i - 40) * (whole.size() - photons_end) / 80);
    std::string spoilt = whole;
    spoilt[at] = static_cast<char>(spoilt[at] ^ 4);
    INFO("byte " << at);
    room.refused(spoilt);
    room.refused(whole.substr(0, at + 1));
  }
  LightMapContents foreign = *[&] {
    put(room.file, whole);
    return room.loaded().light_maps;
  }();
  foreign.error.pop_back();
  saved_maps::add_light_maps(room.file, foreign);
  TracedPhotons prepared = room.loaded();
  CHECK_THROWS_AS(room.made(room.parameters, &prepared), InputError);
}

TEST_CASE("another scene, other settings and other files are told apart") {
  const Scene scene = furnished_room();
  const Saved saved(scene);
  Scene moved = scene;
  moved.vertices[3].x += 1e-4f;
  CHECK_THROWS_WITH(saved_maps::load(saved.file, moved, words), Contains("another scene"));
  Scene painted = scene;
  painted.materials[0].diffuse.g += 1e-3f;
  CHECK_THROWS_WITH(saved_maps::load(saved.file, painted, words), Contains("another scene"));
  Scene lit = scene;
  lit.lights[1].position.z += 1e-4f;
  CHECK_THROWS_WITH(saved_maps::load(saved.file, lit, words), Contains("another scene"));
  Scene renamed = scene;
  renamed.source = "elsewhere/room.gltf";
  CHECK_NOTHROW(saved_maps::load(saved.file, renamed, words));
  CHECK_THROWS_WITH(saved_maps::load(saved.file, scene, {"other words", ""}),
                    Contains("words") && Contains("other words"));
  CHECK_THROWS_WITH(saved_maps::load(saved.file, scene, {"words", "of other groups"}),
                    Contains("of groups") && Contains("of other groups"));
  CHECK_THROWS_WITH(saved_maps::load(saved.folder.path / "none", scene, words),
                    Contains("no such file"));
  saved.write("v 0 0 0\n");
  CHECK_THROWS_WITH(saved_maps::load(saved.file, scene, words), Contains("no photon maps"));
}

TEST_CASE("another version or byte order is named") {
  const Scene scene = furnished_room();
  const Saved saved(scene);
  std::string bytes = saved.bytes();
  std::string newer = bytes;
  newer[8] = 9;
  saved.write(newer);
  CHECK_THROWS_WITH(saved_maps::load(saved.file, scene, words), Contains("version 9"));
  std::swap(bytes[12], bytes[15]);
  std::swap(bytes[13], bytes[14]);
  saved.write(bytes);
  CHECK_THROWS_WITH(saved_maps::load(saved.file, scene, words), Contains("byte order"));
}

TEST_CASE("a whole file whose indices lead nowhere is refused") {
  const Scene scene = furnished_room();
  const TemporaryFolder folder;
  const auto file = folder.path / "maps.photile";
  TracedPhotons good;
  const SceneRenderer renderer(scene, std::span(&device(), 1), small(), nullptr,
                               [&](const TracedPhotons& prepared) { good = prepared; });
  const auto refused = [&](const TracedPhotons& bad) {
    saved_maps::save(file, scene, words, bad);
    CHECK_THROWS_AS(saved_maps::load(file, scene, words), InputError);
  };
  saved_maps::save(file, scene, words, good);
  CHECK_NOTHROW(saved_maps::load(file, scene, words));
  TracedPhotons bad = good;
  SECTION("light") { bad.photons.light[0] = 7; }
  SECTION("triangle") { bad.photons.oriented_face[0] = 1'000'000; }
  SECTION("rows") { bad.photons.first_of[1] = 0xFFFF'FFFF; }
  SECTION("lengths") { bad.photons.flux.pop_back(); }
  SECTION("members") { bad.groups.members[0] = 1'000'000; }
  SECTION("offsets") { bad.groups.offsets[1] = ~std::uint64_t{0}; }
  SECTION("NaN") { bad.photons.position[0].x = std::nanf(""); }
  SECTION("radius") { bad.radius = 0; }
  SECTION("radius below 0") { bad.radius = -1; }
  SECTION("lights") { bad.photons.emitted_per_light.push_back(1); }
  SECTION("caustics") { bad.caustics.emplace(); }
  refused(bad);
}

}  // namespace
}  // namespace photile::test
