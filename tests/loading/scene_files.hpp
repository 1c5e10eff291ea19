// Small scene files that tests write to a folder of their own.
#pragma once

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "photile/errors.hpp"
#include "photile/load_scene.hpp"
#include "photile/scene.hpp"
#include "temporary_folder.hpp"

namespace photile::test {

/// A temporary folder that scene files are written to.
struct SceneFolderOnDisk : TemporaryFolder {
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    const std::filesystem::path file = path / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }
};

/// Loads an OBJ text, with an MTL text as materials.mtl beside it.
inline Scene load_obj(const std::string& obj, const std::string& mtl,
                      const SceneLoadOptions& options = {}) {
  const SceneFolderOnDisk folder;
  folder.write("materials.mtl", mtl);
  return load_scene(folder.write("scene.obj", "mtllib materials.mtl\n" + obj), options);
}

/// A unit square at z = 0 that faces +z, in the two materials of `lamp_and_wall`.
inline const std::string unit_square =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

inline const std::string lamp_and_wall =
    "newmtl lamp\nKd 0 0 0\nKe 2 2 2\nnewmtl wall\nKd 0.5 0.25 0.125\n";

/// A glTF document of one unit square at z = 0 that faces +z, with texture coordinates, in an
/// emissive material of 100 cd/m2. Its buffer is written by `load_gltf`.
inline nlohmann::json square_document() {
  return nlohmann::json::parse(R"({
    "asset": {"version": "2.0"},
    "scene": 0,
    "scenes": [{"nodes": [0]}],
    "nodes": [{"name": "panel", "mesh": 0}],
    "meshes": [{"name": "square", "primitives": [
      {"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "NORMAL": 3}, "indices": 2, "material": 0}]}],
    "materials": [{"name": "glow", "emissiveFactor": [1, 1, 1],
      "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.6, 0.4, 1], "metallicFactor": 0,
                               "roughnessFactor": 0.5},
      "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 100}}}],
    "buffers": [{"uri": "square.bin", "byteLength": 140}],
    "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48},
                    {"buffer": 0, "byteOffset": 48, "byteLength": 32},
                    {"buffer": 0, "byteOffset": 80, "byteLength": 12},
                    {"buffer": 0, "byteOffset": 92, "byteLength": 48}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                   "min": [0, 0, 0], "max": [1, 1, 0]},
                  {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
                  {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"},
                  {"bufferView": 3, "componentType": 5126, "count": 4, "type": "VEC3"}]
  })");
}

/// The square without emission, and a second node.
inline nlohmann::json dark_square_and(const nlohmann::json& node) {
  nlohmann::json document = square_document();
  document["materials"][0]["emissiveFactor"] = {0, 0, 0};
  document["nodes"].push_back(node);
  document["scenes"][0]["nodes"] = {0, 1};
  return document;
}

template <typename T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

inline std::string square_buffer() {
  return bytes_of<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) +
         bytes_of<float>({0, 1, 1, 1, 1, 0, 0, 0}) + bytes_of<std::uint16_t>({0, 1, 2, 0, 2, 3}) +
         bytes_of<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
}

/// Loads a document beside square.bin and other files, by their names.
inline Scene load_gltf(const nlohmann::json& document, const SceneLoadOptions& options = {},
                       const std::map<std::string, std::string>& files = {}) {
  const SceneFolderOnDisk folder;
  folder.write("square.bin", square_buffer());
  for (const auto& [name, bytes] : files) folder.write(name, bytes);
  return load_scene(folder.write("scene.gltf", document.dump()), options);
}

/// The document as a GLB, with square_buffer() behind it.
inline std::string glb_of(nlohmann::json document) {
  document["buffers"][0].erase("uri");
  std::string text = document.dump();
  const std::string buffer = square_buffer();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto word = [](std::size_t value) {
    return bytes_of<std::uint32_t>({static_cast<std::uint32_t>(value)});
  };
  return "glTF" + word(2) + word(28 + text.size() + buffer.size()) + word(text.size()) + "JSON" +
         text + word(buffer.size()) + std::string("BIN\0", 4) + buffer;
}

inline double total_area(const Scene& scene) {
  double area = 0;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) area += triangle_area(scene, t);
  return area;
}

inline double area_of(const Scene& scene, const Light& light) {
  double area = 0;
  for (const std::uint32_t triangle : light.triangles) area += triangle_area(scene, triangle);
  return area;
}

inline glm::dvec3 front_of(const Scene& scene, std::uint32_t triangle) {
  return face_normal(scene, oriented(triangle, scene.front_side[triangle]));
}

/// Whether some warning holds all the words.
inline bool warns(const Scene& scene, const std::vector<std::string>& words) {
  return std::any_of(scene.report.warnings.begin(), scene.report.warnings.end(),
                     [&](const std::string& line) {
                       return std::all_of(words.begin(), words.end(), [&](const std::string& word) {
                         return line.find(word) != std::string::npos;
                       });
                     });
}

/// The message of the InputError that `action` throws; empty when it throws none.
template <typename Action>
std::string input_error_of(Action action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace photile::test
