#include "trace/ray_query.hpp"

#include <algorithm>
#include <cmath>

#include "trace/ray_scene.hpp"
#include "trace/scatter.hpp"

namespace photile::trace {

glm::vec3 transmittance(const Scene& scene, const SurfacePoint& point, const glm::vec3& direction) {
  const Material& material = material_of(scene, point);
  const float there = material.has_cutouts() ? opacity(scene, point) : 1.0f;
  glm::vec3 surface(0.0f);
  if (material.interaction == Interaction::glass && material.thin) {
    surface = pane_transmittance(material, -glm::dot(direction, point.normal));
  }
  return glm::vec3(1.0f - there) + there * surface;
}

std::optional<TriangleHit> intersect(const RayScene& rays, const RayOrigin& origin,
                                     const glm::vec3& direction) {
  return impl_of(rays).intersect(origin, direction);
}

bool occluded(const RayScene& rays, const glm::vec3& from, const glm::vec3& to) {
  return impl_of(rays).occluded(from, to);
}

void occluded(const RayScene& rays, std::span<const LineOfSight> lines,
              std::span<std::uint8_t> hidden) {
  const RayScene::Impl& scene = impl_of(rays);
  for (std::size_t first = 0; first < lines.size(); first += RayScene::Impl::packet) {
    const std::size_t count = std::min(RayScene::Impl::packet, lines.size() - first);
    if (count == 1) {
      hidden[first] = scene.occluded(lines[first].from, lines[first].to) ? 1 : 0;
      continue;
    }
    scene.occluded(lines.subspan(first, count), hidden.subspan(first, count));
  }
}

glm::vec3 transmittance(const RayScene& rays, const RayOrigin& from, const glm::vec3& to) {
  return transmittance(impl_of(rays), from, to);
}

glm::vec3 transmittance(const RayScene::Impl& rays, const RayOrigin& from, const glm::vec3& to) {
  if (!rays.needs.see_through) {
    return glm::vec3(from.next != none || rays.occluded(from, to) ? 0.0f : 1.0f);
  }
  const Scene& scene = *rays.scene;
  const glm::vec3 direction = glm::normalize(to - from.position);
  glm::vec3 passed(1.0f);
  RayOrigin origin = from;
  while (origin.next != none || rays.occluded(origin, to)) {
    const auto hit = rays.intersect(origin, direction);
    if (!hit) return passed;  // rounding: the last surface ends where the line passes
    const SurfacePoint point = surface_hit(scene, *hit, direction);
    passed *= transmittance(scene, point, direction);
    if (passed == glm::vec3(0.0f)) return passed;
    origin = point.origin_towards(direction);
    if (glm::dot(to - origin.position, direction) <= 0.0f) return passed;
  }
  return passed;
}

namespace {

/// Each cutout moves a ray on, up to rounding: paths must end.
constexpr std::uint32_t most_cutouts = 4096;

}  // namespace

bool passes_cutout(const Scene& scene, const SurfacePoint& point, const RandomStream& random,
                   Purpose purpose, std::uint32_t& cutouts) {
  if (!material_of(scene, point).has_cutouts() || cutouts >= most_cutouts) return false;
  const float there = opacity(scene, point);
  if (there >= 1.0f) return false;
  const std::uint32_t number = cutouts++;
  return there <= 0.0f || random.block(purpose, number).uniform(0) >= there;
}

std::optional<SurfacePoint> next_surface(const RayScene::Impl& rays, RayOrigin& origin,
                                         const glm::vec3& direction, const RandomStream& random,
                                         Purpose purpose, std::uint32_t& cutouts) {
  while (const auto hit = rays.intersect(origin, direction)) {
    const SurfacePoint point = surface_hit(*rays.scene, *hit, direction);
    if (!passes_cutout(*rays.scene, point, random, purpose, cutouts)) return point;
    origin = point.origin_towards(direction);
  }
  return std::nullopt;
}

std::optional<SurfacePoint> next_surface(const RayScene& rays, RayOrigin& origin,
                                         const glm::vec3& direction, const RandomStream& random,
                                         Purpose purpose, std::uint32_t& cutouts) {
  return next_surface(impl_of(rays), origin, direction, random, purpose, cutouts);
}

bool see_each_other(const RayScene& rays, const SurfaceLocation& from, const SurfaceLocation& to,
                    const ShadowRayInset& line) {
  const glm::vec3 way = to.position - from.position;
  const float turn =
      std::max(std::abs(glm::dot(way, from.normal)), std::abs(glm::dot(way, to.normal)));
  const float height = line.offset + 0.5f * turn;
  const glm::vec3 start = from.position + height * from.normal;
  const glm::vec3 end = to.position + height * to.normal;
  return !occluded(rays, start, end + line.left_out * (start - end));
}

}  // namespace photile::trace
