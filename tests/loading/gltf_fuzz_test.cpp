// glTF files damaged at random, with fixed seeds: each is a sound scene or an InputError of one
// line.
#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "damaged_files.hpp"
#include "scene_files.hpp"

namespace photile::test {
namespace {

using nlohmann::json;

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
  static const json values =
      json::parse(R"([-1, 0, 1, 2, 3, 7, 255, 65535, 65536, 2147483647, 5120, 5126,
      -2147483648, 4294967295, 18446744073709551615, 0.5, -0.0, 1e300, -1e9, 1e-300, true, false, null, "",
      "VEC3", "x", "day", "\n", [], {}, [[]], [0, 0, 0], {"index": 0}])");
  const std::size_t chosen = random() % (values.size() + 1);
  return chosen < values.size() ? values[chosen] : json(std::string(5000, 'a'));
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

}  // namespace

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

}  // namespace photile::test
