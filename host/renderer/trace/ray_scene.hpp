// RayScene as the rest of host/renderer/trace sees it: one function that intersects a ray.
#pragma once

#include <embree3/rtcore.h>

#include <atomic>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geometry/box.hpp"
#include "photile/ray_scene.hpp"
#include "scene/coincident_faces.hpp"
#include "trace/ray_query.hpp"
#include "trace/surface.hpp"

namespace photile {

namespace trace {
class HotSpots;
}

struct RayScene::Impl {
  explicit Impl(const Scene& scene);
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// Nearest hit of the ray, or nothing. Thread-safe. A ray with a NaN or infinity hits nothing.
  std::optional<trace::TriangleHit> intersect(const trace::RayOrigin& origin,
                                              const glm::vec3& direction) const;
  /// Among coincident triangles at a hit, the one that the ray hits.
  trace::TriangleHit resolve_coincident(const trace::TriangleHit& hit,
                                        const glm::vec3& direction) const;

  /// Whether anything lies on the straight line between two points. Thread-safe. A line with a NaN
  /// or infinity hits nothing.
  bool occluded(const glm::vec3& from, const glm::vec3& to) const;
  /// Tests up to `packet` lines at once.
  void occluded(std::span<const trace::LineOfSight> lines, std::span<std::uint8_t> hidden) const;
  static constexpr std::size_t packet = 16;

  const Scene* scene;
  SceneNeeds needs;
  geometry::Box bounds;  ///< encloses all triangles, metres
  scene::CoincidentFaces coincident;
  std::atomic<std::int64_t> bytes{0};  ///< outlives the device, which reports to it
  RTCDevice device = nullptr;
  RTCScene bvh = nullptr;
  std::vector<RTCScene> meshes;  ///< of the scene's shared meshes

  // Triangles that belong to no instance; empty where none is an instance's.
  std::vector<std::uint32_t> single_triangles;  ///< their numbers in the scene
  std::vector<glm::uvec3> single_corners;       ///< Embree reads them from here

  std::unique_ptr<const trace::HotSpots> hot_spots;  ///< never null, once the BVH is built

 private:
  void build();
  void build_instances();
  void build_single_triangles();
  void release();
};

/// The data of a scene that host/renderer/trace needs.
const RayScene::Impl& impl_of(const RayScene& scene);

namespace trace {

/// As in ray_query.hpp.
glm::vec3 transmittance(const RayScene::Impl& rays, const RayOrigin& from, const glm::vec3& to);

}  // namespace trace

}  // namespace photile
