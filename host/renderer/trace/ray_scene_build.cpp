// Building the Embree BVH: the scene's own triangles, and meshes that several places share.
#include <algorithm>
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
