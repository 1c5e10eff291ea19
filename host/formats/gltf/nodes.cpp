#include "gltf/nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "common/ascii_text.hpp"
#include "gltf/document.hpp"
#include "gltf/lights.hpp"
#include "gltf/meshes.hpp"
#include "gltf/panels.hpp"
#include "photile/limits.hpp"

namespace photile::gltf {
namespace {

/// Marks those of the numbers that there are.
void mark(const std::vector<int>& numbers, std::vector<bool>& marks) {
  for (const int number : numbers) {
    if (number >= 0 && static_cast<std::size_t>(number) < marks.size()) {
      marks[static_cast<std::size_t>(number)] = true;
    }
  }
}

/// The nodes that no other one has as a child.
std::vector<int> parentless_nodes(const tinygltf::Model& model) {
  std::vector<bool> is_child(model.nodes.size(), false);
  for (const tinygltf::Node& node : model.nodes) mark(node.children, is_child);
  std::vector<int> roots;
  for (std::size_t i = 0; i < is_child.size(); ++i) {
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

/// "0 'day', 1 'night'"
std::string scene_list(const tinygltf::Model& model) {
  constexpr std::size_t most_listed = 10;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(model.scenes.size(), most_listed); ++i) {
    names.push_back(fmt::format("{} '{}'", i, model.scenes[i].name));
  }
  if (model.scenes.size() > most_listed) names.emplace_back("...");
  return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<int> root_nodes(const tinygltf::Model& model, reading::ImportContext& context) {
  if (const std::optional<std::size_t> scene = scene_number(model, context)) {
    if (model.scenes.size() > 1 && context.options.scene.empty()) {
      context.warnings.add(
          fmt::format("of {} scenes only scene {} is loaded; choose another with --set scene: {}",
                      model.scenes.size(), *scene, scene_list(model)));
    }
    return model.scenes[*scene].nodes;
  }
  if (!context.options.scene.empty()) {
    throw UsageError(fmt::format(
        "{}: there is no scene '{}': the file has nodes but no scenes; leave the scene out",
        context.folder.scene_file().string(), context.options.scene));
  }
  return parentless_nodes(model);
}

/// Counts visits before they are made: nodes with several parents multiply, and a file of a few
/// hundred bytes could ask for more than any memory holds.
class VisitCounter {
 public:
  explicit VisitCounter(const tinygltf::Model& model) : model_(model), below_(model.nodes.size()) {}

  /// Counts the node and all below it, at most one more than the limit. What is not counted here
  /// (cycles, deep trees, missing nodes) ends the walk, which visits nodes in the same order.
  std::uint64_t count(int node, int depth = 0) {
    if (node < 0 || static_cast<std::size_t>(node) >= below_.size()) return 0;
    if (depth > limits::max_node_depth) return 0;
    std::optional<std::uint64_t>& known = below_[static_cast<std::size_t>(node)];
    if (known) return *known;
    known = 0;  // until it is known: marks a node below itself
    std::uint64_t visits = 1;
    for (const int child : model_.nodes[static_cast<std::size_t>(node)].children) {
      visits = std::min(visits + count(child, depth + 1), limits::max_node_visits + 1);
    }
    known = visits;
    return visits;
  }

 private:
  const tinygltf::Model& model_;
  std::vector<std::optional<std::uint64_t>> below_;  ///< visits of a node and all below it
};

void check_visit_count(const tinygltf::Model& model, const std::vector<int>& roots,
                       const reading::ImportContext& context) {
  VisitCounter counter(model);
  std::uint64_t visits = 0;
  for (const int root : roots) visits += counter.count(root);
  if (visits > model.nodes.size() + limits::max_repeated_visits) {
    throw context.error(fmt::format(
        "{} nodes with several parents have more than {} instances; give each instance a node",
        model.nodes.size(), model.nodes.size() + limits::max_repeated_visits));
  }
}

/// A node on the way from the root, and which of its children comes next.
struct Level {
  int node;
  std::size_t next_child;
  glm::dmat4 world;
};

/// KHR_node_visibility: what is not visible hides all below it.
bool is_visible(const tinygltf::Node& node) {
  const tinygltf::Value* const found = find_extension(node.extensions, "KHR_node_visibility");
  return found == nullptr || !found->Has("visible") || !found->Get("visible").IsBool() ||
         found->Get("visible").Get<bool>();
}

class Walk {
 public:
  Walk(const tinygltf::Model& model, reading::ImportContext& context)
      : model_(model), context_(context), on_path_(model.nodes.size(), false) {}

  void from_root(int root, std::vector<NodeVisit>& visits) {
    const glm::dvec3 metres(context_.options.metres_per_unit);
    enter(root, glm::scale(glm::dmat4(context_.scene.turn), metres), visits);
    while (!path_.empty()) {
      Level& level = path_.back();
      const std::vector<int>& children =
          model_.nodes[static_cast<std::size_t>(level.node)].children;
      if (level.next_child < children.size()) {
        const int child = children[level.next_child++];
        enter(child, level.world, visits);
      } else {
        on_path_[static_cast<std::size_t>(level.node)] = false;
        path_.pop_back();
      }
    }
  }

 private:
  void enter(int node, const glm::dmat4& parent, std::vector<NodeVisit>& visits) {
    const tinygltf::Node* const source = element(model_.nodes, node);
    if (source == nullptr) {
      throw context_.error(fmt::format("there is no node {}; export the file again", node));
    }
    if (on_path_[static_cast<std::size_t>(node)]) {
      throw context_.error(fmt::format("node '{}' is its own ancestor; export the file again",
                                       node_name(model_, node)));
    }
    if (path_.size() >= static_cast<std::size_t>(limits::max_node_depth)) {
      throw context_.error(
          fmt::format("nodes are nested more than {} levels deep; flatten the hierarchy",
                      limits::max_node_depth));
    }
    if (context_.is_hidden(node_name(model_, node))) return;
    if (!is_visible(*source)) {
      context_.warnings.add("node", node_name(model_, node),
                            "invisible in the file (KHR_node_visibility): left out, with all "
                            "below it");
      return;
    }
    on_path_[static_cast<std::size_t>(node)] = true;
    const glm::dmat4 world = parent * local_transform(*source);
    const bool has_mesh = element(model_.meshes, source->mesh) != nullptr;
    if (!has_mesh || !context_.is_hidden(name_of_mesh(model_, source->mesh))) {
      visits.push_back({node, source, world});
    }
    path_.push_back({node, 0, world});
  }

  const tinygltf::Model& model_;
  reading::ImportContext& context_;
  std::vector<bool> on_path_;
  std::vector<Level> path_;
};

/// Whether a node has the name of a light: exporters leave many other nodes empty.
bool sounds_like_light(const std::string& name) {
  constexpr std::array words{"area", "lamp", "light", "lumi", "leuchte", "spot", "sun"};
  return std::any_of(words.begin(), words.end(), [name = lower(name)](const char* word) {
    return name.find(word) != std::string::npos;
  });
}

void warn_about_empty_nodes(const tinygltf::Model& model, const std::vector<NodeVisit>& visits,
                            reading::ImportContext& context) {
  const auto asked_for = [&](const tinygltf::Node& node) {
    const std::vector<LuminousPanel>& panels = context.options.panels;
    return std::any_of(panels.begin(), panels.end(),
                       [&](const LuminousPanel& panel) { return panel.node == node.name; });
  };
  std::vector<bool> is_joint(model.nodes.size(), false);
  for (const tinygltf::Skin& skin : model.skins) mark(skin.joints, is_joint);
  for (const NodeVisit& visit : visits) {
    const tinygltf::Node& node = *visit.source;
    if (node.mesh < 0 && node.camera < 0 && node.children.empty() && node.extensions.empty() &&
        !is_joint[static_cast<std::size_t>(visit.node)] && !has_profile(node) && !has_panel(node) &&
        !asked_for(node) && sounds_like_light(node.name)) {
      context.warnings.add("node", node_name(model, visit.node),
                           "has no mesh, light, camera or child, like area lights exported by "
                           "Blender: restore it by --area-light, see docs/guide/luminaires.md");
    }
  }
}

}  // namespace

std::optional<std::size_t> scene_number(const tinygltf::Model& model,
                                        const reading::ImportContext& context) {
  if (model.scenes.empty()) return std::nullopt;
  const std::string& requested = context.options.scene;
  if (!requested.empty()) {
    for (std::size_t i = 0; i < model.scenes.size(); ++i) {
      if (model.scenes[i].name == requested) return i;
    }
    for (std::size_t i = 0; i < model.scenes.size(); ++i) {
      if (std::to_string(i) == requested) return i;
    }
    throw UsageError(fmt::format("{}: there is no scene '{}'; its scenes are {}",
                                 context.folder.scene_file().string(), requested,
                                 scene_list(model)));
  }
  const int scene = std::max(model.defaultScene, 0);  // else the first
  if (static_cast<std::size_t>(scene) >= model.scenes.size()) {
    throw context.error(fmt::format(
        "the default scene is {}, but there are only {}; choose a scene or export the file again",
        scene, model.scenes.size()));
  }
  return static_cast<std::size_t>(scene);
}

glm::dmat4 local_transform(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return glm::make_mat4(node.matrix.data());
  glm::dmat4 transform(1.0);
  if (node.translation.size() == 3) {
    transform = glm::translate(transform, glm::make_vec3(node.translation.data()));
  }
  if (node.rotation.size() == 4) {
    const auto& r = node.rotation;
    const glm::dquat rotation(r[3], r[0], r[1], r[2]);  // glTF puts w last, GLM first
    if (glm::length(rotation) > 0.0) transform *= glm::mat4_cast(glm::normalize(rotation));
  }
  if (node.scale.size() == 3) {
    transform = glm::scale(transform, glm::make_vec3(node.scale.data()));
  }
  return transform;
}

std::vector<NodeVisit> visit_nodes(const tinygltf::Model& model, reading::ImportContext& context) {
  std::vector<NodeVisit> visits;
  Walk walk(model, context);
  const std::vector<int> roots = root_nodes(model, context);
  check_visit_count(model, roots, context);
  for (const int root : roots) walk.from_root(root, visits);
  warn_about_empty_nodes(model, visits, context);
  return visits;
}

std::string node_name(const tinygltf::Model& model, int node) {
  const std::string& name = model.nodes[static_cast<std::size_t>(node)].name;
  return name.empty() ? fmt::format("node {}", node) : name;
}

}  // namespace photile::gltf
