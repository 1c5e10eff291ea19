// Photometric data of lights in glTF: EXT_lights_ies, and `photile_ies` among a node's extras.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>

#include "gltf/accessor.hpp"
#include "gltf/nodes.hpp"
#include "gltf/tiny_gltf.hpp"
#include "reading/import_context.hpp"

namespace photile::gltf {

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

}  // namespace photile::gltf
