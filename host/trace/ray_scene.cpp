#include "photile/ray_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "photile/errors.hpp"
#include "trace/ray_scene_impl.hpp"

namespace photile {

namespace {

const char* name_of(RTCError error) {
  switch (error) {
    case RTC_ERROR_NONE:
      return "RTC_ERROR_NONE";
    case RTC_ERROR_INVALID_ARGUMENT:
      return "RTC_ERROR_INVALID_ARGUMENT";
    case RTC_ERROR_INVALID_OPERATION:
      return "RTC_ERROR_INVALID_OPERATION";
    case RTC_ERROR_OUT_OF_MEMORY:
      return "RTC_ERROR_OUT_OF_MEMORY";
    case RTC_ERROR_UNSUPPORTED_CPU:
      return "RTC_ERROR_UNSUPPORTED_CPU";
    case RTC_ERROR_CANCELLED:
      return "RTC_ERROR_CANCELLED";
    default:
      return "RTC_ERROR_UNKNOWN";
  }
}

/// Throws if Embree recorded an error since the last call. `call` names what was tried.
void check(RTCDevice device, const Scene& scene, const char* call) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  const std::string remedy = error == RTC_ERROR_OUT_OF_MEMORY
                                 ? "; free memory or use a smaller scene"
                                 : "; Embree 3.13 on a CPU with SSE2 is needed";
  throw Error(ExitCode::failure,
              scene.source.string() + ": " + call + " of Embree failed with " + name_of(error) +
                  " for " + std::to_string(scene.triangle_count()) + " triangles" + remedy);
}

bool count_bytes(void* bytes, ssize_t change, bool /*after the change*/) {
  static_cast<std::atomic<std::int64_t>*>(bytes)->fetch_add(change, std::memory_order_relaxed);
  return true;
}

}  // namespace

RayScene::Impl::Impl(const Scene& scene) : scene(&scene) {
  try {
    build();
  } catch (...) {
    release();
    throw;
  }
}

RayScene::Impl::~Impl() { release(); }

void RayScene::Impl::build() {
  device = rtcNewDevice(nullptr);
  check(device, *scene, "rtcNewDevice");
  rtcSetDeviceMemoryMonitorFunction(device, count_bytes, &bytes);
  bvh = rtcNewScene(device);
  // Robust: no ray slips through the edge between two triangles.
  rtcSetSceneFlags(bvh, RTC_SCENE_FLAG_ROBUST);

  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  // Embree reads vertices 16 bytes at a time, beyond the end of the last one: its own buffer has
  // the room. Indices have no such need and are shared.
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(glm::vec3), scene->vertices.size());
  if (vertices != nullptr) {
    std::copy(scene->vertices.begin(), scene->vertices.end(), static_cast<glm::vec3*>(vertices));
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               scene->triangles.data(), 0, sizeof(glm::uvec3),
                               scene->triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(bvh, geometry);
  }
  rtcReleaseGeometry(geometry);
  check(device, *scene, "rtcSetNewGeometryBuffer");
  rtcCommitScene(bvh);
  check(device, *scene, "rtcCommitScene");
}

void RayScene::Impl::release() {
  if (bvh != nullptr) rtcReleaseScene(bvh);
  if (device != nullptr) rtcReleaseDevice(device);
}

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
  return TriangleHit{query.hit.primID, query.hit.u, query.hit.v};
}

Box RayScene::Impl::bounds() const {
  RTCBounds bounds;
  rtcGetSceneBounds(bvh, &bounds);
  return {{bounds.lower_x, bounds.lower_y, bounds.lower_z},
          {bounds.upper_x, bounds.upper_y, bounds.upper_z}};
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
