// Edits of luminaires: what they do to the file, and what they leave alone.
#include "view/luminaire_editor.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "common/files.hpp"
#include "file_bytes.hpp"
#include "photile/errors.hpp"
#include "source_folder.hpp"
#include "temporary_folder.hpp"
#include "view/scene_loader.hpp"

namespace photile::test {
namespace {

using namespace photile::view;
using loading::PlacedLuminaires;

constexpr const char* two_records =
    R"([{"name": "panels", "file": "downlight.ies", "position": "ceiling", "size": [1.2, 0.3],
         "count": [3, 2], "spacing": [1.8, 2.4], "lumens": 3600.5, "inside": [0.1, 1.5, 0.5]},
        {"rotation": 30, "file": "downlight.ies", "position": [0.1, 2.4, -0.7],
         "size": [0.2, 0.2]}])";

/// A folder with the room of the gallery, a photometric file, and a list of luminaires.
struct Room : TemporaryFolder {
  std::filesystem::path scene = path / "room.gltf", list = path / "lamps.json";
  explicit Room(const char* entries = two_records) {
    const auto gallery = source_folder() / "scenes/gallery";
    std::filesystem::copy_file(gallery / "sun-and-sky.gltf", scene);
    std::filesystem::copy_file(gallery / "sun-and-sky.bin", path / "sun-and-sky.bin");
    std::filesystem::copy_file(gallery / "downlight.ies", path / "downlight.ies");
    if (entries) write_file(list, entries);
  }
  SceneLoadOptions options(const std::string& text) const {
    SceneLoadOptions options;
    options.luminaires = list;
    options.luminaires_text = text;
    return options;
  }
  loading::SourcedScene load(const std::string& text) const {
    return loading::load_sourced_scene(scene, options(text));
  }
  LuminaireEditor editor() const {
    const auto sourced = load(loading::read_own_luminaires(list).text());
    return {list, sourced.luminaires, sourced.scene};
  }
};

/// The middle of the openings of placed luminaires, in the scene.
glm::dvec3 middle_of(const Scene& scene, const Light& light) {
  glm::dvec3 sum(0.0);
  for (const std::uint32_t triangle : light.triangles) {
    for (const glm::vec3& corner : scene.corners(triangle)) sum += glm::dvec3(corner);
  }
  return sum / (3.0 * static_cast<double>(light.triangles.size()));
}

}  // namespace

TEST_CASE("a list of luminaires is written as it was read, member by member") {
  const auto list = loading::LuminaireList::parse(two_records, "test");
  CHECK(loading::LuminaireList::parse(list.text(), "test") == list);
  CHECK_THAT(list.text(),
             Catch::Contains(R"("position":"ceiling","size":[1.2,0.3],"count":[3,2])") &&
                 Catch::Contains(R"({"rotation":30,"file")"));
  const auto alone = loading::LuminaireList::parse(R"({"file": "a.ies"})", "test");
  CHECK(alone.text() == "{\"file\":\"a.ies\"}\n");
  CHECK_THROWS_AS(loading::LuminaireList::parse("{", "test"), InputError);
  CHECK(loading::LuminaireList().text() == "[]\n");
}

TEST_CASE("an edit changes its member alone, and the saved file makes the same scene") {
  const Room room;
  LuminaireEditor editor = room.editor();
  REQUIRE(editor.placed().size() == 2);
  CHECK_FALSE(editor.unsaved());
  editor.select(1);
  editor.set_position({0.25, 2.3, 0.5});
  editor.rotate(75);
  CHECK(editor.unsaved());
  CHECK(loading::read_own_luminaires(room.list) != editor.list());
  editor.save();
  CHECK_FALSE(editor.unsaved());
  auto expected = loading::LuminaireList::parse(two_records, "test");
  expected.entries[1]["position"] = {0.25, 2.3, 0.5};
  expected.entries[1]["rotation"] = 105.0;
  CHECK(loading::read_own_luminaires(room.list) == expected);
  // The saved file as any command reads it.
  SceneLoadOptions options;
  options.luminaires = room.list;
  const Scene scene = load_scene(room.scene, options);
  REQUIRE(scene.lights.size() == 7);
  CHECK(glm::distance(middle_of(scene, scene.lights.back()) + scene.origin,
                      glm::dvec3(0.25, 2.3, 0.5)) < 1e-5);
  CHECK(scene.lights.front().power == Approx(3600.5));
}

TEST_CASE("a file that cannot be written stays, and its changes are unsaved") {
  const Room room;
  LuminaireEditor editor = room.editor();
  editor.select(0);
  editor.remove();
  const std::string before = bytes_of(room.list);
  std::filesystem::rename(room.list, room.path / "kept.json");
  std::filesystem::create_directory(room.list);  // whatever may write, it cannot take its place
  CHECK_THROWS_AS(editor.save(), OutputError);
  CHECK(editor.unsaved());
  CHECK(bytes_of(room.path / "kept.json") == before);
}

