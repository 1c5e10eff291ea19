#include "trace/holes.hpp"

#include "trace/ray_scene_impl.hpp"

namespace photile::trace {
namespace {

/// Each hole takes a ray on, but for rounding: paths must end.
constexpr std::uint32_t most_holes = 4096;

}  // namespace

bool passes_hole(const Scene& scene, const SurfacePoint& point, const RandomStream& random,
                 Purpose purpose, std::uint32_t& holes) {
  if (!material_of(scene, point).has_holes() || holes >= most_holes) return false;
  const float there = opacity(scene, point);
  if (there >= 1.0f) return false;
  const std::uint32_t number = holes++;
  return there <= 0.0f || random.block(purpose, number).uniform(0) >= there;
}

std::optional<SurfacePoint> next_surface(const RayScene::Impl& rays, glm::vec3& origin,
                                         const glm::vec3& direction, const RandomStream& random,
                                         Purpose purpose, std::uint32_t& holes) {
  while (const auto hit = rays.intersect(origin, direction)) {
    const SurfacePoint point = surface_hit(*rays.scene, *hit, direction);
    if (!passes_hole(*rays.scene, point, random, purpose, holes)) return point;
    origin = point.origin_towards(direction);
  }
  return std::nullopt;
}

std::optional<SurfacePoint> next_surface(const RayScene& rays, glm::vec3& origin,
                                         const glm::vec3& direction, const RandomStream& random,
                                         Purpose purpose, std::uint32_t& holes) {
  return next_surface(impl_of(rays), origin, direction, random, purpose, holes);
}

}  // namespace photile::trace
