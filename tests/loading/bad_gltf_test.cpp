// glTF files that are refused, and damage at random.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "damaged_files.hpp"
#include "gltf/document.hpp"
#include "gltf/gltf_import.hpp"
#include "photile/limits.hpp"
#include "scene_files.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using nlohmann::json;

// What check_json refuses before tinygltf sees it, and what it lets through.

/// The square with its positions by a sparse accessor: of two, both replaced.
json sparse_document() {
  json document = square_document();
  document["accessors"][0]["sparse"] = {{"count", 2},
                                        {"indices", {{"bufferView", 2}, {"componentType", 5123}}},
                                        {"values", {{"bufferView", 0}}}};
  return document;
}

std::string refusal_of_text(const std::string& text) {
  const SceneFolderOnDisk folder;
  folder.write("square.bin", square_buffer());
  const std::string error = input_error_of([&] { load_scene(folder.write("scene.gltf", text)); });
  CHECK(error.find("json.exception") == std::string::npos);
  CHECK(error.find('\n') == std::string::npos);
  return error;
}

/// The refusal of the sparse square with one member replaced by what JSON has for it.
std::string refusal_with(const std::string& place, const std::string& value) {
  json document = sparse_document();
  document[json::json_pointer(place)] = "@";
  std::string text = document.dump();
  text.replace(text.find("\"@\""), 3, value);
  return refusal_of_text(text);
}

