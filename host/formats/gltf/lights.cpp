#include "gltf/lights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "gltf/document.hpp"
#include "gltf/light_traits.hpp"
#include "gltf/profiles.hpp"
#include "photile/limits.hpp"
#include "scene/coordinate_limit.hpp"
#include "scene/light_emission.hpp"

namespace photile::gltf {
namespace {

void set_cone(const tinygltf::SpotLight& spot, Light& light, files::Warnings& warnings) {
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
bool set_power(const tinygltf::Light& source, double intensity, Light& light,
               files::Warnings& warnings) {
  if (source.type == "point") {
    light.kind = LightKind::point;
    light.power = scene::point_flux(intensity);
  } else if (source.type == "spot") {
    light.kind = LightKind::spot;
    set_cone(source.spot, light, warnings);
    light.power = scene::spot_flux(intensity, static_cast<double>(light.inner_cone_angle),
                                   static_cast<double>(light.outer_cone_angle));
  } else if (source.type == "directional") {
    light.kind = LightKind::directional;
    light.power = intensity;
  } else {
    return false;
  }
  return true;
}

/// Direction and x axis of a light at a node, whose scale does not count; false where the node's
/// transform leaves none.
bool set_orientation(const glm::dmat4& world, Light& light) {
  const glm::dvec3 direction(-world[2]);
  const double length = glm::length(direction);
  if (!std::isfinite(length) || length <= 0.0) return false;
  const glm::dvec3 unit = direction / length;
  glm::dvec3 x(world[0]);
  x -= glm::dot(x, unit) * unit;
  light.direction = glm::vec3(unit);
  // A node squeezed flat along x has no x axis; any will do.
  if (!(glm::length(x) > 0.0)) x = glm::cross(unit, glm::dvec3(unit.y, unit.z, unit.x));
  light.x_axis = glm::vec3(glm::normalize(x));
  return true;
}

/// What a node's extras say about its light.
void apply_traits(const reading::LightTraits& traits, Light& light, files::Warnings& warnings) {
  if (!traits.group.empty()) light.group = traits.group;
  if (traits.kelvin > 0.0) light.color = glm::vec3(scene::color_of_temperature(traits.kelvin));
  if (traits.lumens > 0.0 && light.kind == LightKind::directional) {
    warnings.add("light", light.name, "photile_lumens of a directional light is ignored");
  } else if (traits.lumens > 0.0) {
    light.power = traits.lumens;
  }
}

class LightImporter {
 public:
  LightImporter(const tinygltf::Model& model, const AccessorReader& accessors,
                reading::ImportContext& context)
      : model_(model), context_(context), profiles_(model, accessors, context) {}

  void add(const NodeVisit& visit) {
    const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(visit.node)];
    const tinygltf::Light* source = punctual_light(visit.node);
    const std::optional<NodeProfile> profile = profiles_.of(visit.node);
    if (source == nullptr && !profile) return;
    Light light;
    light.name = node.name.empty() && source != nullptr ? source->name : node.name;
    if (source != nullptr) light.group = string_member(source->extras, "photile_group");
    if (!set_emission(source, profile, light)) return;
    files::Warnings& warnings = context_.warnings;
    apply_traits(light_traits(node.extras, node_name(model_, visit.node), warnings), light,
                 warnings);
    place(visit, light,
          lamp_of(node, source != nullptr ? "KHR_lights_punctual" : "EXT_lights_ies"));
  }

 private:
  const tinygltf::Light* punctual_light(int node) const {
    const auto* extension = find_extension(model_.nodes[static_cast<std::size_t>(node)].extensions,
                                           "KHR_lights_punctual");
    if (extension == nullptr) return nullptr;
    const double index = number_member(*extension, "light", -1.0);
    if (!(index >= 0.0 && index < static_cast<double>(model_.lights.size()))) {
      throw context_.error(fmt::format("node '{}': there is no light {}; export it again",
                                       node_name(model_, node), index));
    }
    return &model_.lights[static_cast<std::size_t>(index)];
  }

  /// Kind, colour and flux. Photometric data replaces what a punctual light at the same node
  /// emits, but for its colour.
  bool set_emission(const tinygltf::Light* source, const std::optional<NodeProfile>& profile,
                    Light& light) {
    files::Warnings& warnings = context_.warnings;
    glm::dvec3 color(1.0);
    if (source != nullptr) color = rgb_of(source->color, color);
    if (profile && profile->colored_by_node) color = profile->color;
    // The colour multiplies the intensity, so a dark colour makes a weak light.
    double color_luminance = 0;
    scene::set_light_color(color, light, color_luminance);  // a black one leaves no power
    if (profile) {
      light.kind = LightKind::point;
      light.distribution = profile->distribution;
      const double flux = context_.scene.distributions[profile->distribution].flux();
      // What another light at the node emits is replaced, so its colour is a tint alone.
      light.power = profile->multiplier * flux * (profile->colored_by_node ? color_luminance : 1.0);
      return true;
    }
    if (!set_power(*source, source->intensity * color_luminance, light, warnings)) {
      warnings.add("light", light.name, "unknown type '" + source->type + "'; ignored");
      return false;
    }
    if (source->range > 0.0) warnings.add("light", light.name, "range is ignored");
    return true;
  }

  void place(const NodeVisit& visit, Light& light, const std::string& lamp) {
    const glm::dvec3 position(visit.world[3]);
    if (!std::isfinite(light.power) || light.power <= 0.0 || !scene::within_limit(position) ||
        !set_orientation(visit.world, light)) {
      context_.warnings.add("light", light.name,
                            "emits nothing or has no place within reach; dropped");
      return;
    }
    light.position = glm::vec3(position);
    if (context_.scene.lights.size() >= limits::max_lights) {
      throw context_.error(fmt::format("more than {} lights", limits::max_lights));
    }
    context_.scene.lights.push_back(std::move(light));
    context_.light_sources.push_back(
        {reading::LightSource::Kind::node, static_cast<std::uint32_t>(visit.node), none, lamp});
  }

  const tinygltf::Model& model_;
  reading::ImportContext& context_;
  GltfProfiles profiles_;
};

}  // namespace

void add_gltf_lights(const tinygltf::Model& model, const AccessorReader& accessors,
                     const std::vector<NodeVisit>& visits, reading::ImportContext& context) {
  LightImporter importer(model, accessors, context);
  for (const NodeVisit& visit : visits) importer.add(visit);
}

}  // namespace photile::gltf
