// photile_device_probe <mode> [--no-cache]: a small computation on a device, in a process of its
// own, for tests of what may end the process. Modes:
//   run        computes, prints the sum of the results and the cache's counters
//   overrun    writes one element past the end of a buffer
//   underrun   writes one element before its begin
//   unwritten  prints an element that no kernel wrote
//   abort      computes, then dies by SIGABRT
// Exit codes are photile's; errors go to the standard error stream.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string_view>
#include <vector>

#include "command/command_line.hpp"
#include "device/launch.hpp"
#include "device/program_source.hpp"

namespace {

using photile::device::Context;

constexpr const char* source = R"(
kernel void squares(global int* out, const int first, const uint n) {
  const size_t i = get_global_id(0);
  if (i < n) out[(int)i + first] = (int)(i * i);
}
)";

int probe(std::string_view mode, bool use_cache) {
  photile::device::register_kernel_source("test/squares.cl", source);
  Context context(photile::DeviceOptions{"", use_cache, false});
  constexpr unsigned n = 1000;
  auto buffer = context.allocate<int>(n, "squares");
  const auto kernel = context.kernel("test/squares.cl", "squares", {});
  const unsigned written = mode == "overrun" ? n + 1 : mode == "unwritten" ? n - 1 : n;
  photile::device::Launch(context, kernel)
      .set("out", buffer)
      .set("first", mode == "underrun" ? -1 : 0)
      .set("n", written)
      .run(written, 0);
  context.finish();
  std::vector<int> values(n);
  context.read<int>(buffer, values);
  if (mode == "abort") std::abort();
  fmt::print("last={} sum={} built={} cached={}\n", values.back(),
             std::accumulate(values.begin(), values.end(), 0ll), context.programs_built(),
             context.programs_from_cache());
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  try {
    const bool use_cache = !(count > 2 && std::string_view(arguments[2]) == "--no-cache");
    return probe(count > 1 ? arguments[1] : "run", use_cache);
  } catch (const photile::Error& error) {
    fmt::print(stderr, "photile: {}\n", error.what());
    return static_cast<int>(photile::app::exit_code_of(error));
  }
}
