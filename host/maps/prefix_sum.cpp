#include "maps/prefix_sum.hpp"

#include "maps/map_store.hpp"

namespace photile::maps {
namespace {

constexpr std::uint32_t block_size = 2048;

}  // namespace

void exclusive_prefix_sum(device::Context& context, const device::Buffer<std::uint32_t>& values,
                          device::Buffer<std::uint32_t>& scanned) {
  const auto count = static_cast<std::uint32_t>(values.size());
  if (count == 0) return;
  const std::uint32_t blocks = (count + block_size - 1) / block_size;
  device::Defines defines;
  defines.set("BLOCK", static_cast<long long>(block_size));
  auto block_sum = context.allocate<std::uint32_t>(blocks, "block sums of a prefix sum");
  if (blocks == 1) {
    context.fill(block_sum, 0u);
  } else {
    context.run(context.kernel("grid/scan.cl", "sum_blocks", defines), blocks, 0, count, values,
                blocks, block_sum);
    exclusive_prefix_sum(context, block_sum, block_sum);
  }
  context.run(context.kernel("grid/scan.cl", "scan_blocks", defines), blocks, 0, count, values,
              blocks, block_sum, scanned);
}

void exclusive_prefix_sum(device::Context& context, device::Buffer<std::uint32_t>& values) {
  exclusive_prefix_sum(context, values, values);
}

}  // namespace photile::maps
