// The node tree of a glTF scene, flattened.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gltf/tiny_gltf.hpp"
#include "reading/import_context.hpp"

namespace photile::gltf {

/// One appearance of a node in the scene.
struct NodeVisit {
  int node;                      ///< its number
  const tinygltf::Node* source;  ///< in the model
  glm::dmat4 world;              ///< node to world space
};

/// Every node of the scene that SceneLoadOptions::scene names, else of the default scene (or of the
/// first; or all root nodes when there is no scene), in depth-first order. Empty nodes, which are
/// what remains of Blender's area lights, are named in a warning. Errors: InputError for cycles,
/// wrong node numbers and trees beyond the limits; UsageError where there is no such scene.
std::vector<NodeVisit> visit_nodes(const tinygltf::Model& model, reading::ImportContext& context);

/// The scene that visit_nodes visits; nothing where the file has none.
std::optional<std::size_t> scene_number(const tinygltf::Model& model,
                                        const reading::ImportContext& context);

/// Node to parent space: its matrix, or its translation, rotation and scale.
glm::dmat4 local_transform(const tinygltf::Node& node);

/// A node's name, or "node <number>".
std::string node_name(const tinygltf::Model& model, int node);

}  // namespace photile::gltf
