#include "photile/ray_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "photile/scene_builder.hpp"
#include "trace/ray_scene_impl.hpp"
#include "trace/surface.hpp"

namespace photile {

namespace {

/// A ray from `origin` to `end` times `direction`, ready for Embree.
RTCRay ray_of(const glm::vec3& origin, const glm::vec3& direction, float end) {
  RTCRay ray;
  ray.org_x = origin.x;
  ray.org_y = origin.y;
  ray.org_z = origin.z;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.tnear = 0.0f;
  ray.tfar = end;
  ray.time = 0.0f;
  ray.mask = ~0u;
  ray.flags = 0;
  return ray;
}

/// Embree would walk the whole tree for other rays.
bool finite(const glm::vec3& origin, const glm::vec3& direction) {
  const float sum = std::abs(origin.x) + std::abs(origin.y) + std::abs(origin.z) +
                    std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
  return sum < std::numeric_limits<float>::infinity();  // false for NaN as well
}

geometry::Box bounds_of(const Scene& scene) {
  geometry::Box box;
  for (const glm::vec3& vertex : scene.vertices) box.extend(vertex);
  return box;
}

}  // namespace

RayScene::Impl::Impl(const Scene& scene)
    : scene(&scene), needs(needs_of(scene)), bounds(bounds_of(scene)) {
  try {
    build();
  } catch (...) {
    release();
    throw;
  }
}

RayScene::Impl::~Impl() { release(); }

std::optional<trace::TriangleHit> RayScene::Impl::intersect(const glm::vec3& origin,
                                                            const glm::vec3& direction) const {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  if (!finite(origin, direction)) return std::nullopt;

  RTCRayHit query;
  query.ray = ray_of(origin, direction, infinity);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(bvh, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  if (query.hit.instID[0] == RTC_INVALID_GEOMETRY_ID) {
    const std::uint32_t triangle =
        single_triangles.empty() ? query.hit.primID : single_triangles[query.hit.primID];
    return trace::TriangleHit{triangle, query.hit.u, query.hit.v};
  }
  const std::uint32_t first = scene->instances[query.hit.instID[0]].first_triangle;
  // Weights of an instance's own triangle would not do: its corners may come in another order.
  return trace::nearest_on_triangle(
      *scene, first + query.hit.primID,
      glm::dvec3(origin) + double{query.ray.tfar} * glm::dvec3(direction));
}

bool RayScene::Impl::occluded(const glm::vec3& from, const glm::vec3& to) const {
  if (!finite(from, to - from)) return false;
  RTCRay ray = ray_of(from, to - from, 1.0f);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(bvh, &context, &ray);
  return ray.tfar < 0.0f;
}

void RayScene::Impl::occluded(std::span<const trace::LineOfSight> lines,
                              std::span<std::uint8_t> hidden) const {
  alignas(64) int valid[packet];
  RTCRay16 rays;
  for (std::size_t i = 0; i < packet; ++i) {
    const auto& [from, to] = lines[std::min(i, lines.size() - 1)];
    const glm::vec3 way = to - from;
    valid[i] = i < lines.size() && finite(from, way) ? -1 : 0;
    rays.org_x[i] = from.x;
    rays.org_y[i] = from.y;
    rays.org_z[i] = from.z;
    rays.dir_x[i] = way.x;
    rays.dir_y[i] = way.y;
    rays.dir_z[i] = way.z;
    rays.tnear[i] = 0.0f;
    rays.tfar[i] = 1.0f;
    rays.time[i] = 0.0f;
    rays.mask[i] = ~0u;
    rays.flags[i] = 0;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded16(valid, bvh, &context, &rays);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    hidden[i] = valid[i] != 0 && rays.tfar[i] < 0.0f ? 1 : 0;
  }
}

RayScene::RayScene(const Scene& scene) {
  check_scene(scene);
  impl_ = std::make_unique<Impl>(scene);
}
const RayScene::Impl& impl_of(const RayScene& scene) { return *scene.impl_; }
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

const Scene& RayScene::scene() const { return *impl_->scene; }
const SceneNeeds& RayScene::needs() const { return impl_->needs; }
std::uint64_t RayScene::bytes() const {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(0, impl_->bytes.load()));
}

}  // namespace photile
