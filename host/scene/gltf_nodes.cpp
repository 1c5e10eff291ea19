#include "scene/gltf_nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "photile/limits.hpp"
#include "scene/gltf_document.hpp"
#include "scene/gltf_panels.hpp"
#include "scene/gltf_profiles.hpp"

namespace photile::scene_io {
namespace {

std::vector<int> root_nodes(const tinygltf::Model& model, ImportContext& context) {
  if (!model.scenes.empty()) {
    const int scene = model.defaultScene < 0 ? 0 : model.defaultScene;
    if (static_cast<std::size_t>(scene) >= model.scenes.size()) {
      throw context.error(
          fmt::format("the default scene is {}, but there are only {}; export it "
                      "again",
                      scene, model.scenes.size()));
    }
    if (model.scenes.size() > 1) {
      context.warnings.add(fmt::format("{} scenes; only scene {} '{}' is loaded",
                                       model.scenes.size(), scene,
                                       model.scenes[static_cast<std::size_t>(scene)].name));
    }
    return model.scenes[static_cast<std::size_t>(scene)].nodes;
  }
  std::vector<bool> is_child(model.nodes.size(), false);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) {
      if (child >= 0 && static_cast<std::size_t>(child) < is_child.size()) {
        is_child[static_cast<std::size_t>(child)] = true;
      }
    }
  }
  std::vector<int> roots;
  for (std::size_t i = 0; i < is_child.size(); ++i) {
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

/// A node on the way from the root, and which of its children comes next.
struct Level {
  int node;
  std::size_t next_child;
  glm::dmat4 world;
};

class Walk {
 public:
  Walk(const tinygltf::Model& model, const ImportContext& context)
      : model_(model), context_(context), on_path_(model.nodes.size(), false) {}

  void from_root(int root, std::vector<NodeVisit>& visits) {
    enter(root, glm::dmat4(1.0), visits);
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
    if (node < 0 || static_cast<std::size_t>(node) >= model_.nodes.size()) {
      throw context_.error(fmt::format("there is no node {}; export it again", node));
    }
    if (on_path_[static_cast<std::size_t>(node)]) {
      throw context_.error(
          fmt::format("node '{}' is its own ancestor; export it again", node_name(model_, node)));
    }
    if (path_.size() >= static_cast<std::size_t>(limits::max_node_depth)) {
      throw context_.error(
          fmt::format("nodes nested more than {} levels deep", limits::max_node_depth));
    }
    if (visits.size() >= limits::max_node_visits) {
      throw context_.error(fmt::format("nodes with several parents appear more than {} times",
                                       limits::max_node_visits));
    }
    on_path_[static_cast<std::size_t>(node)] = true;
    const glm::dmat4 world = parent * local_transform(model_.nodes[static_cast<std::size_t>(node)]);
    visits.push_back({node, world});
    path_.push_back({node, 0, world});
  }

  const tinygltf::Model& model_;
  const ImportContext& context_;
  std::vector<bool> on_path_;
  std::vector<Level> path_;
};

void warn_about_empty_nodes(const tinygltf::Model& model, const std::vector<NodeVisit>& visits,
                            ImportContext& context) {
  const auto asked_for = [&](const tinygltf::Node& node) {
    const std::vector<LuminousPanel>& panels = context.options.panels;
    return std::any_of(panels.begin(), panels.end(),
                       [&](const LuminousPanel& panel) { return panel.node == node.name; });
  };
  std::vector<bool> is_joint(model.nodes.size(), false);
  for (const tinygltf::Skin& skin : model.skins) {
    for (const int joint : skin.joints) {
      if (joint >= 0 && static_cast<std::size_t>(joint) < is_joint.size()) {
        is_joint[static_cast<std::size_t>(joint)] = true;
      }
    }
  }
  for (const NodeVisit& visit : visits) {
    const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(visit.node)];
    if (node.mesh < 0 && node.camera < 0 && node.children.empty() && node.extensions.empty() &&
        !is_joint[static_cast<std::size_t>(visit.node)] && !has_profile(node) && !has_panel(node) &&
        !asked_for(node)) {
      context.warnings.add("node", node_name(model, visit.node),
                           "no mesh, light, camera or child; Blender's exporter drops area lights "
                           "like that: pass --area-light NAME=WxH,LUMENS, or see docs/lights.md");
    }
  }
}

}  // namespace

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

std::vector<NodeVisit> visit_nodes(const tinygltf::Model& model, ImportContext& context) {
  std::vector<NodeVisit> visits;
  Walk walk(model, context);
  for (const int root : root_nodes(model, context)) walk.from_root(root, visits);
  warn_about_empty_nodes(model, visits, context);
  return visits;
}

std::string node_name(const tinygltf::Model& model, int node) {
  const std::string& name = model.nodes[static_cast<std::size_t>(node)].name;
  return name.empty() ? fmt::format("node {}", node) : name;
}

}  // namespace photile::scene_io
