// Maps that are made as they are looked at say what all of them say, bit for bit.
#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>

#include "photile/photon_tracer.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene_renderer.hpp"
#include "photon_sets.hpp"
#include "picture_in_parts.hpp"
#include "pictures.hpp"
#include "render/hit_source.hpp"
#include "render/map_estimators.hpp"
#include "render/rendering.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

constexpr double radius = 0.3;

/// What MapEstimators are made of, in whole or in part.
struct PhotonsOfRoom {
  explicit PhotonsOfRoom(const Scene& from, MapMode mode) : scene(from) {
    PhotonTracerParameters tracing;
    tracing.emitted_photons = 20'000;
    photons = trace_photons(RayScene(scene), tracing).photons;
    groups = find_map_groups(scene, photons, mode, {radius, 60});
  }

  MapEstimators::Parts made(std::span<const std::uint8_t> wanted = {}) const {
    MapEstimators::Parts parts;
    parts.maps.emplace_back(test::device(), scene, photons, groups,
                            PhotonMapParameters{.radius = radius}, Progress::none(), wanted);
    parts.levels.push_back({.neighbours = 30});
    return parts;
  }

  const Scene& scene;
  Photons photons;
  NeighbourGroups groups;
};

}  // namespace

TEST_CASE("maps made in parts give the estimates of all, bit for bit") {
  const Scene scene = furnished_room(3);
  const MapMode mode = GENERATE(MapMode::automatic, MapMode::triangle);
  const PhotonsOfRoom room(scene, mode);
  const std::vector<double> powers(scene.lights.size(), 1.0);
  std::span<Device> devices(&test::device(), 1);
  MapEstimators all(
      devices, scene, [&] { return room.made(); }, powers);
  std::size_t made = 0;
  MapEstimators some(
      devices, scene, room.groups.patches,
      [&](std::span<const std::uint8_t> wanted) {
        ++made;
        return room.made(wanted);
      },
      powers);
  PrimaryHits hits = uniform_hits(scene, 600, 5);
  for (const std::size_t last : {20, 60, 100, 300, 600}) {
    PrimaryHits first = hits;
    first.position.resize(last);
    first.sided_triangle.resize(last);
    first.diffuse_albedo.resize(last);
    first.pixel.resize(last);
    first.throughput.resize(last);
    CHECK(some.estimate(first).irradiance == all.estimate(first).irradiance);
  }
  CHECK(made == 3);  // what was looked at first, then next, then the rest
}

TEST_CASE("a part of the maps holds the photons that are theirs among all") {
  const Scene scene = furnished_room(3);
  const PhotonsOfRoom room(scene, MapMode::automatic);
  std::vector<std::uint8_t> wanted(2 * room.groups.patches.count(), 0);
  for (std::size_t map = 0; map < wanted.size(); map += 3) wanted[map] = 1;
  const PhotonMaps all = std::move(room.made().maps.front());
  const PhotonMaps some = std::move(room.made(wanted).maps.front());
  CHECK(some.statistics().references < all.statistics().references);
  CHECK(some.statistics().references > 0);
  Estimator of_all(all, scene, {.neighbours = 30}), of_some(some, scene, {.neighbours = 30});
  PrimaryHits hits;
  const PrimaryHits everywhere = uniform_hits(scene, 2'000, 6);
  for (std::size_t hit = 0; hit < everywhere.size(); ++hit) {
    const std::uint32_t sided = everywhere.sided_triangle[hit];
    if (wanted[room.groups.patches.map(sided)] == 0) continue;
    hits.position.push_back(everywhere.position[hit]);
    hits.sided_triangle.push_back(sided);
  }
  hits.pixel.resize(hits.position.size());
  hits.throughput.resize(hits.position.size());
  hits.diffuse_albedo.resize(hits.position.size());
  REQUIRE(hits.size() > 100);
  const NeighbourLists expected = of_all.nearest(hits), found = of_some.nearest(hits);
  CHECK(found.photons == expected.photons);
  CHECK(found.squared_radius == expected.squared_radius);
}

TEST_CASE("a picture in many parts, whose maps are made on the way, is that by all maps") {
  const Scene scene = furnished_room(4);
  const RenderParameters parameters = small_picture(30'000, 65, 43);
  std::span<Device> devices(&test::device(), 1);
  // From close to the floor up to the ceiling: what is seen changes from row to row.
  const Camera camera = Camera::look_at({2, 0.2, 0.4}, {2, 2.5, 1.2}, {0, 0, 1}, 1.6);
  const RenderResult all =
      SceneRenderer(scene, devices, parameters).render(camera, parameters.film);
  CHECK(same_bits(picture_in_parts(scene, camera, parameters), all.layers));
}

TEST_CASE("a second picture finds what the first did not look at") {
  const Scene scene = furnished_room(4);
  const RenderParameters parameters = small_picture(30'000, 40, 30);
  std::span<Device> devices(&test::device(), 1);
  const PreparedScene prepared(scene);
  Rendering rendering(prepared, devices, parameters, Progress::none());
  rendering.expect_one_picture();
  rendering.prepare(0, nullptr, nullptr);
  SceneRenderer all(scene, devices, parameters);
  for (const double x : {0.5, 2.0, 3.5}) {
    const Camera camera = Camera::look_at({2, 1.5, 1.2}, {x, 0.1, 0.9}, {0, 0, 1}, 0.5);
    rendering.start(parameters.film);
    rendering.add_pass(CameraHits(camera));
    CHECK(same_bits(rendering.finish().layers, all.render(camera, parameters.film).layers));
  }
}

}  // namespace photile::test
