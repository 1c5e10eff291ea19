// What a node of a glTF file says about its lights, whatever their kind.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "files/scene_files.hpp"
#include "gltf/accessor.hpp"
#include "gltf/nodes.hpp"
#include "gltf/tiny_gltf.hpp"
#include "photile/scene.hpp"
#include "reading/area_lights.hpp"
#include "reading/import_context.hpp"

namespace photile::gltf {

/// The traits of the node `name` by the extras `photile_group`, `photile_lumens` and
/// `photile_kelvin`, which Blender exports as custom properties. Numbers that are none, or out of
/// range, are ignored with a warning.
reading::LightTraits light_traits(const tinygltf::Value& extras, const std::string& name,
                                  files::Warnings& warnings);

/// LightSource::lamp of the light that an extension of a node refers to; "" where it has none.
std::string lamp_of(const tinygltf::Node& node, const std::string& extension);

/// Makes a group of those lights without one whose lamp is the same, named after the first of them,
/// so that they share a layer.
///   sources   of the lights
void group_instances(std::vector<Light>& lights, std::span<const reading::LightSource> sources);

// Photometric data of lights in glTF: EXT_lights_ies, and `photile_ies` among a node's extras.

/// What a node says about the intensities of its light.
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

/// Whether a node's extras give it a light of its own.
bool has_profile(const tinygltf::Node& node);

// KHR_lights_punctual and EXT_lights_ies.

/// Adds the lights without size of all visited nodes. Directional lights get their irradiance as
/// `power`; load_scene turns it into flux. Black lights are dropped with a warning, `range` (an
/// unphysical cutoff) is ignored with one. The group is that of the node, or else of the light.
/// Photometric data at a node (lights.hpp) makes a point light; lights.hpp says what
/// else a node's extras tell. Errors: InputError.
void add_gltf_lights(const tinygltf::Model& model, const AccessorReader& accessors,
                     const std::vector<NodeVisit>& visits, reading::ImportContext& context);

}  // namespace photile::gltf
