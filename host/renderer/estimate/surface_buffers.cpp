#include "estimate/surface_buffers.hpp"

#include <tbb/parallel_for.h>

#include <span>

namespace photile::estimate {

SurfaceBuffers::SurfaceBuffers(const maps::MapStore& store, const Scene& scene,
                               const SurfaceIndex& surface)
    : index(surface), centroid(scene.triangle_count()) {
  tbb::parallel_for(std::size_t{0}, centroid.size(), [&](std::size_t t) {
    const auto corners = scene.corners(static_cast<std::uint32_t>(t));
    centroid[t] = (corners[0] + corners[1] + corners[2]) / 3.0f;
  });
  device::Context& context = device::context_of(*store.device);
  const std::vector<std::uint8_t> lit = lit_sheets(surface, store.landed);
  std::vector<PhotileSurfaceLeaf> marked = surface.leaves;
  const auto mark = [&](std::uint32_t& sheet) {
    if ((sheet & PHOTILE_SHEET_UNLIT) == 0 && lit[sheet] == 0) sheet |= PHOTILE_SHEET_UNLIT;
  };
  for (PhotileSurfaceLeaf& leaf : marked) {
    for (std::uint32_t& sheet : leaf.front_sheet) mark(sheet);
    for (std::uint32_t& sheet : leaf.back_sheet) mark(sheet);
  }
  nodes = context.upload(std::span(surface.nodes), "surface tree");
  leaves = context.upload(std::span<const PhotileSurfaceLeaf>(marked), "surface pieces");
}

}  // namespace photile::estimate
