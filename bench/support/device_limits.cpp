#include "support/device_limits.hpp"

#include <algorithm>

#include "device/launch.hpp"
#include "device/program_source.hpp"
#include "support/kernel_seconds.hpp"

namespace photile::bench {
namespace {

constexpr std::size_t group_size = 64, copying_group_size = 256;

// Sums are written, so that no loop can be left out. 16 vectors hide the latency of an addition
// behind a multiplication. A work-item of a CPU computes with vectors of 16; elsewhere neighbouring
// work-items read neighbouring floats, and copy four each, since groups that copy few bytes take as
// long to start as to copy.
const char* const source = R"(
#pragma OPENCL FP_CONTRACT OFF

#if WIDTH == 16
typedef float16 Vector;
#define LOAD(i, from) vload16(i, from)
#define STORE(value, i, to) vstore16(value, i, to)
#define COPY(i, from, to) vstore16(vload16(i, from), i, to)
#define LANE 0
#define LANES 1
#else
typedef float Vector;
#define LOAD(i, from) (from)[i]
#define STORE(value, i, to) (to)[i] = value
#define COPY(i, from, to) vstore4(vload4(i, from), i, to)
#define LANE get_local_id(0)
#define LANES get_local_size(0)
#endif

__kernel void copy_memory(__global const float* from, __global float* to) {
  COPY(get_global_id(0), from, to);
}

__kernel void read_cache(__global const float* values, uint count, uint rounds,
                         __global float* sums) {
  Vector a = 0.0f, b = 0.0f, c = 0.0f, d = 0.0f;
  for (uint round = 0; round < rounds; ++round) {
    for (uint i = LANE; i < count / WIDTH; i += 4 * LANES) {
      a += LOAD(i, values);
      b += LOAD(i + LANES, values);
      c += LOAD(i + 2 * LANES, values);
      d += LOAD(i + 3 * LANES, values);
    }
  }
  STORE((a + b) + (c + d), get_global_id(0), sums);
}

__kernel void compute(uint rounds, float factor, float summand, __global float* sums) {
  Vector v[16];
  for (uint i = 0; i < 16; ++i) v[i] = (float)i;
  for (uint round = 0; round < rounds; ++round) {
#pragma unroll
    for (uint i = 0; i < 16; ++i) v[i] = v[i] * factor + summand;
  }
  Vector sum = 0.0f;
  for (uint i = 0; i < 16; ++i) sum += v[i];
  STORE(sum, get_global_id(0), sums);
}
)";

}  // namespace

DeviceLimits measure_limits(Device& device, const Repeats& repeats, std::size_t copied_bytes) {
  const std::size_t width = device.info().type == DeviceType::cpu ? 16 : 1;
  const std::size_t items = width == 16 ? 4096 : 1u << 20;
  constexpr std::size_t cached_floats = 2048;
  device::Defines defines;
  defines.set("WIDTH", static_cast<long long>(width));
  constexpr std::uint32_t cache_rounds = 64, compute_rounds = 1024;
  const char* const file = "bench/limits.cl";
  device::register_kernel_source(file, source);
  device::Context& context = device::context_of(device);
  auto from = context.allocate<float>(copied_bytes / sizeof(float), "memory to copy");
  auto to = context.allocate<float>(from.size(), "copied memory");
  auto sums = context.allocate<float>(width * items, "sums");
  context.fill(from, 1.0f);
  const auto median = [&](const char* name, std::size_t size, std::size_t group,
                          const auto& set_arguments) {
    device::Launch launch(context, context.kernel(file, name, defines));
    set_arguments(launch);
    return measure_returned(
               repeats,
               [&] { return kernel_seconds_of(device, [&] { launch.run_no_more(size, group); }); })
        .median();
  };
  // Work-items in whole groups: these kernels do not check their index.
  const std::size_t copied = std::max<std::size_t>(width, 4);
  const std::size_t group = std::min(copying_group_size, device.info().max_work_group_size);
  const std::size_t copies = from.size() / (copied * group) * group;
  DeviceLimits limits;
  limits.copied_bytes_per_second =
      2.0 * sizeof(float) * static_cast<double>(copied * copies) /
      median("copy_memory", copies, group,
             [&](device::Launch& launch) { launch.set("from", from).set("to", to); });
  // What a work-item of a CPU reads is read by a group elsewhere.
  const std::size_t readers = width == 16 ? items : items / group_size;
  limits.cached_bytes_per_second =
      static_cast<double>(readers * cached_floats * sizeof(float)) * cache_rounds /
      median("read_cache", items, group_size, [&](device::Launch& launch) {
        launch.set("values", from)
            .set("count", static_cast<std::uint32_t>(cached_floats))
            .set("rounds", cache_rounds)
            .set("sums", sums);
      });
  limits.operations_per_second = static_cast<double>(items * width) * 16 * 2 * compute_rounds /
                                 median("compute", items, group_size, [&](device::Launch& launch) {
                                   launch.set("rounds", compute_rounds)
                                       .set("factor", 0.5f)
                                       .set("summand", 1.0f)
                                       .set("sums", sums);
                                 });
  return limits;
}

}  // namespace photile::bench
