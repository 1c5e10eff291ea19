#include "trace/ray_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "photile/errors.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene_builder.hpp"
#include "scene/scene_queries.hpp"
#include "trace/hot_spots.hpp"
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

}  // namespace

RayScene::Impl::Impl(const Scene& scene)
    : scene(&scene), needs(needs_of(scene)), bounds(scene::bounds_of(scene)), coincident(scene) {
  try {
    build();
  } catch (...) {
    release();
    throw;
  }
}

RayScene::Impl::~Impl() { release(); }

std::optional<trace::TriangleHit> RayScene::Impl::intersect(const trace::RayOrigin& from,
                                                            const glm::vec3& direction) const {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const glm::vec3& origin = from.position;
  if (!finite(origin, direction)) return std::nullopt;
  if (from.next != none) {
    trace::TriangleHit hit = trace::nearest_on_triangle(*scene, from.next, glm::dvec3(origin));
    hit.other = from.from;
    hit.other_before = true;
    return hit;
  }

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
    return resolve_coincident({triangle, query.hit.u, query.hit.v}, direction);
  }
  const std::uint32_t first = scene->instances[query.hit.instID[0]].first_triangle;
  // Weights of an instance's own triangle would not do: its corners may come in another order.
  return resolve_coincident(
      trace::nearest_on_triangle(
          *scene, first + query.hit.primID,
          glm::dvec3(origin) + double{query.ray.tfar} * glm::dvec3(direction)),
      direction);
}

trace::TriangleHit RayScene::Impl::resolve_coincident(const trace::TriangleHit& hit,
                                                      const glm::vec3& direction) const {
  if (!coincident.overlap(hit.triangle)) return hit;
  const trace::SurfacePoint met = trace::surface_hit(*scene, hit, direction);
  const glm::dvec3 position(met.position);
  const std::uint32_t face = coincident.at(*scene, met.oriented_face(), position);
  trace::TriangleHit first = hit;
  if (triangle_of(face) != hit.triangle) {
    first = trace::nearest_on_triangle(*scene, triangle_of(face), position);
  }
  const Material& material = scene->materials[scene->triangle_material[first.triangle]];
  if (material.interaction == Interaction::glass || material.has_cutouts()) {
    const std::uint32_t beyond = triangle_of(coincident.at(*scene, face ^ 1u, position));
    if (beyond != first.triangle) first.other = beyond;
  }
  return first;
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
  impl_->hot_spots = std::make_unique<const trace::HotSpots>(*impl_);
}
const trace::HotSpots& trace::hot_spots_of(const RayScene::Impl& rays) { return *rays.hot_spots; }
const RayScene::Impl& impl_of(const RayScene& scene) { return *scene.impl_; }
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

const Scene& RayScene::scene() const { return *impl_->scene; }
const SceneNeeds& RayScene::needs() const { return impl_->needs; }
std::uint64_t RayScene::bytes() const {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(0, impl_->bytes.load()));
}

// Building the Embree BVH: the scene's own triangles, and meshes that several instances share.

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
  throw Error(scene.source.string() + ": " + call + " of Embree failed with " + name_of(error) +
              " for " + std::to_string(scene.triangle_count()) + " triangles" + remedy);
}

bool count_bytes(void* bytes, ssize_t change, bool /*after the change*/) {
  static_cast<std::atomic<std::int64_t>*>(bytes)->fetch_add(change, std::memory_order_relaxed);
  return true;
}

RTCScene new_scene(RTCDevice device) {
  const RTCScene scene = rtcNewScene(device);
  // Robust: no ray slips through the edge between two triangles.
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  return scene;
}

/// Attaches triangles under the number `id`. The indices must outlive the scene, vertices need not.
void attach_triangles(RTCDevice device, RTCScene bvh, unsigned id,
                      const std::vector<glm::vec3>& vertices,
                      const std::vector<glm::uvec3>& triangles) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  // Embree reads vertices 16 bytes at a time, beyond the end of the last one: its own buffer has
  // the room. Indices have no such need and are shared.
  void* copy = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                       sizeof(glm::vec3), vertices.size());
  if (copy != nullptr) {
    std::copy(vertices.begin(), vertices.end(), static_cast<glm::vec3*>(copy));
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               triangles.data(), 0, sizeof(glm::uvec3), triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(bvh, geometry, id);
  }
  rtcReleaseGeometry(geometry);
}

/// Attaches a mesh's BVH, moved by `to_world`, under the number `id`.
void attach_instance(RTCDevice device, RTCScene bvh, unsigned id, RTCScene mesh,
                     const glm::mat4x3& to_world) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, mesh);
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &to_world[0][0]);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(bvh, geometry, id);
  rtcReleaseGeometry(geometry);
}

}  // namespace

void RayScene::Impl::build() {
  device = rtcNewDevice(nullptr);
  check(device, *scene, "rtcNewDevice");
  rtcSetDeviceMemoryMonitorFunction(device, count_bytes, &bytes);
  bvh = new_scene(device);
  build_instances();
  build_single_triangles();
  check(device, *scene, "rtcSetNewGeometryBuffer");
  rtcCommitScene(bvh);
  check(device, *scene, "rtcCommitScene");
}

void RayScene::Impl::build_instances() {
  for (const SharedMesh& shared : scene->shared_meshes) {
    const RTCScene mesh = meshes.emplace_back(new_scene(device));
    attach_triangles(device, mesh, 0, shared.vertices, shared.triangles);
    rtcCommitScene(mesh);
    check(device, *scene, "rtcCommitScene");
  }
  for (std::size_t i = 0; i < scene->instances.size(); ++i) {
    const MeshInstance& instance = scene->instances[i];
    attach_instance(device, bvh, static_cast<unsigned>(i), meshes[instance.mesh],
                    instance.to_world);
  }
}

void RayScene::Impl::build_single_triangles() {
  const auto id = static_cast<unsigned>(scene->instances.size());
  if (scene->instances.empty()) {
    attach_triangles(device, bvh, id, scene->vertices, scene->triangles);
    return;
  }
  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> number(scene->vertices.size(), none);  // of a vertex in `vertices`
  std::uint32_t next = 0;
  const auto add_until = [&](std::uint32_t end) {
    for (; next < end; ++next) {
      glm::uvec3 corners = scene->triangles[next];
      for (int c = 0; c < 3; ++c) {
        std::uint32_t& vertex = number[corners[c]];
        if (vertex == none) {
          vertex = static_cast<std::uint32_t>(vertices.size());
          vertices.push_back(scene->vertices[corners[c]]);
        }
        corners[c] = vertex;
      }
      single_triangles.push_back(next);
      single_corners.push_back(corners);
    }
  };
  for (const MeshInstance& instance : scene->instances) {
    add_until(instance.first_triangle);
    next += static_cast<std::uint32_t>(scene->shared_meshes[instance.mesh].triangles.size());
  }
  add_until(static_cast<std::uint32_t>(scene->triangle_count()));
  if (!single_corners.empty()) attach_triangles(device, bvh, id, vertices, single_corners);
  bytes += static_cast<std::int64_t>(single_triangles.capacity() * sizeof(std::uint32_t) +
                                     single_corners.capacity() * sizeof(glm::uvec3));
}

void RayScene::Impl::release() {
  if (bvh != nullptr) rtcReleaseScene(bvh);
  for (const RTCScene mesh : meshes) rtcReleaseScene(mesh);
  if (device != nullptr) rtcReleaseDevice(device);
}

}  // namespace photile
