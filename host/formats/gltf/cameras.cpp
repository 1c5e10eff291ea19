#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "gltf/steps.hpp"
#include "scene/coordinate_limit.hpp"

namespace photile::gltf {
namespace {

bool has_orientation(const glm::dmat4& world) {
  const double area = glm::length(glm::cross(glm::dvec3(world[1]), glm::dvec3(world[2])));
  return std::isfinite(area) && area > 0.0 && scene::within_limit(glm::dvec3(world[3]));
}

void add_camera(const tinygltf::Camera& source, const std::string& name, const glm::dmat4& world,
                reading::ImportContext& context) {
  if (source.type != "perspective") {
    context.warnings.add("camera", name, "not a perspective camera; skipped");
    return;
  }
  const double field_of_view = source.perspective.yfov;
  if (!(field_of_view > 0.0 && field_of_view < std::numbers::pi) || !has_orientation(world)) {
    context.warnings.add("camera", name, "no sensible field of view or orientation; skipped");
    return;
  }
  const glm::dvec3 position(world[3]);
  Camera camera = Camera::look_at(position, position - glm::normalize(glm::dvec3(world[2])),
                                  glm::normalize(glm::dvec3(world[1])), field_of_view);
  camera.name = name;
  const double aspect = source.perspective.aspectRatio;
  camera.aspect_ratio = std::isfinite(aspect) && aspect > 0.0 ? aspect : 0.0;
  context.scene.cameras.push_back(std::move(camera));
}

}  // namespace

void add_gltf_cameras(const tinygltf::Model& model, const std::vector<NodeVisit>& visits,
                      reading::ImportContext& context) {
  for (const NodeVisit& visit : visits) {
    const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(visit.node)];
    if (node.camera < 0) continue;
    if (static_cast<std::size_t>(node.camera) >= model.cameras.size()) {
      throw context.error(fmt::format("node '{}': there is no camera {}; export it again",
                                      node_name(model, visit.node), node.camera));
    }
    const tinygltf::Camera& camera = model.cameras[static_cast<std::size_t>(node.camera)];
    const bool unnamed = node.name.empty() && !camera.name.empty();
    add_camera(camera, unnamed ? camera.name : node_name(model, visit.node), visit.world, context);
  }
}

}  // namespace photile::gltf
