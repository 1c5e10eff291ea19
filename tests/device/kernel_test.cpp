#include <catch2/catch.hpp>
#include <numeric>

#include "device/context.hpp"
#include "device/program_source.hpp"
#include "tools/command/exit_code.hpp"

namespace {

using photile::device::Context;
using photile::device::Defines;
using photile::device::LocalMemory;

const char* const affine = R"(
kernel void affine(global const int* in, global int* out, const uint n, const int factor) {
  const size_t i = get_global_id(0);
  if (i < n) out[i] = factor * in[i] + OFFSET;
}
)";

photile::DeviceOptions options(bool use_program_cache, bool profile) {
  return {"", use_program_cache, profile};
}

}  // namespace

TEST_CASE("a kernel gets buffers, values and definitions") {
  photile::device::register_kernel_source("test/affine.cl", affine);
  Context context({});
  std::vector<int> values(1000);
  std::iota(values.begin(), values.end(), -500);
  const auto in = context.upload<int>(values, "in");
  auto out = context.allocate<int>(values.size(), "out");
  const auto kernel = context.kernel("test/affine.cl", "affine", Defines().set("OFFSET", 7ll));
  // 1000 is no multiple of 64: the launch is rounded up, and the kernel checks its index.
  context.run(kernel, values.size(), 64, in, out, 1000u, 3);
  std::vector<int> back(values.size());
  context.read<int>(out, back);
  for (std::size_t i = 0; i < values.size(); ++i) REQUIRE(back[i] == 3 * values[i] + 7);
}

TEST_CASE("one program is built per file and definitions") {
  photile::device::register_kernel_source("test/affine.cl", affine);
  Context context(options(false, false));
  context.kernel("test/affine.cl", "affine", Defines().set("OFFSET", 1ll));
  context.kernel("test/affine.cl", "affine", Defines().set("OFFSET", 1ll));
  CHECK(context.programs_built() == 1);
  context.kernel("test/affine.cl", "affine", Defines().set("OFFSET", 2ll));
  CHECK(context.programs_built() == 2);
  CHECK(context.compile_seconds() > 0);
  const auto& times = context.program_times();
  REQUIRE(times.size() == 2);
  CHECK(times[0].file == "test/affine.cl");
  CHECK(times[0].seconds + times[1].seconds == context.compile_seconds());
}

TEST_CASE("local memory has the size asked for") {
  photile::device::register_kernel_source("test/local.cl", R"(
kernel void reverse(global int* values, local int* shared) {
  const size_t l = get_local_id(0), n = get_local_size(0), first = get_group_id(0) * n;
  shared[l] = values[first + l];
  barrier(CLK_LOCAL_MEM_FENCE);
  values[first + l] = shared[n - 1 - l];
}
)");
  Context context({});
  std::vector<int> values(64);
  std::iota(values.begin(), values.end(), 0);
  auto buffer = context.upload<int>(values, "values");
  context.run(context.kernel("test/local.cl", "reverse", {}), 64, 32, buffer,
              LocalMemory{32 * sizeof(int)});
  std::vector<int> back(64);
  context.read<int>(buffer, back);
  for (int i = 0; i < 64; ++i) REQUIRE(back[i] == (i / 32) * 32 + 31 - i % 32);
}

TEST_CASE("launches over nothing enqueue nothing, and an empty buffer is a valid argument") {
  photile::device::register_kernel_source("test/affine.cl", affine);
  Context context(options(true, true));
  const auto kernel = context.kernel("test/affine.cl", "affine", Defines().set("OFFSET", 0ll));
  const auto empty = context.allocate<int>(0, "empty");
  context.run(kernel, 0, 64, empty, empty, 0u, 1);
  CHECK(context.kernel_times().empty());
  context.run(kernel, 64, 0, empty, empty, 0u, 1);
  context.finish();
  const auto times = context.kernel_times();
  REQUIRE(times.size() == 1);
  CHECK(times[0].kernel == "affine");
  CHECK(times[0].launches == 1);
  CHECK(times[0].seconds >= 0);
}

TEST_CASE("what a kernel needs before its first launch is counted once") {
  photile::device::register_kernel_source("test/affine.cl", affine);
  Context context(options(true, true));
  const auto kernel = context.kernel("test/affine.cl", "affine", Defines().set("OFFSET", 5ll));
  const auto empty = context.allocate<int>(0, "empty");
  context.run(kernel, 64, 0, empty, empty, 0u, 1);
  const double preparation = context.kernel_times()[0].preparation_seconds;
  CHECK(preparation > 0);
  context.run(context.kernel("test/affine.cl", "affine", Defines().set("OFFSET", 5ll)), 64, 0,
              empty, empty, 0u, 1);
  CHECK(context.kernel_times()[0].launches == 2);
  CHECK(context.kernel_times()[0].preparation_seconds == preparation);
}

TEST_CASE("a wrong number of arguments is refused with both numbers") {
  photile::device::register_kernel_source("test/affine.cl", affine);
  Context context({});
  const auto kernel = context.kernel("test/affine.cl", "affine", Defines().set("OFFSET", 0ll));
  const auto buffer = context.allocate<int>(1, "values");
  CHECK_THROWS_WITH(context.run(kernel, 1, 0, buffer, buffer),
                    Catch::Contains("'affine' takes 4 arguments, 2 given"));
}

TEST_CASE("an argument of the wrong size and an unknown kernel are device errors") {
  photile::device::register_kernel_source("test/affine.cl", affine);
  Context context({});
  const auto defines = Defines().set("OFFSET", 0ll);
  const auto kernel = context.kernel("test/affine.cl", "affine", defines);
  const auto buffer = context.allocate<int>(1, "values");
  CHECK_THROWS_WITH(context.run(kernel, 1, 0, buffer, buffer, 1.0, 1),
                    Catch::Contains("CL_INVALID_ARG_SIZE") && Catch::Contains("argument 2"));
  CHECK_THROWS_WITH(context.kernel("test/affine.cl", "missing", defines),
                    Catch::Contains("CL_INVALID_KERNEL_NAME") && Catch::Contains("missing"));
}

TEST_CASE("a build error names file and line and carries the log") {
  photile::device::register_kernel_source("test/included.clh",
                                          "int good(void) { return 1; }\n"
                                          "int bad(void) { return undeclared_name; }\n");
  photile::device::register_kernel_source("test/broken.cl",
                                          "// a comment\n#include \"test/included.clh\"\n"
                                          "kernel void k(global int* a) { a[0] = bad(); }\n");
  Context context({});
  try {
    context.kernel("test/broken.cl", "k", {});
    FAIL("built");
  } catch (const photile::KernelBuildError& error) {
    CHECK_THAT(error.what(), Catch::Contains("test/broken.cl"));
    CHECK_THAT(error.what(), !Catch::Contains("\n"));
    CHECK_THAT(error.build_log, Catch::Contains("undeclared_name"));
    // Oclgrind's compiler does not follow #line.
    if (context.info().platform != "Oclgrind") {
      CHECK_THAT(error.build_log, Catch::Contains("test/included.clh:2"));
    }
    CHECK(photile::app::exit_code_of(error) == photile::app::ExitCode::device);
  }
}

TEST_CASE("definitions become options that round-trip") {
  CHECK(Defines().set("K", 50ll).set("FLAG").set("X", 0.1).set("ONE", 1.0).options() ==
        "-D K=50 -D FLAG -D X=0.1f -D ONE=1.0f");
  CHECK(Defines().set("N", -3ll).options() == "-D N=-3");
  CHECK(Defines().options().empty());
  CHECK_THROWS_AS(Defines().set("X", 1e300), photile::DeviceError);
}
