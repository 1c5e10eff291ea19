#include "maps/prefix_sum.hpp"

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
  auto block_sum = context.allocate<std::uint32_t>(blocks, "block sums of a prefix sum");
  if (blocks == 1) {
    context.fill(block_sum, 0u);
  } else {
    kernels.launch("sum_blocks")
        .set("count", count)
        .set("values", values)
        .set("block_size", block_size)
        .set("block_count", blocks)
        .set("block_sum", block_sum)
        .run(blocks, work_group_size);
    exclusive_prefix_sum(kernels, block_sum, block_sum);
  }
  kernels.launch("scan_blocks")
      .set("count", count)
      .set("values", values)
      .set("block_size", block_size)
      .set("block_count", blocks)
      .set("block_start", block_sum)
      .set("scanned", scanned)
      .run(blocks, work_group_size);
}

void exclusive_prefix_sum(const device::KernelSet& kernels, device::Buffer<std::uint32_t>& values) {
  exclusive_prefix_sum(kernels, values, values);
}

}  // namespace photile::maps
