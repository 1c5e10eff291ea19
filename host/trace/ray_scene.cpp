#include "photile/ray_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trace/ray_scene_impl.hpp"

namespace photile {

namespace {

/// The point of `triangle` nearest to `position`, which lies on it within rounding. Weights of an
/// instance's own triangle would not do: its corners may come in another order.
TriangleHit hit_at(const Scene& scene, std::uint32_t triangle, const glm::dvec3& position) {
  const auto [a, b, c] = scene.corners(triangle);
  const glm::dvec3 along_u = glm::dvec3(b) - glm::dvec3(a), along_v = glm::dvec3(c) - glm::dvec3(a);
  const glm::dvec3 offset = position - glm::dvec3(a);
  const double uu = glm::dot(along_u, along_u), uv = glm::dot(along_u, along_v),
               vv = glm::dot(along_v, along_v);
  const double pu = glm::dot(offset, along_u), pv = glm::dot(offset, along_v);
  const double determinant = uu * vv - uv * uv;
  const double u = std::clamp((vv * pu - uv * pv) / determinant, 0.0, 1.0);
  const double v = std::clamp((uu * pv - uv * pu) / determinant, 0.0, 1.0 - u);
  return {triangle, static_cast<float>(u), static_cast<float>(v)};
}

Box bounds_of(const Scene& scene) {
  Box box{glm::vec3(std::numeric_limits<float>::infinity()),
          glm::vec3(-std::numeric_limits<float>::infinity())};
  for (const glm::vec3& vertex : scene.vertices) {
    box.low = glm::min(box.low, vertex);
    box.high = glm::max(box.high, vertex);
  }
  return box;
}

}  // namespace

RayScene::Impl::Impl(const Scene& scene) : scene(&scene), bounds(bounds_of(scene)) {
  try {
    build();
  } catch (...) {
    release();
    throw;
  }
}

RayScene::Impl::~Impl() { release(); }

std::optional<TriangleHit> RayScene::Impl::intersect(const glm::vec3& origin,
                                                     const glm::vec3& direction) const {
  // A comparison with NaN is false, so this refuses NaN as well. Embree would walk the whole tree.
  const float sum = std::abs(origin.x) + std::abs(origin.y) + std::abs(origin.z) +
                    std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
  if (!(sum < std::numeric_limits<float>::infinity())) return std::nullopt;

  RTCRayHit query;
  query.ray.org_x = origin.x;
  query.ray.org_y = origin.y;
  query.ray.org_z = origin.z;
  query.ray.dir_x = direction.x;
  query.ray.dir_y = direction.y;
  query.ray.dir_z = direction.z;
  query.ray.tnear = 0.0f;
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.time = 0.0f;
  query.ray.mask = ~0u;
  query.ray.flags = 0;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(bvh, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  if (query.hit.instID[0] == RTC_INVALID_GEOMETRY_ID) {
    const std::uint32_t triangle =
        single_triangles.empty() ? query.hit.primID : single_triangles[query.hit.primID];
    return TriangleHit{triangle, query.hit.u, query.hit.v};
  }
  const std::uint32_t first = scene->instances[query.hit.instID[0]].first_triangle;
  return hit_at(*scene, first + query.hit.primID,
                glm::dvec3(origin) + double{query.ray.tfar} * glm::dvec3(direction));
}

RayScene::RayScene(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

const Scene& RayScene::scene() const { return *impl_->scene; }
std::uint64_t RayScene::bytes() const {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(0, impl_->bytes.load()));
}

}  // namespace photile
