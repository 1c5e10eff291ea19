#include "estimate/hit_buffers.hpp"

#include <span>
#include <vector>

namespace photile::estimate {
namespace {

std::span<const float> floats(const std::vector<glm::vec3>& values, std::size_t first,
                              std::size_t count) {
  return {&values[first].x, 3 * count};
}

/// One member of every lobe, packed for the device.
template <class Member>
device::Buffer<float> upload_lobes(device::Context& context, const PrimaryHits& hits,
                                   std::size_t first, std::size_t count, Member member,
                                   std::string_view what) {
  std::vector<glm::vec3> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = hits.lobe[first + i].*member;
  return context.upload(floats(values, 0, count), what);
}

}  // namespace

std::uint64_t hit_bytes(bool glossy, bool normals, bool clipped) {
  constexpr std::uint64_t position_and_map = 3 * sizeof(float) + sizeof(std::uint32_t);
  constexpr std::uint64_t surface = (4 * 3 + 1) * sizeof(float);
  constexpr std::uint64_t normal = 3 * sizeof(float);
  constexpr std::uint64_t place = 3 * sizeof(std::uint32_t);
  return position_and_map + (glossy ? surface : 0) + (normals || clipped ? normal : 0) +
         (clipped ? place : 0);
}

HitBuffers upload_hits(device::Context& context, const PrimaryHits& hits, std::size_t first,
                       std::span<const std::uint32_t> maps, std::span<const glm::vec3> normals,
                       const SurfaceIndex* surface, bool glossy) {
  const std::size_t count = maps.size();
  HitBuffers buffers;
  buffers.count = static_cast<std::uint32_t>(count);
  if (count == 0) return buffers;
  buffers.position = context.upload(floats(hits.position, first, count), "hit positions");
  buffers.map = context.upload(maps, "maps of hits");
  if (surface != nullptr) {
    normals = surface->normal;
    std::vector<std::uint32_t> places;
    places.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t own = hits.sided_triangle[first + i];
      const std::uint32_t triangle = triangle_of(surface->original[own]);
      places.insert(places.end(), {surface->facet[triangle], triangle, surface->sheet[own]});
    }
    buffers.place = context.upload(std::span<const std::uint32_t>(places), "places of hits");
  }
  if (!normals.empty()) {
    std::vector<glm::vec3> of_hits(count);
    for (std::size_t i = 0; i < count; ++i) of_hits[i] = normals[hits.sided_triangle[first + i]];
    buffers.face_normal = context.upload(floats(of_hits, 0, count), "hit face normals");
  }
  if (!glossy) return buffers;
  buffers.outgoing = context.upload(floats(hits.outgoing, first, count), "hit directions");
  buffers.albedo = context.upload(floats(hits.diffuse_albedo, first, count), "hit albedos");
  buffers.normal =
      upload_lobes(context, hits, first, count, &HitLobe::normal, "hit shading normals");
  buffers.specular =
      upload_lobes(context, hits, first, count, &HitLobe::specular, "hit specular colours");
  std::vector<float> roughness(count);
  for (std::size_t i = 0; i < count; ++i) roughness[i] = hits.lobe[first + i].roughness;
  buffers.roughness = context.upload(std::span<const float>(roughness), "hit roughness");
  return buffers;
}

}  // namespace photile::estimate
