#include "support/gltf_writer.hpp"

#include <fstream>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

#include "photile/errors.hpp"

namespace photile::bench {
namespace {

using nlohmann::json;

void write_file(const std::filesystem::path& file, const char* data, std::size_t bytes) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(data, static_cast<std::streamsize>(bytes));
  stream.close();
  if (!stream) throw OutputError(file.string() + ": cannot be written");
}

json vector(const glm::vec3& v) { return {v.x, v.y, v.z}; }

/// Three positions a triangle, front sides counter-clockwise.
std::vector<glm::vec3> corner_positions(const Scene& scene) {
  std::vector<glm::vec3> positions;
  positions.reserve(3 * scene.triangle_count());
  for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
    const auto [a, b, c] = scene.corners(t);
    const bool canonical = scene.front_side[t] == 0;
    positions.insert(positions.end(), {a, canonical ? b : c, canonical ? c : b});
  }
  return positions;
}

json mesh(const std::vector<glm::vec3>& positions) {
  glm::vec3 low = positions.front(), high = low;
  for (const glm::vec3& position : positions) {
    low = glm::min(low, position);
    high = glm::max(high, position);
  }
  constexpr int floats = 5126;  // the component type of glTF
  return {{"accessors",
           {{{"bufferView", 0},
             {"componentType", floats},
             {"count", positions.size()},
             {"type", "VEC3"},
             {"min", vector(low)},
             {"max", vector(high)}}}},
          {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"material", 0}}}}}}}};
}

json material(const Material& material) {
  json colour = vector(material.diffuse);
  colour.push_back(1.0);
  return {{"name", material.name},
          {"pbrMetallicRoughness", {{"baseColorFactor", colour}, {"metallicFactor", 0}}},
          {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}};
}

json point_light(const Light& light) {
  const double candela = light.power / (4 * glm::pi<double>());
  return {{"KHR_lights_punctual",
           {{"lights", {{{"name", light.name}, {"type", "point"}, {"intensity", candela}}}}}}};
}

}  // namespace

void write_gltf(const Scene& scene, const std::filesystem::path& file) {
  const std::vector<glm::vec3> positions = corner_positions(scene);
  const std::size_t bytes = positions.size() * sizeof(glm::vec3);
  std::filesystem::path buffer = file;
  buffer.replace_extension(".bin");
  write_file(buffer, reinterpret_cast<const char*>(positions.data()), bytes);

  json document = mesh(positions);
  document["asset"] = {{"version", "2.0"}, {"generator", "photile bench"}};
  document["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_specular"};
  document["buffers"] = {{{"uri", buffer.filename().string()}, {"byteLength", bytes}}};
  document["bufferViews"] = {{{"buffer", 0}, {"byteLength", bytes}}};
  document["materials"] = {material(scene.materials.front())};
  document["extensions"] = point_light(scene.lights.front());
  document["nodes"] = {{{"mesh", 0}},
                       {{"translation", vector(scene.lights.front().position)},
                        {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
  document["scenes"] = {{{"nodes", {0, 1}}}};
  document["scene"] = 0;
  const std::string text = document.dump();
  write_file(file, text.data(), text.size());
}

}  // namespace photile::bench
