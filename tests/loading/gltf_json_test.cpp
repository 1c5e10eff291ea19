// What check_json refuses before tinygltf sees it, and what it lets through.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "photile/limits.hpp"
#include "scene_files.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using nlohmann::json;
using namespace std::string_literals;

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

}  // namespace

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

TEST_CASE("numbers that decide on light and shape are numbers, as many as the format has") {
  const auto refusal = [](const std::string& place, const std::string& value) {
    json document = square_document();
    document["nodes"][0]["scale"] = {1, 1, 1};
    document["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"]["scale"] = {1,
                                                                                                 1};
    document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"color", {1, 1, 1}}}};
    document[json::json_pointer(place)] = json::parse(value);
    return refusal_of_text(document.dump());
  };
  const std::string strength =
      "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength";
  for (const std::string& place :
       {"/materials/0/pbrMetallicRoughness/roughnessFactor"s, "/materials/0/alphaCutoff"s, strength,
        "/extensions/KHR_lights_punctual/lights/0/intensity"s, "/cameras/0/perspective/yfov"s}) {
    const std::string value = GENERATE("null", "true", R"("1")", "[]", "[1]", "{}");
    CAPTURE(place, value);
    CHECK_THAT(refusal(place, value), Contains("malformed glTF") && Contains(", not a number"));
  }
  CHECK_THAT(refusal(strength, R"("1")"),
             Contains("materials[0].extensions.KHR_materials_emissive_strength.emissiveStrength "
                      "is a text, not a number"));
  for (const auto& [place, count] : std::vector<std::pair<std::string, int>>{
           {"/materials/0/pbrMetallicRoughness/baseColorFactor", 4},
           {"/materials/0/emissiveFactor", 3},
           {"/materials/0/normalTexture/extensions/KHR_texture_transform/scale", 2},
           {"/nodes/0/scale", 3},
           {"/nodes/0/matrix", 16},
           {"/extensions/KHR_lights_punctual/lights/0/color", 3}}) {
    const std::string value =
        GENERATE("null", "0.5", R"("1")", "{}", "[]", "[1]", "[1, 1, 1, 1, 1]");
    CAPTURE(place, value);
    CHECK_THAT(refusal(place, value), Contains(", not a list of " + std::to_string(count)));
    json wrong = json::array();
    for (int i = 0; i < count; ++i) wrong.push_back(i == 1 ? json("1") : json(1));
    CHECK_THAT(refusal(place, wrong.dump()), Contains("has a text, not a list of"));
  }
  CHECK_THAT(refusal("/nodes/0/extensions/KHR_node_visibility/visible", "0"),
             Contains("is a number, not true or false"));
  // What is no part of the format may be anything.
  json document = square_document();
  document["materials"][0]["extras"]["alphaCutoff"] = nullptr;
  document["nodes"][0]["extras"]["scale"] = "large";
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

}  // namespace photile::test
