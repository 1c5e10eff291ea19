#include "app/scene_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/number_format.hpp"

namespace photile::app {
namespace {

using nlohmann::json;

// An interior in millimetres is thousands of units wide, one in metres hardly ever 500.
constexpr double doubtfully_large = 500;   // metres
constexpr double doubtfully_small = 0.05;  // metres

/// "1 camera", "2 cameras"
std::string counted(std::size_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

const char* kind_name(LightKind kind) {
  switch (kind) {
    case LightKind::area:
      return "area";
    case LightKind::point:
      return "point";
    case LightKind::spot:
      return "spot";
    case LightKind::directional:
      return "directional";
  }
  return "";
}

const char* interaction_name(const Material& material) {
  switch (material.interaction) {
    case Interaction::opaque:
      return material.glossy() ? "glossy" : "diffuse";
    case Interaction::mirror:
      return "mirror";
    case Interaction::glass:
      return material.thin ? "thin glass" : "glass";
  }
  return "";
}

template <class Vector>
json components(const Vector& vector) {
  return json::array({vector.x, vector.y, vector.z});
}

json light_json(const Light& light, const MixedLight& mixed, double lumen_per_watt) {
  const bool lumen = mixed.unit == PowerUnit::lumen;
  return {{"name", light.name},
          {"kind", kind_name(light.kind)},
          {"color", components(light.color)},
          {"triangles", light.triangles.size()},
          {"two_sided", light.two_sided},
          {"lumens", lumen ? mixed.power : mixed.power * lumen_per_watt},
          {"watts", lumen ? mixed.power / lumen_per_watt : mixed.power}};
}

json material_json(const Scene& scene, const Material& material) {
  json entry{{"name", material.name},
             {"interaction", interaction_name(material)},
             {"diffuse", components(material.diffuse)},
             {"specular", components(material.specular)},
             {"roughness", material.roughness}};
  if (material.diffuse_texture != none) {
    entry["texture"] = scene.textures[material.diffuse_texture].name();
  }
  return entry;
}

json camera_json(const Camera& camera) {
  return {{"name", camera.name},
          {"position", components(camera.position)},
          {"forward", components(camera.forward)},
          {"up", components(camera.up)},
          {"vertical_field_of_view_degrees", glm::degrees(camera.vertical_field_of_view)},
          {"aspect_ratio", camera.aspect_ratio}};
}

}  // namespace

Extents extents_of(const Scene& scene) {
  Extents extents{glm::dvec3(std::numeric_limits<double>::infinity()),
                  glm::dvec3(-std::numeric_limits<double>::infinity())};
  for (const glm::vec3& vertex : scene.vertices) {
    extents.lowest = glm::min(extents.lowest, glm::dvec3(vertex));
    extents.highest = glm::max(extents.highest, glm::dvec3(vertex));
  }
  return extents;
}

std::string doubtful_unit(const Extents& extents) {
  const glm::dvec3 size = extents.size();
  const double largest = std::max({size.x, size.y, size.z});
  if (largest > doubtfully_large) {
    return fmt::format(
        "the scene is {:.4g} m wide: its file is probably in millimetres or centimetres; scale it "
        "to metres",
        largest);
  }
  if (largest < doubtfully_small) {
    return fmt::format("the scene is {:.4g} m wide: is its file in metres?", largest);
  }
  return {};
}

std::vector<std::string> scene_summary(const Scene& scene, const LightMix& mix) {
  const glm::dvec3 size = extents_of(scene).size();
  std::vector<std::string> lines{
      fmt::format(
          "scene: {}: {}, {}, {}, {}", scene.source.string(),
          counted(scene.triangle_count(), "triangle"), counted(scene.materials.size(), "material"),
          counted(scene.textures.size(), "texture"), counted(scene.cameras.size(), "camera")),
      fmt::format("extents: {:.4g} x {:.4g} x {:.4g} m", size.x, size.y, size.z)};
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const MixedLight& mixed = mix.lights[i];
    lines.push_back(fmt::format("light: {}: {}, {}", mixed.name, kind_name(scene.lights[i].kind),
                                format_power_in_both(mixed.power, mixed.unit, mix.lumen_per_watt)));
  }
  return lines;
}

std::vector<std::string> scene_warnings(const Scene& scene) {
  std::vector<std::string> lines = scene.report.warnings;
  if (const std::string doubt = doubtful_unit(extents_of(scene)); !doubt.empty()) {
    lines.push_back(doubt);
  }
  return lines;
}

json scene_json(const Scene& scene, const LightMix& mix) {
  const Extents extents = extents_of(scene);
  json result{{"scene", scene.source.string()},
              {"unit", unit_symbol(scene.unit)},
              {"lumen_per_watt", mix.lumen_per_watt},
              {"triangles", scene.triangle_count()},
              {"vertices", scene.vertices.size()},
              {"polygons_triangulated", scene.report.polygons_triangulated},
              {"degenerate_triangles", scene.report.degenerate_triangles},
              {"non_finite_triangles", scene.report.non_finite_triangles},
              {"extents",
               {{"lowest", components(extents.lowest)},
                {"highest", components(extents.highest)},
                {"size", components(extents.size())}}},
              {"materials", json::array()},
              {"lights", json::array()},
              {"cameras", json::array()},
              {"warnings", scene_warnings(scene)}};
  for (const Material& material : scene.materials) {
    result["materials"].push_back(material_json(scene, material));
  }
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    result["lights"].push_back(light_json(scene.lights[i], mix.lights[i], mix.lumen_per_watt));
  }
  for (const Camera& camera : scene.cameras) result["cameras"].push_back(camera_json(camera));
  return result;
}

}  // namespace photile::app
