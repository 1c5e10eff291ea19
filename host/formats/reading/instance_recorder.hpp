// Meshes that several nodes place: what the ray tracing structure may share.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <vector>

#include "photile/scene.hpp"

namespace photile::reading {

/// Triangles as the file has them, in the mesh's own space.
struct LocalMesh {
  std::vector<glm::dvec3> positions;
  std::vector<glm::uvec3> triangles;
};

/// Gathers the places of each mesh while the scene is filled, and writes Scene::shared_meshes and
/// Scene::instances. A place becomes no instance, and its triangles stay single, where rays that
/// Embree moves into the mesh's space could lose more than rounding: under a skew, or without an
/// inverse. The same goes for a place where other triangles lost their area than elsewhere.
class InstanceRecorder {
 public:
  explicit InstanceRecorder(Scene& scene) : scene_(scene) {}

  /// A node placed `mesh`: its triangles are those from `first_triangle` on. `kept` tells of each
  /// triangle of the file whether the scene took it. `read` gives the mesh itself, when it is met
  /// for the first time.
  void record(int mesh, const glm::dmat4& world, std::uint32_t first_triangle,
              const std::vector<bool>& kept, const std::function<LocalMesh()>& read);

  /// Writes what is worth sharing: large meshes in several places.
  void finish();

 private:
  struct Place {
    std::uint32_t first_triangle;
    glm::mat4x3 to_world;
  };
  struct Mesh {
    SharedMesh shared;
    glm::dvec3 centre{0.0};
    std::vector<bool> kept;
    std::vector<Place> places;
  };

  Scene& scene_;
  std::map<int, Mesh> meshes_;
};

}  // namespace photile::reading
