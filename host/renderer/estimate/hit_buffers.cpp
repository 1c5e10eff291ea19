#include "estimate/hit_buffers.hpp"

#include <span>
#include <vector>

#include "trace/diffuse_part.hpp"

namespace photile::estimate {
namespace {

std::span<const float> floats(const std::vector<glm::vec3>& values, std::size_t first,
                              std::size_t count) {
  return {&values[first].x, 3 * count};
}

/// Makes a buffer hold the values, allocated anew where it has no room for them.
template <class T>
void put(device::Context& context, device::Buffer<T>& buffer, std::span<const T> values,
         std::string_view what) {
  if (buffer.size() < values.size()) {
    buffer = {};
    buffer = context.allocate<T>(values.size(), what);
  }
  context.write_beside(buffer, values);
}

/// One member of every lobe, packed for the device.
template <class Member>
void put_lobes(device::Context& context, device::Buffer<float>& buffer, const PrimaryHits& hits,
               std::size_t first, std::size_t count, Member member, std::string_view what) {
  std::vector<glm::vec3> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = hits.lobe[first + i].*member;
  put(context, buffer, floats(values, 0, count), what);
}

std::vector<trace::DiffusePart> diffuse_of(const PrimaryHits& hits, std::size_t first,
                                           std::size_t count) {
  std::vector<trace::DiffusePart> parts(count);
  for (std::size_t i = 0; i < count; ++i) {
    const HitLobe& lobe = hits.lobe[first + i];
    parts[i] = trace::diffuse_part(
        {hits.diffuse_albedo[first + i], lobe.specular, lobe.f90, lobe.roughness},
        glm::dot(lobe.normal, hits.outgoing[first + i]));
  }
  return parts;
}

std::vector<glm::vec4> bumps_of(const PrimaryHits& hits, std::size_t first, std::size_t count) {
  std::vector<glm::vec4> bumps(count);
  for (std::size_t i = 0; i < count; ++i) {
    bumps[i] =
        glm::vec4(hits.lobe[first + i].smooth_normal,
                  trace::most_bump(hits.diffuse_albedo[first + i] + hits.lobe[first + i].specular));
  }
  return bumps;
}

}  // namespace

std::uint64_t hit_bytes(const SceneNeeds& needs, bool normals, bool clipped) {
  constexpr std::uint64_t position_and_map = 3 * sizeof(float) + sizeof(std::uint32_t);
  constexpr std::uint64_t surface = (6 * 3 + 2) * sizeof(float);
  constexpr std::uint64_t bump = 4 * sizeof(float);
  constexpr std::uint64_t normal = 3 * sizeof(float);
  constexpr std::uint64_t place = 3 * sizeof(std::uint32_t) + 3 * sizeof(float);
  return position_and_map + (needs.glossy ? surface : 0) + (needs.normal_maps ? bump : 0) +
         (normals || clipped ? normal : 0) + (clipped ? place : 0);
}

void upload_hits(device::Context& context, const PrimaryHits& hits, std::size_t first,
                 std::span<const std::uint32_t> maps, std::span<const glm::vec3> normals,
                 const SurfaceBuffers* surface, const SceneNeeds& needs, HitBuffers& buffers) {
  const std::size_t count = maps.size();
  buffers.count = static_cast<std::uint32_t>(count);
  if (count == 0) return;
  put(context, buffers.position, floats(hits.position, first, count), "hit positions");
  put(context, buffers.map, maps, "maps of hits");
  if (surface != nullptr) {
    const SurfaceIndex& index = surface->index;
    normals = index.normal;
    std::vector<std::uint32_t> places;
    std::vector<glm::vec3> inwards(count);
    places.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t own = hits.sided_triangle[first + i];
      const std::uint32_t triangle = triangle_of(index.original[own]);
      places.insert(places.end(), {index.facet[triangle], triangle,
                                   index.sheet_at(own, hits.position[first + i])});
      inwards[i] = surface->centroid[triangle] - hits.position[first + i];
    }
    put(context, buffers.place, std::span<const std::uint32_t>(places), "places of hits");
    put(context, buffers.inwards, floats(inwards, 0, count), "ways into triangles of hits");
  }
  if (!normals.empty()) {
    std::vector<glm::vec3> of_hits(count);
    for (std::size_t i = 0; i < count; ++i) of_hits[i] = normals[hits.sided_triangle[first + i]];
    put(context, buffers.face_normal, floats(of_hits, 0, count), "hit face normals");
  }
  if (!needs.glossy) return;
  put(context, buffers.outgoing, floats(hits.outgoing, first, count), "hit directions");
  put_lobes(context, buffers.normal, hits, first, count, &HitLobe::normal, "hit shading normals");
  const std::vector<trace::DiffusePart> diffuse = diffuse_of(hits, first, count);
  put(context, buffers.diffuse, std::span<const float>(&diffuse[0][0].x, 9 * count),
      "hit diffuse parts");
  put_lobes(context, buffers.f0, hits, first, count, &HitLobe::specular, "hit F0");
  std::vector<glm::vec2> shape(count);
  for (std::size_t i = 0; i < count; ++i) {
    shape[i] = {hits.lobe[first + i].roughness, hits.lobe[first + i].f90};
  }
  put(context, buffers.shape, std::span<const float>(&shape[0].x, 2 * count), "hit lobes");
  if (!needs.normal_maps) return;
  const std::vector<glm::vec4> bumps = bumps_of(hits, first, count);
  put(context, buffers.bump, std::span<const float>(&bumps[0].x, 4 * count), "hit normal maps");
}

}  // namespace photile::estimate
