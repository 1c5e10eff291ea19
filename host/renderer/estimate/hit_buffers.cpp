#include "estimate/hit_buffers.hpp"

#include <tbb/parallel_for.h>

#include <cstring>
#include <span>
#include <string_view>
#include <vector>

#include "estimate/map_order.hpp"
#include "trace/opaque_bsdf.hpp"

namespace photile::estimate {

SurfaceBuffers::SurfaceBuffers(const maps::MapStore& store, const Scene& scene,
                               const SurfaceIndex& surface)
    : index(surface), centroid(scene.triangle_count()) {
  tbb::parallel_for(std::size_t{0}, centroid.size(), [&](std::size_t t) {
    const auto corners = scene.corners(static_cast<std::uint32_t>(t));
    centroid[t] = (corners[0] + corners[1] + corners[2]) / 3.0f;
  });
  device::Context& context = device::context_of(*store.device);
  const std::vector<std::uint8_t> lit = lit_components(surface, store.landed);
  std::vector<PhotileSurfaceLeaf> marked = surface.leaves;
  const auto mark = [&](std::uint32_t& component) {
    if ((component & PHOTILE_COMPONENT_UNLIT) == 0 && lit[component] == 0)
      component |= PHOTILE_COMPONENT_UNLIT;
  };
  for (PhotileSurfaceLeaf& leaf : marked) {
    for (std::uint32_t& component : leaf.front_component) mark(component);
    for (std::uint32_t& component : leaf.back_component) mark(component);
  }
  nodes = context.upload(std::span(surface.nodes), "surface tree");
  leaves = context.upload(std::span<const PhotileSurfaceLeaf>(marked), "surface pieces");
}

namespace {

static_assert(sizeof(PhotileHit) == 4 * 4, "PhotileHit must have no padding");
static_assert(sizeof(PhotileHitSurface) == 9 * 4, "PhotileHitSurface must have no padding");
static_assert(sizeof(PhotileHitLobe) == 24 * 4, "PhotileHitLobe must have no padding");

void store(float (&to)[3], const glm::vec3& value) {
  to[0] = value.x, to[1] = value.y, to[2] = value.z;
}

/// The surface at hits whose areas are clipped.
PhotileHitSurface clipped_surface(const SurfaceBuffers& surface, std::uint32_t oriented_face,
                                  const glm::vec3& position) {
  const SurfaceIndex& index = surface.index;
  const std::uint32_t triangle = triangle_of(index.original[oriented_face]);
  PhotileHitSurface at{};
  store(at.normal, index.normal[oriented_face]);
  store(at.inwards, surface.centroid[triangle] - position);
  at.region = index.region[triangle];
  at.triangle = triangle;
  at.component = index.component_at(oriented_face, position);
  return at;
}

PhotileHitLobe hit_lobe(const PrimaryHits& hits, std::size_t hit, bool normal_maps) {
  const HitLobe& lobe = hits.lobe[hit];
  const trace::DiffusePart diffuse =
      trace::diffuse_part({hits.diffuse_albedo[hit], lobe.specular, lobe.f90, lobe.roughness},
                          glm::dot(lobe.normal, hits.outgoing[hit]));
  PhotileHitLobe on_device{};
  store(on_device.outgoing, hits.outgoing[hit]);
  store(on_device.normal, lobe.normal);
  static_assert(sizeof diffuse == sizeof on_device.diffuse);
  std::memcpy(on_device.diffuse, &diffuse, sizeof diffuse);
  store(on_device.f0, lobe.specular);
  on_device.f90 = lobe.f90;
  on_device.alpha = lobe.roughness;
  if (normal_maps) {
    store(on_device.smooth_normal, lobe.smooth_normal);
    on_device.most_bump = trace::most_bump(hits.diffuse_albedo[hit] + lobe.specular);
  }
  return on_device;
}

/// A buffer of make(i) for each i < count, made by all cores.
template <class T, class Make>
device::Buffer<T> upload_each(device::Context& context, std::size_t count, std::string_view what,
                              const Make& make) {
  return context.upload_by<T>(count, what, [&](std::span<T> values) {
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { values[i] = make(i); });
  });
}

}  // namespace

std::uint64_t hit_bytes(const SceneNeeds& needs, bool normals, bool clipped) {
  return sizeof(PhotileHit) + sizeof(std::uint32_t) +
         (normals || clipped ? sizeof(PhotileHitSurface) : 0) +
         (needs.glossy ? sizeof(PhotileHitLobe) : 0);
}

HitBuffers upload_hits(device::Context& context, const PrimaryHits& hits, std::size_t first,
                       std::span<const std::uint32_t> maps, std::span<const glm::vec3> normals,
                       const SurfaceBuffers* surface, const SceneNeeds& needs) {
  const std::size_t count = maps.size();
  HitBuffers buffers{.count = static_cast<std::uint32_t>(count)};
  if (count == 0) return buffers;
  const auto order = order_by_map(maps, std::span(hits.position).subspan(first, count));
  if (!order.empty()) buffers.order = context.upload(std::span(order), "order of hits");
  buffers.hits = upload_each<PhotileHit>(context, count, "hits", [&](std::size_t i) {
    PhotileHit hit{};
    store(hit.position, hits.position[first + i]);
    hit.map = maps[i];
    return hit;
  });
  if (surface != nullptr || !normals.empty()) {
    buffers.surfaces =
        upload_each<PhotileHitSurface>(context, count, "surfaces at hits", [&](std::size_t i) {
          const std::uint32_t own = hits.oriented_face[first + i];
          if (surface != nullptr) {
            return clipped_surface(*surface, own, hits.position[first + i]);
          }
          PhotileHitSurface at{};
          store(at.normal, normals[own]);
          return at;
        });
  }
  if (!needs.glossy) return buffers;
  buffers.lobes = upload_each<PhotileHitLobe>(
      context, count, "reflections at hits",
      [&](std::size_t i) { return hit_lobe(hits, first + i, needs.normal_maps); });
  return buffers;
}

std::size_t plan_hit_batch(const HitBatchNeeds& needs, std::uint64_t largest_buffer,
                           std::uint64_t memory) {
  constexpr std::uint64_t comfortable = 1u << 20;
  // Kernels index outputs in 32 bits; in bytes, so that no index of any type comes near.
  const std::uint64_t buffer = std::min<std::uint64_t>(largest_buffer, 0xFFFF'FFFFu);
  const std::uint64_t most =
      std::min(buffer / needs.largest_bytes_per_hit, memory / 4 / needs.bytes_per_hit);
  return std::clamp<std::uint64_t>(most, 1, comfortable);
}

}  // namespace photile::estimate
