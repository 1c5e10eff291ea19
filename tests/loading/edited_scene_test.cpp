// Copies of scene files with other lights: what is written reads back as the same powers.
#include "writing/edited_scene.hpp"

#include <catch2/catch.hpp>

#include "file_bytes.hpp"
#include "photile/layered_picture.hpp"
#include "scene_files.hpp"
#include "source_folder.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

const MixedLight& light_of(const LightMix& mix, const std::string& name) {
  for (const MixedLight& light : mix.lights) {
    if (light.name == name) return light;
  }
  throw std::runtime_error("no light " + name);
}

/// A copy of a scene with changed lights.
struct ChangedCopy {
  ChangedCopy(const std::filesystem::path& file, const std::vector<LightChange>& changes,
              const std::string& name = "a", const SceneLoadOptions& options = {})
      : mix(LightMix::of(load_scene(file, options), 683)) {
    change_lights(mix, changes);
    written = writing::write_edited_scene(file, options, mix, name);
  }
  LightMix mix;  ///< what it is to hold
  writing::EditedScene written;
};

/// The lights of a copy beside what they were to be: lamps that are off are gone.
void check_reads_back(const ChangedCopy& copy) {
  CHECK(copy.written.left_out.empty());
  const LightMix read = LightMix::of(load_scene(copy.written.file), 683);
  std::size_t lit = 0;
  for (const MixedLight& light : copy.mix.lights) {
    if (light.power == 0) continue;
    ++lit;
    const MixedLight& again = light_of(read, light.name);
    INFO(light.name);
    CHECK(again.power == Approx(light.power).epsilon(1e-6));
    for (int c = 0; c < 3; ++c) {
      CHECK(again.color[c] == Approx(light.color[c] * light.tint[c]).epsilon(1e-5).margin(1e-6));
    }
  }
  CHECK(read.lights.size() == lit);
}

/// Two nodes with one mesh, "panel" and "second", two with one point light, "lamp" and "bulb".
nlohmann::json instances_document() {
  nlohmann::json document = square_document();
  document["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_emissive_strength"};
  document["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 10}, {"color", {1, 0.5, 0.25}}}};
  document["nodes"].push_back({{"name", "second"}, {"mesh", 0}, {"translation", {0, 0, 3}}});
  for (const char* name : {"lamp", "bulb"}) {
    nlohmann::json node{{"name", name}, {"translation", {0, 0, 2}}};
    node["extensions"]["KHR_lights_punctual"]["light"] = 0;
    document["nodes"].push_back(node);
  }
  document["scenes"][0]["nodes"] = {0, 1, 2, 3};
  return document;
}

/// The document with each light in a group alone.
nlohmann::json shared_document() {
  nlohmann::json document = instances_document();
  for (nlohmann::json& node : document["nodes"]) node["extras"]["photile_group"] = node["name"];
  return document;
}

std::filesystem::path write_scene(const SceneFolderOnDisk& folder, const nlohmann::json& document) {
  folder.write("square.bin", square_buffer());
  return folder.write("room.gltf", document.dump());
}

/// A copy of the scene with changed lights is read as they are.
void check_copy(const nlohmann::json& document, const std::vector<LightChange>& changes) {
  const SceneFolderOnDisk folder;
  check_reads_back(ChangedCopy(write_scene(folder, document), changes));
}

}  // namespace

TEST_CASE("lights that share a definition or a mesh are set apart in a copy of a glTF file") {
  const SceneFolderOnDisk folder;
  const auto file = write_scene(folder, shared_document());
  const std::string before = bytes_of(file);
  const ChangedCopy copy(file,
                         {{"lamp", "50"},
                          {"bulb", "x3"},
                          {"bulb", "2700K"},
                          {"panel", "x0.25"},
                          {"second", "#80ff40"}},
                         "late evening");
  CHECK(copy.written.file.filename() == "room.late_evening.gltf");
  check_reads_back(copy);
  CHECK(bytes_of(file) == before);
}

TEST_CASE("instances of one lamp stay one in a copy of a glTF file") {
  nlohmann::json document = instances_document();
  document["meshes"].push_back(document["meshes"][0]);  // of the same material, set by itself
  document["nodes"].push_back({{"name", "third"}, {"mesh", 1}, {"translation", {0, 0, 5}}});
  document["scenes"][0]["nodes"].push_back(4);
  REQUIRE(LightMix::of(load_gltf(document), 683).lights.size() == 3);
  check_copy(document, {{"lamp", "50"}, {"lamp", "2700K"}, {"panel", "x0.25"}});
}