TEST_CASE("a message does not quote a buffer") {
  json document = square_document();
  document["buffers"][0]["uri"] =
      "data:application/octet-stream;base64," + std::string(400'000, 'A');
  document["buffers"][0]["byteLength"] = 7;
  CHECK(refusal_of_text(document.dump()).size() < 400);
  document = square_document();
  document["images"] = {{{"uri", std::string(400'000, 'a') + ".png"}}};
  document["textures"] = {{{"source", 0}}};
  document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  const SceneFolderOnDisk folder;
  folder.write("square.bin", square_buffer());
  for (const std::string& warning :
       load_scene(folder.write("scene.gltf", document.dump())).report.warnings) {
    CHECK(warning.size() < 600);
  }
}

TEST_CASE("offsets, strides and counts that are no whole numbers are refused by their place") {
  const auto [place, shown] = GENERATE(table<std::string, std::string>({
      {"/bufferViews/0/byteOffset", "bufferViews[0].byteOffset"},
      {"/bufferViews/1/byteLength", "bufferViews[1].byteLength"},
      {"/bufferViews/0/byteStride", "bufferViews[0].byteStride"},
      {"/buffers/0/byteLength", "buffers[0].byteLength"},
      {"/accessors/3/byteOffset", "accessors[3].byteOffset"},
      {"/accessors/0/count", "accessors[0].count"},
      {"/accessors/0/sparse/count", "accessors[0].sparse.count"},
      {"/accessors/0/sparse/indices/byteOffset", "accessors[0].sparse.indices.byteOffset"},
      {"/accessors/0/bufferView", "accessors[0].bufferView"},
      {"/accessors/0/componentType", "accessors[0].componentType"},
  }));
  const std::string value =
      GENERATE("-1", "1.5", "-0.0", "1e300", "true", "null", R"("12")", "[]", R"({"a": 1})");
  CAPTURE(place, value);
  CHECK_THAT(refusal_with(place, value),
             Contains("scene.gltf: malformed glTF: " + shown + " is ") &&
                 Contains("not a whole number from 0"));
}

TEST_CASE("numbers that would wrap into others are refused") {
  const std::string most = std::to_string(std::numeric_limits<int>::max());
  for (const char* place :
       {"/accessors/0/sparse/count", "/accessors/0/sparse/values/byteOffset",
        "/accessors/0/bufferView", "/nodes/0/mesh", "/scenes/0/nodes/0",
        "/meshes/0/primitives/0/attributes/POSITION", "/meshes/0/primitives/0/material"}) {
    const std::string value = GENERATE("2147483648", "4294967296", "18446744073709551615");
    CAPTURE(place, value);
    CHECK_THAT(refusal_with(place, value), Contains(value) && Contains("to " + most));
  }
  // Added to an address, they would wrap.
  for (const char* place : {"/bufferViews/0/byteOffset", "/accessors/0/count"}) {
    const std::string value = GENERATE("9007199254740993", "18446744073709551615");
    CAPTURE(place, value);
    CHECK_THAT(refusal_with(place, value), Contains(value) && Contains("to 9007199254740992"));
  }
}

TEST_CASE("a sparse accessor replaces one element at least, and no more than there are") {
  CHECK_THAT(refusal_with("/accessors/0/sparse/count", "0"), Contains("malformed sparse accessor"));
  CHECK_THAT(refusal_with("/accessors/0/sparse/count", "5"), Contains("malformed sparse accessor"));
  CHECK(refusal_with("/accessors/0/sparse/count", "2").empty());
}

TEST_CASE("numbers of extras and extensions are whatever their authors want") {
  json document = sparse_document();
  document["extras"] = {{"count", -1.5}, {"mesh", "front"}, {"list", {{{"nodes", {-1, "a"}}}}}};
  document["nodes"][0]["extensions"]["VENDOR_x"] = {{"source", -1}, {"attributes", {{"A", 0.5}}}};
  CHECK(refusal_of_text(document.dump()).empty());
}

TEST_CASE("what is no JSON is refused by its place, in no parser's words") {
  CHECK_THAT(refusal_of_text("{\"asset\": }"),
             Contains("malformed glTF") && Contains("byte 11 is no JSON"));
  CHECK_THAT(refusal_of_text("{\"asset\": 1e999}"), Contains("too large a number"));
  std::string text = sparse_document().dump();
  CHECK_THAT(refusal_of_text(text.insert(text.find("glow"), "\xff")), Contains("no JSON"));
}

TEST_CASE("a value of another type than the format has is refused in no parser's words") {
  for (const char* place : {"/asset", "/scenes", "/nodes", "/meshes/0/primitives", "/accessors/0",
                            "/bufferViews/0", "/buffers/0/uri", "/materials/0/emissiveFactor"}) {
    for (const char* value : {"[]", "{}", "7", R"("x")", R"({"x": 1})", "[[1]]"}) {
      CAPTURE(place, value);
      refusal_with(place, value);  // or none
    }
  }
}

TEST_CASE("more nodes or materials than the limit are refused while they are read") {
  for (const auto& [array, most] :
       {std::pair{"nodes", limits::max_nodes}, std::pair{"materials", limits::max_materials}}) {
    std::string text = fmt::format(R"({{"asset": {{"version": "2.0"}}, "{}": [{{}})", array);
    for (std::uint64_t i = 0; i < most; ++i) text += ",{}";
    CHECK_THAT(refusal_of_text(text + "]}"), Contains(array) && Contains("limit"));
  }
}

TEST_CASE("a graph of nodes of 2^22 paths is refused before it is walked") {
  constexpr int levels = 22;
  json document = square_document();
  document["nodes"] = json::array();
  for (int i = 0; i < levels; ++i) document["nodes"].push_back({{"children", {i + 1, i + 1}}});
  document["nodes"].push_back({{"mesh", 0}});
  CHECK_THAT(refusal_of_text(document.dump()), Contains("23 nodes") && Contains("instances"));
}

// Small glTF files that ask for more than any memory holds are refused before anything is read.

constexpr std::uint64_t many = limits::max_implicit_elements;

/// The square's mesh at 2^levels places, by nodes that have each child twice.
json placed_often(int levels) {
  json document = square_document();
  document["nodes"] = json::array();
  for (int i = 0; i < levels; ++i) document["nodes"].push_back({{"children", {i + 1, i + 1}}});
  document["nodes"].push_back({{"mesh", 0}});
  return document;
}

/// An accessor of so many elements of which the file holds one.
void make_sparse(json& accessor, std::uint64_t count, int values) {
  accessor.erase("bufferView");
  accessor["count"] = count;
  accessor["sparse"] = {{"count", 1},
                        {"indices", {{"bufferView", 2}, {"componentType", 5123}}},
                        {"values", {{"bufferView", values}}}};
}

/// Makes the square's mesh one of many / 3 triangles, nearly all of which have no area.
void make_large(json& document) {
  document["meshes"][0]["primitives"][0].erase("indices");
  make_sparse(document["accessors"][0], many, 0);
}

/// What the check says, without loading the scene: it may be too large for this machine.
std::string size_refusal(const json& document) {
  const SceneFolderOnDisk on_disk;
  on_disk.write("square.bin", square_buffer());
  const std::filesystem::path file = on_disk.write("scene.gltf", document.dump());
  Scene scene;
  const SceneLoadOptions options;
  files::SceneFolder folder(file, false);
  files::Warnings warnings;
  reading::AreaLights area_lights(scene);
  reading::ImportContext context{scene, folder, options, warnings, area_lights, {}};
  const tinygltf::Model model = gltf::read_gltf(context);
  const gltf::AccessorReader accessors(model, context);
  const auto visits = gltf::visit_nodes(model, context);
  return input_error_of([&] { gltf::check_scene_size(model, accessors, visits, context); });
}

TEST_CASE("a file of a kilobyte that asks for a hundred gigabytes is refused") {
  json document = placed_often(15);
  make_large(document);
  CHECK(document.dump().size() < 4'000);
  // 1.1e10 triangles: 131 GB for their indices alone.
  const std::string error = input_error_of([&] { load_gltf(document); });
  CHECK_THAT(error, Catch::Contains("scene.gltf") &&
                        Catch::Contains(std::to_string((many / 3) << 15)) &&
                        Catch::Contains("32768 instances of mesh 'square'") &&
                        Catch::Contains(std::to_string(limits::max_triangles)));
}

TEST_CASE("meshes are not repeated beyond the limit from files that hold few bytes") {
  json document = placed_often(4);
  make_large(document);
  CHECK_THAT(size_refusal(document),
             Catch::Contains(std::to_string(16 * (many / 3))) &&
                 Catch::Contains("no more than 51") &&  // 140 bytes, 5 nodes
                 Catch::Contains("mesh 'square'") && Catch::Contains("in 16 instances"));
  document = placed_often(1);
  make_large(document);
  CHECK(2 * (many / 3) < limits::unchecked_triangles);
  CHECK(size_refusal(document).empty());
}

TEST_CASE("vertices that no triangle uses, and primitives without any, count too") {
  json document = placed_often(4);
  for (const int accessor : {0, 1, 3}) make_sparse(document["accessors"][accessor], many, 0);
  CHECK_THAT(size_refusal(document), Catch::Contains("repeat fewer"));
  document = placed_often(15);
  json& primitives = document["meshes"][0]["primitives"];
  for (int i = 0; i < 1'000; ++i) primitives.push_back({{"attributes", {{"TEXCOORD_0", 1}}}});
  CHECK_THAT(size_refusal(document), Catch::Contains("repeat fewer"));
}

TEST_CASE("meshes that share a buffer count each") {
  json document = square_document();
  make_large(document);
  for (int i = 1; i < 16; ++i) {
    document["meshes"].push_back(document["meshes"][0]);
    document["nodes"].push_back({{"mesh", i}});
    document["scenes"][0]["nodes"].push_back(i);
  }
  CHECK_THAT(size_refusal(document), Catch::Contains("repeat fewer"));
}

TEST_CASE("counts do not wrap") {
  json document = placed_often(12);
  document["accessors"][2]["count"] = 1ull << 53;
  CHECK_THAT(size_refusal(document), Catch::Contains("triangles"));
}

TEST_CASE("a large file may place each triangle that it holds a thousand times") {
  json document = square_document();
  const std::uint64_t held = 140 / 3 + 1'200;  // bytes and nodes
  for (int i = 1; i < 1'200; ++i) document["nodes"].push_back(json::object());
  const std::uint64_t most = held * limits::max_triangle_expansion;
  CHECK(most > limits::unchecked_triangles);
  document["accessors"][2]["count"] = 3 * most;  // the reader would not believe it
  CHECK(size_refusal(document).empty());
  document["accessors"][2]["count"] = 3 * most + 3;
  CHECK_THAT(size_refusal(document), Catch::Contains("repeat fewer"));
}

// glTF files damaged at random, with fixed seeds: each is a sound scene or an InputError of one
// line.

/// A document with something of everything that is read.
json rich_document() {
  json document = square_document();
  document["extensionsUsed"] = {"KHR_lights_punctual", "KHR_texture_transform"};
  document["scenes"].push_back({{"name", "other"}, {"nodes", {4}}});
  document["nodes"].insert(
      document["nodes"].end(),
      {{{"name", "bulb"},
        {"translation", {0, 0, 1}},
        {"extras", {{"photile_group", "bulbs"}, {"photile_kelvin", 2700}}},
        {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
       {{"name", "eye"}, {"camera", 0}, {"rotation", {0, 0.6, 0, 0.8}}, {"translation", {0, 0, 3}}},
       {{"name", "tree"}, {"children", {1, 2, 4}}, {"scale", {1, 2, -1}}},
       {{"name", "leaf"},
        {"mesh", 1},
        {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 1}}},
       {{"name", "strip light"},
        {"extras", {{"photile_area", {1, 0.1}}, {"photile_lumens", 800}}}}});
  document["scenes"][0]["nodes"] = {0, 3, 5};
  document["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"},
       {"intensity", 40},
       {"color", {1, 0.9, 0.8}},
       {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.6}}}}};
  document["cameras"] = {{{"type", "perspective"},
                          {"perspective", {{"yfov", 0.7}, {"aspectRatio", 1.5}, {"znear", 0.1}}}}};
  // A picture of one pixel, in the file and in a buffer.
  document["images"] = {
      {{"uri",
        "data:image/png;base64,"
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5E"
        "rkJggg=="}},
      {{"bufferView", 1}, {"mimeType", "image/png"}}};
  document["samplers"] = {{{"wrapS", 33071}}};
  document["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 1}}};
  document["materials"].push_back(
      {{"name", "textured"},
       {"pbrMetallicRoughness",
        {{"baseColorTexture",
          {{"index", 0},
           {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"scale", {2, 2}}}}}}}},
         {"metallicFactor", 0}}},
       {"emissiveTexture", {{"index", 1}}},
       {"emissiveFactor", {1, 0.5, 0.25}}});
  document["materials"].push_back(
      {{"name", "pane"},
       {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.9}}}}}});
  document["meshes"].push_back(document["meshes"][0]);
  document["meshes"][1]["primitives"][0]["material"] = 1;
  document["meshes"][1]["primitives"].push_back(
      {{"attributes", {{"POSITION", 4}}}, {"mode", 5}, {"material", 2}});
  document["accessors"].push_back({{"componentType", 5126},
                                   {"count", 4},
                                   {"type", "VEC3"},
                                   {"sparse",
                                    {{"count", 2},
                                     {"indices", {{"bufferView", 2}, {"componentType", 5123}}},
                                     {"values", {{"bufferView", 0}, {"byteOffset", 12}}}}}});
  // A normal map along tangents of any direction.
  document["materials"][0]["normalTexture"] = {{"index", 0}, {"scale", 0.5}};
  document["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 64}});
  document["accessors"].push_back(
      {{"bufferView", 4}, {"componentType", 5126}, {"count", 4}, {"type", "VEC4"}});
  document["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = 5;
  return document;
}

/// The document in surroundings of six times its picture.
json surrounded_document() {
  json document = rich_document();
  document["extensions"]["EXT_lights_image_based"]["lights"] = {
      {{"intensity", 20},
       {"rotation", {0, 0.6, 0, 0.8}},
       {"specularImages", json::array({{0, 0, 0, 0, 0, 0}})}}};
  document["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
  return document;
}

std::string word(std::size_t value) {
  return bytes_of<std::uint32_t>({static_cast<std::uint32_t>(value)});
}

/// The document and its buffer as a binary file.
std::string binary_of(json document) {
  document["buffers"][0].erase("uri");
  std::string text = document.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string data = square_buffer();
  return "glTF" + word(2) + word(12 + 8 + text.size() + 8 + data.size()) + word(text.size()) +
         "JSON" + text + word(data.size()) + std::string("BIN\0", 4) + data;
}

json wild_value(std::mt19937& random) {
  static const std::vector<json> values = {-1,
                                           0,
                                           1,
                                           2,
                                           3,
                                           7,
                                           255,
                                           65'535,
                                           65'536,
                                           2'147'483'647,
                                           5120,
                                           5126,
                                           0.5,
                                           -0.0,
                                           1e300,
                                           -1e9,
                                           1e-300,
                                           true,
                                           false,
                                           nullptr,
                                           "",
                                           "VEC3",
                                           "x",
                                           "day",
                                           "\n",
                                           json::array(),
                                           json::object(),
                                           json{0, 0, 0},
                                           -2'147'483'648LL,
                                           4'294'967'295ULL,
                                           18'446'744'073'709'551'615ULL,
                                           json::array({json::array()}),
                                           json{{"index", 0}},
                                           std::string(5000, 'a')};
  return values[random() % values.size()];
}

/// Every value of the document, by its place.
std::vector<json::json_pointer> places_in(const json& document) {
  std::vector<json::json_pointer> places;
  const std::function<void(const json&, const json::json_pointer&)> visit =
      [&](const json& value, const json::json_pointer& place) {
        if (!place.empty()) places.push_back(place);
        if (value.is_array()) {
          for (std::size_t i = 0; i < value.size(); ++i) visit(value[i], place / i);
        } else if (value.is_object()) {
          for (const auto& [key, member] : value.items()) visit(member, place / key);
        }
      };
  visit(document, json::json_pointer());
  return places;
}

TEST_CASE("the document that is damaged below is sound") {
  const Scene scene = load_gltf(rich_document());
  check_invariants(scene);
  CHECK(scene.triangle_count() == 6);
  CHECK(scene.report.duplicate_triangles == 1);  // the pane's lies on the leaf
  CHECK(scene.report.degenerate_triangles == 1);
  CHECK(scene.textures.size() == 2);  // one picture, as a colour and as normals
  CHECK(scene.lights.size() == 4);
  CHECK(scene.cameras.size() == 1);
}

TEST_CASE("a binary glTF file cut at any border, or anywhere, is read or refused") {
  const std::string sound = binary_of(rich_document());
  const std::size_t chunk = sound.size() - square_buffer().size();  // where the buffer begins
  DamagedFiles files;
  files.write("square.bin", square_buffer());
  const auto cut = [&](std::size_t length) { files.load("cut.glb", sound.substr(0, length)); };
  for (std::size_t length = 0; length <= 40; ++length) cut(length);
  for (std::size_t length = chunk - 24; length <= chunk + 24; ++length) cut(length);
  for (std::size_t length = sound.size() - 24; length < sound.size(); ++length) cut(length);
  for (std::size_t length = 0; length < sound.size(); length += sound.size() / 100) cut(length);
  CHECK(files.loaded == 0);  // the header states the whole length
  cut(sound.size());
  CHECK(files.loaded == 1);
}

TEST_CASE(
    "a binary glTF file with the lengths of its header and chunks changed is read or refused") {
  const std::string sound = binary_of(rich_document());
  const std::size_t chunk = sound.size() - square_buffer().size() - 8;
  DamagedFiles files;
  files.write("square.bin", square_buffer());
  for (const std::size_t place : {std::size_t{4}, std::size_t{8}, std::size_t{12}, chunk}) {
    std::uint32_t stated = 0;
    std::memcpy(&stated, &sound[place], sizeof stated);
    for (const std::uint32_t value :
         {0u, 1u, 3u, 4u, stated - 4, stated - 1, stated + 1, stated + 4, stated + 8, stated + 12,
          0x7FFFFFFFu, 0x80000000u, 0xFFFFFFF0u, 0xFFFFFFFCu, 0xFFFFFFFFu}) {
      std::string damaged = sound;
      damaged.replace(place, 4, word(value));
      files.load("lengths.glb", damaged);
    }
  }
  CHECK(files.refused > 30);
}

TEST_CASE("a binary glTF file with bytes replaced at random is read or refused") {
  const std::string sound = binary_of(rich_document());
  std::mt19937 random(11);
  DamagedFiles files;
  files.write("square.bin", square_buffer());
  for (int trial = 0; trial < 1'500; ++trial) {
    files.load("bytes.glb", with_replaced_bytes(sound, random));
  }
  CHECK(files.loaded > 20);  // most of the bytes are JSON, which notices
  CHECK(files.refused > 100);
}

TEST_CASE("a glTF text cut anywhere is refused") {
  const std::string sound = rich_document().dump();
  DamagedFiles files;
  files.write("square.bin", square_buffer());
  for (std::size_t length = 0; length < sound.size(); length += 1 + sound.size() / 300) {
    files.load("cut.gltf", sound.substr(0, length));
  }
  CHECK(files.loaded == 0);
}

void damage(json& document, const json::json_pointer& place, std::mt19937& random) {
  if (!document.contains(place)) return;
  if (random() % 4 != 0) {
    document[place] = wild_value(random);
    return;
  }
  json& parent = document[place.parent_pointer()];
  if (parent.is_object()) {
    parent.erase(place.back());
  } else {
    parent.erase(static_cast<std::size_t>(std::stoul(place.back())));
  }
}

TEST_CASE("glTF values replaced or removed at random give a sound scene or a refusal") {
  const json sound = rich_document();
  const std::vector<json::json_pointer> places = places_in(sound);
  std::mt19937 random(12);
  DamagedFiles files;
  files.write("square.bin", square_buffer());
  for (int trial = 0; trial < 2'500; ++trial) {
    json document = sound;
    // Every place once, then several at a time.
    const auto turn = static_cast<std::size_t>(trial);
    if (turn < places.size()) damage(document, places[turn], random);
    for (unsigned changes = turn < places.size() ? 0 : 1 + random() % 4; changes > 0; --changes) {
      damage(document, places[random() % places.size()], random);
    }
    files.load("values.gltf", document.dump(-1, ' ', false, json::error_handler_t::replace));
  }
  CHECK(files.loaded > 250);
  CHECK(files.refused > 250);
}

TEST_CASE("glTF surroundings with values replaced or removed give a sound scene or a refusal") {
  const json sound = surrounded_document();
  CHECK(load_gltf(sound).lights.size() == 5);
  std::vector<json::json_pointer> places = places_in(sound);
  std::erase_if(places, [](const json::json_pointer& place) {
    return place.to_string().find("EXT_lights_image_based") == std::string::npos;
  });
  CHECK(places.size() > 15);
  std::mt19937 random(13);
  DamagedFiles files;
  files.write("square.bin", square_buffer());
  for (int trial = 0; trial < 100; ++trial) {
    json document = sound;
    for (unsigned changes = 1 + random() % 2; changes > 0; --changes) {
      damage(document, places[random() % places.size()], random);
    }
    files.load("surroundings.gltf", document.dump(-1, ' ', false, json::error_handler_t::replace));
  }
  CHECK(files.loaded > 20);
}

}  // namespace
}  // namespace photile::test
