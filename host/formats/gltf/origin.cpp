#include <map>

#include "gltf/primitives.hpp"
#include "gltf/steps.hpp"
#include "reading/scene_origin.hpp"

namespace photile::gltf {
namespace {

void add_triangles(const reading::LocalMesh& local, const glm::dmat4& world,
                   reading::SceneOrigin& origin) {
  for (const glm::uvec3& triangle : local.triangles) {
    std::array<glm::dvec3, 3> corners;
    for (int c = 0; c < 3; ++c) {
      corners[static_cast<std::size_t>(c)] =
          glm::dvec3(world * glm::dvec4(local.positions[triangle[c]], 1.0));
    }
    origin.add(corners);
  }
}

}  // namespace

void move_to_origin(const tinygltf::Model& model, const AccessorReader& accessors,
                    std::vector<NodeVisit>& visits, reading::ImportContext& context) {
  std::map<int, std::vector<const NodeVisit*>> visits_of;  // each mesh is read once
  for (const NodeVisit& visit : visits) {
    const int mesh = model.nodes[static_cast<std::size_t>(visit.node)].mesh;
    if (mesh >= 0 && static_cast<std::size_t>(mesh) < model.meshes.size()) {
      visits_of[mesh].push_back(&visit);
    }
  }
  reading::SceneOrigin origin;
  for (const auto& [mesh, places] : visits_of) {
    const reading::LocalMesh local = read_local_mesh(model, mesh, accessors, context);
    for (const NodeVisit* visit : places) add_triangles(local, visit->world, origin);
  }
  context.scene.origin = origin.best();
  for (NodeVisit& visit : visits) visit.world[3] -= glm::dvec4(context.scene.origin, 0.0);
}

}  // namespace photile::gltf
