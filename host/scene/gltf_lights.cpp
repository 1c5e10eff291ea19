#include "scene/gltf_lights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "photile/limits.hpp"
#include "scene/coordinate_limit.hpp"
#include "scene/gltf_document.hpp"
#include "scene/photometry.hpp"

namespace photile::scene_io {
namespace {

void set_cone(const tinygltf::SpotLight& spot, Light& light, Warnings& warnings) {
  constexpr double largest = std::numbers::pi / 2.0;
  const double outer = std::clamp(spot.outerConeAngle, 0.0, largest);
  const double inner = std::clamp(spot.innerConeAngle, 0.0, outer);
  if (inner != spot.innerConeAngle || outer != spot.outerConeAngle) {
    warnings.add("light", light.name, "cone angles out of range are clamped");
  }
  light.inner_cone_angle = static_cast<float>(inner);
  light.outer_cone_angle = static_cast<float>(outer);
}

/// Kind and flux; false for a type that the extension does not have.
bool set_power(const tinygltf::Light& source, double intensity, Light& light, Warnings& warnings) {
  if (source.type == "point") {
    light.kind = LightKind::point;
    light.power = point_flux(intensity);
  } else if (source.type == "spot") {
    light.kind = LightKind::spot;
    set_cone(source.spot, light, warnings);
    light.power = spot_flux(intensity, static_cast<double>(light.inner_cone_angle),
                            static_cast<double>(light.outer_cone_angle));
  } else if (source.type == "directional") {
    light.kind = LightKind::directional;
    light.power = intensity;
  } else {
    return false;
  }
  return true;
}

void add_light(const tinygltf::Light& source, const tinygltf::Node& node, const glm::dmat4& world,
               ImportContext& context) {
  const std::string name = node.name.empty() ? source.name : node.name;
  Light light;
  light.name = name;
  light.group = light_group(node.extras);
  if (light.group.empty()) light.group = light_group(source.extras);
  // The colour multiplies the intensity, so a dark colour makes a weak light.
  double color_luminance = 0;
  const bool coloured =
      set_light_color(rgb_of(source.color, glm::dvec3(1.0)), light, color_luminance);
  const double intensity = source.intensity * color_luminance;
  if (!set_power(source, intensity, light, context.warnings)) {
    context.warnings.add("light", name, "unknown type '" + source.type + "'; ignored");
    return;
  }
  const glm::dvec3 position(world[3]), direction(-world[2]);
  const double length = glm::length(direction);
  const bool placed = within_limit(position) && std::isfinite(length) && length > 0.0;
  if (!coloured || !std::isfinite(light.power) || light.power <= 0.0 || !placed) {
    context.warnings.add("light", name, "emits nothing or has no place within reach; dropped");
    return;
  }
  if (source.range > 0.0) context.warnings.add("light", name, "range is ignored");
  light.position = glm::vec3(position);
  light.direction = glm::vec3(direction / length);
  if (context.scene.lights.size() >= limits::max_lights) {
    throw context.error(fmt::format("more than {} lights", limits::max_lights));
  }
  context.scene.lights.push_back(std::move(light));
}

}  // namespace

void add_gltf_lights(const tinygltf::Model& model, const std::vector<NodeVisit>& visits,
                     ImportContext& context) {
  for (const NodeVisit& visit : visits) {
    const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(visit.node)];
    const auto* extension = find_extension(node.extensions, "KHR_lights_punctual");
    if (extension == nullptr) continue;
    const double index = number_member(*extension, "light", -1.0);
    if (!(index >= 0.0 && index < static_cast<double>(model.lights.size()))) {
      throw context.error(fmt::format("node '{}': there is no light {}; export it again",
                                      node_name(model, visit.node), index));
    }
    add_light(model.lights[static_cast<std::size_t>(index)], node, visit.world, context);
  }
}

}  // namespace photile::scene_io
