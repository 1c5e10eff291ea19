#include "support/device_limits.hpp"

#include "device/launch.hpp"
#include "device/program_source.hpp"
#include "support/kernel_seconds.hpp"

namespace photile::bench {
namespace {

constexpr std::size_t group_size = 64;

// Sums are written, so that no loop can be left out. 16 vectors hide the latency of an addition
// behind a multiplication.
const char* const source = R"(
#pragma OPENCL FP_CONTRACT OFF

__kernel void copy_memory(__global const float* from, __global float* to) {
  vstore16(vload16(get_global_id(0), from), get_global_id(0), to);
}

__kernel void read_cache(__global const float* values, uint count, uint rounds,
                         __global float* sums) {
  float16 a = 0.0f, b = 0.0f, c = 0.0f, d = 0.0f;
  for (uint round = 0; round < rounds; ++round) {
    for (uint i = 0; i < count; i += 64) {
      a += vload16(0, values + i);
      b += vload16(1, values + i);
      c += vload16(2, values + i);
      d += vload16(3, values + i);
    }
  }
  vstore16((a + b) + (c + d), get_global_id(0), sums);
}

__kernel void compute(uint rounds, float factor, float summand, __global float* sums) {
  float16 v[16];
  for (uint i = 0; i < 16; ++i) v[i] = (float)i;
  for (uint round = 0; round < rounds; ++round) {
#pragma unroll
    for (uint i = 0; i < 16; ++i) v[i] = v[i] * factor + summand;
  }
  float16 sum = 0.0f;
  for (uint i = 0; i < 16; ++i) sum += v[i];
  vstore16(sum, get_global_id(0), sums);
}
)";

}  // namespace

DeviceLimits measure_limits(Device& device, const Repeats& repeats, std::size_t copied_bytes) {
  constexpr std::size_t items = 4096, cached_floats = 2048;
  constexpr std::uint32_t cache_rounds = 64, compute_rounds = 1024;
  const char* const file = "bench/limits.cl";
  device::register_kernel_source(file, source);
  device::Context& context = device::context_of(device);
  auto from = context.allocate<float>(copied_bytes / sizeof(float), "memory to copy");
  auto to = context.allocate<float>(from.size(), "copied memory");
  auto sums = context.allocate<float>(16 * items, "sums");
  context.fill(from, 1.0f);
  const auto median = [&](const char* name, std::size_t size, const auto& set_arguments) {
    device::Launch launch(context, context.kernel(file, name, {}));
    set_arguments(launch);
    return measure_returned(repeats,
                            [&] {
                              return kernel_seconds_of(
                                  device, [&] { launch.run_no_more(size, group_size); });
                            })
        .median();
  };
  // Work-items in whole groups: these kernels do not check their index.
  const std::size_t copies = from.size() / (16 * group_size) * group_size;
  DeviceLimits limits;
  limits.copied_bytes_per_second = 2.0 * 64.0 * static_cast<double>(copies) /
                                   median("copy_memory", copies, [&](device::Launch& launch) {
                                     launch.set("from", from).set("to", to);
                                   });
  limits.cached_bytes_per_second = static_cast<double>(items * cached_floats * sizeof(float)) *
                                   cache_rounds /
                                   median("read_cache", items, [&](device::Launch& launch) {
                                     launch.set("values", from)
                                         .set("count", static_cast<std::uint32_t>(cached_floats))
                                         .set("rounds", cache_rounds)
                                         .set("sums", sums);
                                   });
  limits.operations_per_second = static_cast<double>(items) * 16 * 16 * 2 * compute_rounds /
                                 median("compute", items, [&](device::Launch& launch) {
                                   launch.set("rounds", compute_rounds)
                                       .set("factor", 0.5f)
                                       .set("summand", 1.0f)
                                       .set("sums", sums);
                                 });
  return limits;
}

}  // namespace photile::bench
