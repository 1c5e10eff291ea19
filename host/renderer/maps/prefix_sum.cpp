#include "maps/build_steps.hpp"
#include "maps/map_store.hpp"

namespace photile::maps {
namespace {

constexpr std::uint32_t block_size = 2048;

}  // namespace

void exclusive_prefix_sum(const device::KernelSet& kernels,
                          const device::Buffer<std::uint32_t>& values,
                          device::Buffer<std::uint32_t>& scanned) {
  const auto count = static_cast<std::uint32_t>(values.size());
  if (count == 0) return;
  const std::uint32_t blocks = (count + block_size - 1) / block_size;
  device::Context& context = kernels.context();
  const bool in_groups = works_in_groups(context.info());
  const auto run = [&](device::Launch& launch) {
    if (in_groups) {
      launch.run(blocks * group_size, group_size);
    } else {
      launch.run(blocks, work_group_size);
    }
  };
  auto block_sum = context.allocate<std::uint32_t>(blocks, "block sums of a prefix sum");
  if (blocks == 1) {
    context.fill(block_sum, 0u);
  } else {
    device::Launch launch = kernels.launch("sum_blocks");
    launch.set("count", count)
        .set("values", values)
        .set("block_size", block_size)
        .set("block_count", blocks)
        .set("block_sum", block_sum);
    run(launch);
    exclusive_prefix_sum(kernels, block_sum, block_sum);
  }
  device::Launch launch = kernels.launch("scan_blocks");
  launch.set("count", count)
      .set("values", values)
      .set("block_size", block_size)
      .set("block_count", blocks)
      .set("block_start", block_sum)
      .set("scanned", scanned);
  run(launch);
}

void exclusive_prefix_sum(const device::KernelSet& kernels, device::Buffer<std::uint32_t>& values) {
  exclusive_prefix_sum(kernels, values, values);
}

}  // namespace photile::maps
