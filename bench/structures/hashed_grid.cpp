// Cubic cells over all photons in a hash table, built on the device:
// kernels/structures/build_hashed_grid.cl.
#include "structures/hashed_grid.h"

#include <array>
#include <bit>
#include <utility>

#include "maps/build_steps.hpp"
#include "structures/structure.hpp"

namespace photile::structures {
namespace {

/// Cells a radius is long. Searches end at about half of it.
constexpr float cells_per_radius = 2;
/// Cells at most along an axis: places in them are floats.
constexpr float most_cells = 1 << 20;
/// Photons for each bucket.
constexpr std::size_t photons_per_bucket = 4;

PhotileHashedGrid grid_over(std::span<const glm::vec3> points, double radius) {
  glm::vec3 low = points.front(), high = low;
  for (const glm::vec3& p : points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const glm::vec3 extent = high - low;
  const float widest = std::max({extent.x, extent.y, extent.z});
  const float side = std::max(static_cast<float>(radius) / cells_per_radius, widest / most_cells);
  const std::size_t buckets = std::bit_ceil(points.size() / photons_per_bucket + 1);
  return {.low_x = low.x,
          .low_y = low.y,
          .low_z = low.z,
          .high_x = high.x,
          .high_y = high.y,
          .high_z = high.z,
          .cell_side = side,
          .inverse_cell_side = 1.0f / side,
          .mask = static_cast<std::uint32_t>(buckets - 1)};
}

Index build_hashed_grid(const PhotonLists& lists) {
  device::Context& context = lists.context;
  const Photons& photons = lists.photons;
  const device::KernelSet kernels(context, "structures/build_hashed_grid.cl",
                                  maps::group_defines(context.info()));
  const PhotileHashedGrid grid = grid_over(photons.position, lists.radius);
  const auto words = std::bit_cast<std::array<std::uint32_t, sizeof grid / 4>>(grid);
  auto nodes = context.upload(std::span<const std::uint32_t>(words), "hashed grid");
  maps::MapPage page;
  page.record_count = static_cast<std::uint32_t>(photons.size());
  page.cell_count = grid.mask + 1;
  page.cell_start = context.allocate<std::uint32_t>(std::size_t{page.cell_count} + 1,
                                                    "bucket offsets", device::MemoryPages::large);
  context.fill(page.cell_start, 0u);
  page.record_photon = context.allocate<std::uint32_t>(photons.size(), "photon references");
  const auto position =
      context.share(std::span(&photons.position.front().x, 3 * photons.size()), "photon positions");
  const auto over_photons = [&](const char* kernel) {
    device::Launch launch = kernels.launch(kernel);
    launch.set("photon_count", page.record_count)
        .set("position", position)
        .set("grid", nodes)
        .set("cell_start", page.cell_start);
    return launch;
  };
  over_photons("count_buckets").run(photons.size(), maps::work_group_size);
  maps::exclusive_prefix_sum(kernels, page.cell_start);
  over_photons("fill_buckets")
      .set("record_photon", page.record_photon)
      .run(photons.size(), maps::work_group_size);
  maps::sort_cells(kernels, page);
  context.finish();  // `position` may lie over the host's memory
  return {.record_photon = std::move(page.record_photon),
          .nodes = std::move(nodes),
          .cell_start = std::move(page.cell_start)};
}

const Registration hashed_grid({.name = "hashed-grid", .build = build_hashed_grid, .global = true});

}  // namespace
}  // namespace photile::structures
