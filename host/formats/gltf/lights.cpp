#include "gltf/lights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <unordered_set>

#include "gltf/document.hpp"
#include "photile/limits.hpp"
#include "photometry/photometric_file.hpp"
#include "scene/light_emission.hpp"
#include "scene/light_names.hpp"
#include "scene/scene_queries.hpp"

namespace photile::gltf {

namespace {

/// The number `key`, or 0 where it is absent; outside [lowest, highest] 0 with a warning.
double number_within(const tinygltf::Value& extras, const char* key, double lowest, double highest,
                     const std::string& name, files::Warnings& warnings) {
  if (!extras.Has(key)) return 0;
  const double value = number_member(extras, key, -1.0);
  if (value >= lowest && value <= highest) return value;
  warnings.add("node", name,
               fmt::format("{} is not a number from {} to {}; ignored", key, lowest, highest));
  return 0;
}

}  // namespace

reading::LightTraits light_traits(const tinygltf::Value& extras, const std::string& name,
                                  files::Warnings& warnings) {
  constexpr double least_lumens = 1e-12, most_lumens = 1e18;
  return {string_member(extras, "photile_group"),
          number_within(extras, "photile_lumens", least_lumens, most_lumens, name, warnings),
          number_within(extras, "photile_kelvin", limits::min_color_temperature,
                        limits::max_color_temperature, name, warnings)};
}

std::string lamp_of(const tinygltf::Node& node, const std::string& extension) {
  const tinygltf::Value* found = find_extension(node.extensions, extension.c_str());
  if (found == nullptr) return "";
  return fmt::format("{} {:g}", extension, number_member(*found, "light", -1.0));
}

void group_instances(std::vector<Light>& lights, std::span<const reading::LightSource> sources) {
  std::unordered_set<std::string> groups;
  std::map<reading::LightSource::LampKey, std::vector<std::size_t>> instances;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (!lights[i].group.empty()) {
      groups.insert(scene::clean_light_name(lights[i].group, limits::max_light_name_bytes));
    } else if (!sources[i].lamp.empty()) {
      instances[sources[i].lamp_key()].push_back(i);
    }
  }
  for (const auto& [lamp, members] : instances) {
    if (members.size() < 2) continue;
    const std::string group = scene::unused_light_name(lights[members.front()].name, groups);
    for (const std::size_t i : members) lights[i].group = group;
  }
}

namespace {

constexpr const char* ies_extension = "EXT_lights_ies";
constexpr const char* ies_extra = "photile_ies";

/// The content of a data: URI in base64, whatever its media type. tinygltf knows a few types only.
std::vector<unsigned char> data_uri_content(const std::string& uri) {
  const std::size_t comma = uri.find(',');
  std::vector<unsigned char> bytes;
  std::string type;
  if (comma == std::string::npos || uri.substr(0, comma).find(";base64") == std::string::npos ||
      !tinygltf::DecodeDataURI(
          &bytes, type, "data:application/octet-stream;base64" + uri.substr(comma), 0, false)) {
    throw files::ResourceError("its data: URI is not in base64");
  }
  return bytes;
}

}  // namespace

bool has_profile(const tinygltf::Node& node) {
  return !string_member(node.extras, ies_extra).empty();
}

namespace {

/// The intensities of a node's light, as far as the node states them.
struct NodeProfile {
  std::uint32_t distribution;    ///< into Scene::distributions
  double multiplier = 1;         ///< of the intensities
  glm::dvec3 color{1.0};         ///< linear RGB; multiplies the intensities, too
  bool colored_by_node = false;  ///< `color` is the node's own, not that of another light there
};

/// Reads each photometric file once.
class GltfProfiles {
 public:
  /// References are kept.
  GltfProfiles(const tinygltf::Model& model, const AccessorReader& accessors,
               reading::ImportContext& context)
      : model_(model), accessors_(accessors), context_(context) {}

  /// The profile of a node's light, or nothing. Errors: InputError for a file that is missing or
  /// malformed, or a light that does not exist.
  std::optional<NodeProfile> of(int node);

 private:
  std::uint32_t from_extension(double light, const std::string& node);
  template <class Read>
  std::uint32_t find_or_read(const std::string& key, const Read& read);

  const tinygltf::Model& model_;
  const AccessorReader& accessors_;
  reading::ImportContext& context_;
  std::map<std::string, std::uint32_t> index_;
};

template <class Read>
std::uint32_t GltfProfiles::find_or_read(const std::string& key, const Read& read) {
  if (const auto found = index_.find(key); found != index_.end()) return found->second;
  const auto index = static_cast<std::uint32_t>(context_.scene.distributions.size());
  context_.scene.distributions.push_back(
      photometry::read_photometry(key, read(), context_.warnings));
  return index_.emplace(key, index).first->second;
}

std::uint32_t GltfProfiles::from_extension(double light, const std::string& node) {
  const tinygltf::Value* const profile = light_of_extension(model_, ies_extension, light);
  if (profile == nullptr) {
    throw files::ResourceError(
        fmt::format("node '{}': there is no light {} of {}", node, light, ies_extension));
  }
  const std::string uri = string_member(*profile, "uri");
  if (uri.empty()) {
    const std::string key = fmt::format("light {} of {}", light, ies_extension);
    const auto view = integer_member(*profile, "bufferView", -1);
    return find_or_read(key, [&] { return accessors_.view(view, key); });
  }
  if (uri.starts_with("data:")) {
    return find_or_read(fmt::format("light {} of {}", light, ies_extension),
                        [&] { return data_uri_content(uri); });
  }
  const std::string file = decoded_uri(uri);
  return find_or_read(file, [&] { return context_.folder.read(file); });
}

std::optional<NodeProfile> GltfProfiles::of(int number) {
  const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(number)];
  try {
    if (const auto* extension = find_extension(node.extensions, ies_extension)) {
      NodeProfile profile;
      profile.distribution =
          from_extension(number_member(*extension, "light", -1.0), node_name(model_, number));
      profile.multiplier = number_member(*extension, "multiplier", 1.0);
      profile.color = glm::clamp(vector_member(*extension, "color", glm::dvec3(1.0)), 0.0, 1.0);
      profile.colored_by_node = true;
      return profile;
    }
    const std::string file = string_member(node.extras, ies_extra);
    if (file.empty()) return std::nullopt;
    NodeProfile profile;
    profile.distribution = find_or_read(file, [&] { return context_.folder.read(file); });
    return profile;
  } catch (const files::ResourceError& error) {
    throw context_.error(error.what());
  }
}

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

/// The light of a node by its extras.
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
    const tinygltf::Node& node = *visit.source;
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
      throw context_.error(fmt::format("node '{}': there is no light {}; export the file again",
                                       node_name(model_, node), index));
    }
    return &model_.lights[static_cast<std::size_t>(index)];
  }

  /// Kind, colour and flux. Photometric data replaces what a punctual light at the same node emits,
  /// except its colour.
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
                            "emits nothing or lies beyond the limits of coordinates; dropped");
      return;
    }
    light.position = glm::vec3(position);
    if (context_.scene.lights.size() >= limits::max_lights) {
      throw context_.error(fmt::format("more than {} lights; remove some", limits::max_lights));
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