TEST_CASE("a lamp is placed on a surface, and shines away from it") {
  const Room room(nullptr);  // a new file
  const auto dark = room.load("[]\n");
  REQUIRE(dark.scene.lights.size() == 1);  // to see by
  CHECK(dark.scene.lights[0].name == "work_light");
  LuminaireEditor editor(room.list, {}, dark.scene);
  CHECK(editor.next_file() == "downlight.ies");
  editor.place(glm::dvec3(0.5, 2.5, -0.5) - dark.scene.origin, {0, -1, 0});
  editor.place(glm::dvec3(-2, 1.5, 0) - dark.scene.origin, {1, 0, 0});
  REQUIRE(editor.list().entries.size() == 2);
  CHECK(editor.selected() == 1u);
  CHECK_FALSE(editor.list().entries[0].contains("aim"));
  CHECK(editor.list().entries[1]["name"] == "downlight_2");
  const auto lit = room.load(editor.list().text());
  REQUIRE(lit.scene.lights.size() == 2);
  CHECK(lit.scene.lights[1].direction == glm::vec3(1, 0, 0));
  for (std::size_t i : {0u, 1u}) {  // where the editor knew them to be
    CHECK(glm::distance(lit.luminaires[i].position, editor.placed()[i].position) < 1e-9);
    CHECK(lit.luminaires[i].axes == editor.placed()[i].axes);
    CHECK(lit.luminaires[i].opening == editor.placed()[i].opening);
    CHECK(glm::distance(middle_of(lit.scene, lit.scene.lights[i]), editor.placed()[i].position) <
          1e-5);
  }
  std::filesystem::remove(room.path / "downlight.ies");
  LuminaireEditor empty(room.list, {}, dark.scene);
  CHECK_THROWS_AS(empty.place({0, 0, 0}, {0, 1, 0}), UsageError);
}

TEST_CASE("rays meet openings, and what is held follows the pointer in its plane") {
  const Room room;
  LuminaireEditor editor = room.editor();
  const PlacedLuminaires& spot = editor.placed()[1];
  const glm::dvec3 eye = spot.position - glm::dvec3(0.3, 1.1, 0.2);
  const auto towards = [&](const glm::dvec3& place) { return glm::normalize(place - eye); };
  CHECK(editor.along(eye, towards(spot.position), 10) == 1u);
  CHECK_FALSE(editor.along(eye, towards(spot.position), 1));    // something hides it
  CHECK_FALSE(editor.along(eye, -towards(spot.position), 10));  // behind
  const glm::dvec3 beside = spot.position + 0.51 * spot.opening.x * spot.axes[0];
  CHECK_FALSE(editor.along(eye, towards(beside), 10));
  CHECK(editor.along(eye, towards(editor.placed()[0].middles()[4]), 10) == 0u);

  const glm::dvec3 start = spot.position, moved(0.4, 0, -0.3);
  CHECK_FALSE(editor.drag(eye, towards(start), towards(start + moved)));  // nothing is selected
  editor.select(1);
  CHECK(editor.drag(eye, towards(start), towards(start + moved)));
  CHECK(glm::distance(editor.placed()[1].position, start + moved) < 1e-9);
  CHECK_FALSE(editor.drag(eye, towards(start), {0, -1, 0}));  // the plane lies above
  editor.select(0);
  const glm::dvec3 middle = editor.placed()[0].position;
  editor.drag(eye, towards(middle), towards(middle + moved));
  CHECK(editor.list().entries[0]["position"].is_array());  // no longer "ceiling"
  CHECK_FALSE(editor.list().entries[0].contains("inside"));
  CHECK(editor.list().entries[0]["count"] == nlohmann::ordered_json({3, 2}));
}

TEST_CASE("copies stand beside the first under names of their own, and are removed alone") {
  const Room room;
  LuminaireEditor editor = room.editor();
  editor.duplicate();  // nothing is selected
  editor.remove();
  CHECK(editor.list().entries.size() == 2);
  editor.select(0);
  editor.duplicate();
  CHECK(editor.selected() == 2u);
  CHECK(editor.list().entries[2]["name"] == "panels_2");
  editor.duplicate();
  CHECK(editor.list().entries[3]["name"] == "panels_3");
  const auto scene = room.load(editor.list().text());
  CHECK(scene.luminaires[2].middles()[0].x ==
        Approx(scene.luminaires[0].middles()[2].x + 1.8).margin(2e-3));
  editor.set_array(2, 1, {1.5, 0});
  CHECK(room.load(editor.list().text()).luminaires[3].middles().size() == 2);
  editor.select(2);
  editor.remove();
  CHECK_FALSE(editor.selected());
  REQUIRE(editor.list().entries.size() == 3);
  CHECK(editor.placed().size() == 3);
  CHECK(editor.placed()[2].name == "panels_3");
}

TEST_CASE("a list that cannot be loaded is told, and the next one is loaded all the same") {
  const Room room;
  SceneLoader loader(room.scene, room.options("[]"));
  const auto wait = [&](const auto& condition) {
    for (int i = 0; i < 6000 && !condition(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  };
  loader.load(R"([{"file": "missing.ies", "position": [0, 1, 0]}])");
  std::exception_ptr error;
  wait([&] { return (error = loader.take_error()) != nullptr; });
  REQUIRE(error);
  CHECK_THROWS_WITH(std::rethrow_exception(error), Catch::Contains("luminaire 1"));
  loader.load("[]");
  std::optional<SceneLoader::Loaded> loaded;
  wait([&] { return (loaded = loader.take()).has_value(); });
  REQUIRE(loaded);
  CHECK(loaded->scene->scene.lights.size() == 1);
  CHECK_FALSE(loader.busy());
}

}  // namespace photile::test