TEST_CASE("nodes outside the scene may name what no file can hold") {
  nlohmann::json document = shared_document();
  for (const nlohmann::json& number : {nlohmann::json(1e300), nlohmann::json(-7)}) {
    nlohmann::json node{{"name", "stray"}, {"mesh", number}};
    node["extensions"]["KHR_lights_punctual"]["light"] = number;
    document["nodes"].push_back(node);
  }
  check_copy(document, {{"lamp", "50"}, {"panel", "x0.25"}});
}

TEST_CASE("a lamp that is off is written with intensity 0") {
  check_copy(shared_document(), {{"lamp", "off"}, {"panel", "off"}});
}

TEST_CASE("what photile_lumens and photile_kelvin say follows in a copy") {
  nlohmann::json document = shared_document();
  document["nodes"][0]["extras"].update(
      nlohmann::json{{"photile_lumens", 1200}, {"photile_kelvin", 4000}});
  for (const int node : {2, 3}) {
    document["nodes"][node]["extras"].update(
        nlohmann::json{{"photile_lumens", 300}, {"photile_kelvin", 3000}});
  }
  check_copy(document,
             {{"panel", "500"}, {"panel", "5000K"}, {"lamp", "100"}, {"bulb", "#ff0000"}});
}

TEST_CASE("lights of a group are scaled and tinted together in a copy") {
  nlohmann::json document = shared_document();
  for (const int node : {0, 2}) document["nodes"][node]["extras"]["photile_group"] = "all";
  check_copy(document, {{"all", "x0.5"}, {"all", "#ffc080"}});
}

TEST_CASE("a copy of a GLB keeps what follows its JSON") {
  const SceneFolderOnDisk folder;
  const ChangedCopy copy(folder.write("room.glb", glb_of(shared_document())),
                         {{"lamp", "x0.1"}, {"second", "x7"}});
  CHECK(copy.written.file.extension() == ".glb");
  check_reads_back(copy);
}

TEST_CASE("the bundled living room is copied with a mood") {
  const SceneFolderOnDisk folder;
  std::filesystem::copy(source_folder() / "scenes/living-room", folder.path,
                        std::filesystem::copy_options::recursive);
  check_reads_back(ChangedCopy(folder.path / "living-room.gltf", {{"daylight", "off"},
                                                                  {"floor_lamp", "400"},
                                                                  {"desk_lamp", "3000K"},
                                                                  {"sconce_left", "#ffd9a0"},
                                                                  {"picture_spot", "x2"}}));
}

TEST_CASE("an OBJ file is copied with a library of its own") {
  const SceneFolderOnDisk folder;
  folder.write("materials.mtl", lamp_and_wall);
  const auto file = folder.write(
      "room.obj", "mtllib materials.mtl\n" + unit_square +
                      "o panel\nusemtl lamp\nf 1 2 3 4\no floor\nusemtl wall\nf 1 2 3\n");
  const ChangedCopy copy(file, {{"panel", "x0.3"}, {"panel", "#ff8000"}}, "warm");
  CHECK(copy.written.file.filename() == "room.warm.obj");
  check_reads_back(copy);
  CHECK(bytes_of(folder.path / "materials.mtl") == lamp_and_wall);
}

TEST_CASE("lamps of one MTL material that are set differently are told and keep theirs") {
  const SceneFolderOnDisk folder;
  folder.write("materials.mtl", lamp_and_wall);
  const auto file = folder.write("room.obj", "mtllib materials.mtl\n" + unit_square +
                                                 "usemtl lamp\no one\nf 1 2 3\no two\nf 1 3 4\n");
  const auto [mix, copy] = ChangedCopy(file, {{"one", "x2"}});
  REQUIRE(copy.left_out.size() == 1);
  CHECK_THAT(copy.left_out[0], Contains("one") && Contains("two") && Contains("lamp"));
  CHECK(LightMix::of(load_scene(copy.file), 683).lights[0].power == Approx(mix.lights[1].power));
}

TEST_CASE("lights of options are told, and no file is written over another") {
  const SceneFolderOnDisk folder;
  const auto file = write_scene(folder, square_document());
  SceneLoadOptions options;
  options.sky = Sky{SkyKind::uniform, 1000};
  const auto [mix, copy] = ChangedCopy(file, {{"sky", "x0.5"}, {"panel", "x2"}}, "a", options);
  REQUIRE(copy.left_out.size() == 1);
  CHECK_THAT(copy.left_out[0], Contains("sky") && Contains("option"));
  CHECK_THROWS_WITH(writing::write_edited_scene(file, options, mix, "a"),
                    Contains("room.a.gltf") && Contains("exists already"));
}

}  // namespace photile::test
