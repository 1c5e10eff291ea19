// Triangles of scene files: polygons are split, the origin of their coordinates is chosen, and
// meshes that several nodes place are shared.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <vector>

#include "photile/progress.hpp"
#include "photile/scene.hpp"

namespace photile::reading {

struct Triangulation {
  /// Corner numbers, three for each triangle, wound as the polygon is.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// False when the polygon crosses itself or has no area: the triangles then cover it as well as
  /// they can.
  bool simple = true;
};

/// Triangulates a polygon of at least 3 corners that may be concave and slightly bent. Works in
/// the plane of the polygon's mean normal (Newell's), in double precision. The triangles and their
/// order do not depend on the polygon's winding nor on the corner it starts from. Errors:
/// Interrupted.
Triangulation triangulate_polygon(std::span<const glm::dvec3> corners,
                                  const Progress& progress = Progress::none());

/// Finds the origin of a scene (Scene::origin) from its triangles, before they are rounded to
/// float.
///
/// Rounding moves a corner by its distance from the origin times 2^-24. What that does to a
/// triangle depends on its size, so the origin is the point from which the corners' distances, in
/// units of their triangle's longest edge, have the least sum of squares: the mean of the corners,
/// weighted with 1 / longest edge^2. In a landscape with one lamp that is the lamp.
class SceneOrigin {
 public:
  /// Counts a triangle. One with a corner beyond the limit, or with all in one point, does not
  /// count.
  void add(const std::array<glm::dvec3, 3>& corners);

  /// The origin, in coordinates that are floats. That of the file, (0, 0, 0), unless it is so far
  /// from the triangles that another one is worth the change: their corners then lie beyond 64
  /// longest edges from it (root mean square) and at most a 16th as far from the new one. Rays
  /// start clear of a surface by some roundings of its coordinates: at 1,024 edges that would be
  /// two centimetres in a room with walls of 12 m.
  glm::dvec3 best() const;

 private:
  std::uint64_t corners_ = 0;
  double weight_ = 0;
  glm::dvec3 sum_{0.0};  ///< weight x corner
  double squares_ = 0;   ///< weight x squared distance from (0, 0, 0)
};

/// Triangles as the file has them, in the mesh's own space.
struct LocalMesh {
  std::vector<glm::dvec3> positions;
  std::vector<glm::uvec3> triangles;
};

/// Gathers the placements of each mesh while the scene is filled, and writes Scene::shared_meshes
/// and Scene::instances. A placement becomes no instance, and its triangles stay single, where rays
/// that Embree moves into the mesh's space could lose more than rounding: under a skew, or without
/// an inverse. The same goes for a placement where other triangles lost their area than elsewhere.
class InstanceRecorder {
 public:
  explicit InstanceRecorder(Scene& scene) : scene_(scene) {}

  /// A node placed `mesh`: its triangles are those from `first_triangle` on. `kept` says for each
  /// triangle of the file whether the scene has it. `read` gives the mesh itself, when it is met
  /// for the first time.
  void record(int mesh, const glm::dmat4& world, std::uint32_t first_triangle,
              const std::vector<bool>& kept, const std::function<LocalMesh()>& read);

  /// Writes what is worth sharing: large meshes with several placements.
  void finish();

 private:
  struct Instance {
    std::uint32_t first_triangle;
    glm::mat4x3 to_world;
  };
  struct Mesh {
    SharedMesh shared;
    glm::dvec3 centre{0.0};
    std::vector<bool> kept;
    std::vector<Instance> instances;
  };

  Scene& scene_;
  std::map<int, Mesh> meshes_;
};

}  // namespace photile::reading
