// Kernels: their source, arguments and launches.
#include <catch2/catch.hpp>
#include <numeric>

#include "command/command_line.hpp"
#include "device/embedded_files.hpp"
#include "device/launch.hpp"
#include "device/program_source.hpp"
#include "file_bytes.hpp"
#include "photile/errors.hpp"
#include "source_folder.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using device::assemble_source;
using device::Context;
using device::Defines;
using device::Launch;
using device::LocalMemory;
using device::next_launch;
using device::register_kernel_source;

const char* const affine = R"(
kernel void affine(global const int* in, global int* out, const uint n, const int factor) {
  const size_t i = get_global_id(0);
  if (i < n) out[i] = factor * in[i] + OFFSET;
}
)";

/// A launch of `affine` with all its arguments.
Launch affine_launch(Context& context, const device::Kernel& kernel, const device::Buffer<int>& in,
                     const device::Buffer<int>& out, unsigned n, int factor) {
  Launch launch(context, kernel);
  // Not in the order of the source.
  launch.set("factor", factor).set("n", n).set("out", out).set("in", in);
  return launch;
}

DeviceOptions options(bool use_program_cache, bool profile) {
  return {"", use_program_cache, profile};
}

TEST_CASE("a kernel gets buffers, values and definitions") {
  device::register_kernel_source("test/affine.cl", affine);
  Context context({});
  std::vector<int> values(1000);
  std::iota(values.begin(), values.end(), -500);
  const auto in = context.upload<int>(values, "in");
  auto out = context.allocate<int>(values.size(), "out");
  const auto kernel = context.kernel("test/affine.cl", "affine", Defines().set("OFFSET", 7ll));
  // 1000 is no multiple of 64: the launch is rounded up, and the kernel checks its index.
  affine_launch(context, kernel, in, out, 1000, 3).run(values.size(), 64);
  std::vector<int> back(values.size());
  context.read<int>(out, back);
  for (std::size_t i = 0; i < values.size(); ++i) REQUIRE(back[i] == 3 * values[i] + 7);
}

TEST_CASE("one program is built per file and definitions") {
  device::register_kernel_source("test/affine.cl", affine);
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
  device::register_kernel_source("test/local.cl", R"(
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
  Launch(context, context.kernel("test/local.cl", "reverse", {}))
      .set("values", buffer)
      .set("shared", LocalMemory{32 * sizeof(int)})
      .run_no_more(64, 32);
  std::vector<int> back(64);
  context.read<int>(buffer, back);
  for (int i = 0; i < 64; ++i) REQUIRE(back[i] == (i / 32) * 32 + 31 - i % 32);
}

TEST_CASE("launches over nothing enqueue nothing, and an empty buffer is a valid argument") {
  device::register_kernel_source("test/affine.cl", affine);
  Context context(options(true, true));
  const auto kernel = context.kernel("test/affine.cl", "affine", Defines().set("OFFSET", 0ll));
  const auto empty = context.allocate<int>(0, "empty");
  affine_launch(context, kernel, empty, empty, 0, 1).run(0, 64);
  CHECK(context.kernel_times().empty());
  affine_launch(context, kernel, empty, empty, 0, 1).run(64, 0);
  context.finish();
  const auto times = context.kernel_times();
  REQUIRE(times.size() == 1);
  CHECK(times[0].kernel == "affine");
  CHECK(times[0].launches == 1);
  CHECK(times[0].seconds >= 0);
}

TEST_CASE("writes and reads are timed apart from kernels, where times are kept") {
  const std::vector<int> values(1 << 20, 7);
  std::vector<int> back(values.size());
  const auto seconds_of = [&](bool profile) {
    Context context(options(true, profile));
    const auto buffer = context.upload<int>(values, "values");
    const double of_write = context.transfer_seconds();
    context.read<int>(buffer, back);
    CHECK(context.kernel_times().empty());
    return std::make_pair(of_write, context.transfer_seconds());
  };
  const auto [of_write, of_both] = seconds_of(true);
  CHECK(of_write > 0);
  CHECK(of_both > of_write);
  CHECK(seconds_of(false).second == 0);
}

TEST_CASE("what a kernel needs before its first launch is counted once") {
  device::register_kernel_source("test/affine.cl", affine);
  Context context(options(true, true));
  const auto kernel = context.kernel("test/affine.cl", "affine", Defines().set("OFFSET", 5ll));
  const auto empty = context.allocate<int>(0, "empty");
  affine_launch(context, kernel, empty, empty, 0, 1).run(64, 0);
  const double preparation = context.kernel_times()[0].preparation_seconds;
  CHECK(preparation > 0);
  affine_launch(context, context.kernel("test/affine.cl", "affine", Defines().set("OFFSET", 5ll)),
                empty, empty, 0, 1)
      .run(64, 0);
  CHECK(context.kernel_times()[0].launches == 2);
  CHECK(context.kernel_times()[0].preparation_seconds == preparation);
}

TEST_CASE("an unknown argument and one that is not given are refused by kernel and name") {
  device::register_kernel_source("test/affine.cl", affine);
  Context context({});
  const auto kernel = context.kernel("test/affine.cl", "affine", Defines().set("OFFSET", 0ll));
  const auto buffer = context.allocate<int>(1, "values");
  CHECK_THROWS_WITH(Launch(context, kernel).set("input", buffer),
                    Contains("kernel 'affine' has no argument 'input'"));
  // Complete launches leave nothing behind that a later one could be run with.
  affine_launch(context, kernel, buffer, buffer, 1, 1).run(1, 0);
  Launch launch(context, kernel);
  launch.set("in", buffer).set("out", buffer).set("factor", 1);
  CHECK_THROWS_WITH(launch.run(1, 0), Contains("kernel 'affine' is not given its argument 'n'"));
  launch.set("n", 1u).run(1, 0);
}

TEST_CASE("arguments have names where macros give them, and in programs from the cache") {
  device::register_kernel_source("test/macro.cl", R"(
#define MORE_ARGUMENTS const uint n, \
  global const float* restrict from
kernel void copy(global float* to, MORE_ARGUMENTS) {
  if (get_global_id(0) < n) to[get_global_id(0)] = from[get_global_id(0)];
}
)");
  for (int run = 0; run < 2; ++run) {
    Context context(options(true, false));
    const std::vector<float> values{1, 2, 3};
    const auto from = context.upload<float>(values, "from");
    auto to = context.allocate<float>(3, "to");
    Launch(context, context.kernel("test/macro.cl", "copy", {}))
        .set("from", from)
        .set("n", 3u)
        .set("to", to)
        .run(3, 0);
    std::vector<float> back(3);
    context.read<float>(to, back);
    CHECK(back == values);
  }
}

TEST_CASE("an argument of the wrong size and an unknown kernel are device errors") {
  device::register_kernel_source("test/affine.cl", affine);
  Context context({});
  const auto defines = Defines().set("OFFSET", 0ll);
  const auto kernel = context.kernel("test/affine.cl", "affine", defines);
  const auto buffer = context.allocate<int>(1, "values");
  CHECK_THROWS_WITH(Launch(context, kernel).set("n", 1.0),
                    Contains("CL_INVALID_ARG_SIZE") && Contains("argument 'n'"));
  CHECK_THROWS_WITH(context.kernel("test/affine.cl", "missing", defines),
                    Contains("CL_INVALID_KERNEL_NAME") && Contains("missing"));
}

TEST_CASE("a build error names file and line and carries the log") {
  device::register_kernel_source("test/included.clh",
                                 "int good(void) { return 1; }\n"
                                 "int bad(void) { return undeclared_name; }\n");
  device::register_kernel_source("test/broken.cl",
                                 "// a comment\n#include \"test/included.clh\"\n"
                                 "kernel void k(global int* a) { a[0] = bad(); }\n");
  Context context({});
  try {
    context.kernel("test/broken.cl", "k", {});
    FAIL("built");
  } catch (const KernelBuildError& error) {
    CHECK_THAT(error.what(), Contains("test/broken.cl"));
    CHECK_THAT(error.what(), !Contains("\n"));
    CHECK_THAT(error.build_log, Contains("undeclared_name"));
    // Oclgrind's compiler does not follow #line.
    if (context.info().platform != "Oclgrind") {
      CHECK_THAT(error.build_log, Contains("test/included.clh:2"));
    }
    CHECK(app::exit_code_of(error) == app::ExitCode::device);
  }
}

TEST_CASE("definitions become options that round-trip") {
  CHECK(Defines().set("K", 50ll).set("FLAG").set("X", 0.1).set("ONE", 1.0).options() ==
        "-D K=50 -D FLAG=1 -D X=0.1f -D ONE=1.0f");
  CHECK(Defines().set("N", -3ll).options() == "-D N=-3");
  CHECK(Defines().options().empty());
  CHECK_THROWS_AS(Defines().set("X", 1e300), DeviceError);
}

TEST_CASE("includes are resolved once each, with line markers") {
  register_kernel_source("source/a.cl",
                         "#pragma once\n#include \"source/b.clh\"\n  #  include \"source/c.clh\"\n"
                         "#include <stdint.h>\nlast\n");
  register_kernel_source("source/b.clh", "#include \"source/c.clh\"\nb\n");
  register_kernel_source("source/c.clh", "c");
  CHECK(assemble_source("source/a.cl") ==
        "#line 1 \"source/a.cl\"\n\n"
        "#line 1 \"source/b.clh\"\n"
        "#line 1 \"source/c.clh\"\nc\n"
        "#line 2 \"source/b.clh\"\nb\n"
        "#line 3 \"source/a.cl\"\n"
        "#line 4 \"source/a.cl\"\n"
        "#include <stdint.h>\nlast\n");
}

TEST_CASE("a classic guard may stand around includes") {
  register_kernel_source(
      "source/guarded.h",
      "#ifndef GUARDED\n#define GUARDED\n#include \"source/value2.h\"\n#endif\n");
  register_kernel_source("source/value2.h",
                         "#ifndef VALUE2\n#define VALUE2\nconstant int value2 = 4;\n#endif\n");
  register_kernel_source("source/guards.cl",
                         "#include \"source/guarded.h\"\n#include \"source/guarded.h\"\n"
                         "#include \"source/value2.h\"\n"
                         "kernel void k(global int* out) { *out = value2; }\n");
  device::Context context({});
  CHECK_NOTHROW(context.kernel("source/guards.cl", "k", {}));
}

TEST_CASE("an unknown include names itself and its includer") {
  register_kernel_source("source/d.cl", "\n#include \"source/nowhere.clh\"\n");
  CHECK_THROWS_WITH(assemble_source("source/d.cl"),
                    Contains("'source/nowhere.clh'") && Contains("'source/d.cl' line 2"));
  CHECK_THROWS_AS(assemble_source("source/none.cl"), KernelBuildError);
}

TEST_CASE("files that include each other end") {
  register_kernel_source("source/e.cl", "#include \"source/f.clh\"\ne\n");
  register_kernel_source("source/f.clh", "#include \"source/e.cl\"\nf\n");
  CHECK_THAT(assemble_source("source/e.cl"), Contains("\ne\n") && Contains("\nf\n"));
}

TEST_CASE("every kernel but those of benches, and every shared header, is embedded byte for byte") {
  const std::filesystem::path root = photile::test::source_folder();
  std::size_t count = 0;
  const auto compare = [&](const std::filesystem::path& folder, const std::filesystem::path& base) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      const auto extension = entry.path().extension();
      if (extension != ".cl" && extension != ".clh" && extension != ".h") continue;
      if (entry.path().parent_path() == root / "kernels/structures") continue;
      ++count;
      const std::string text = photile::test::bytes_of(entry.path());
      const auto name = std::filesystem::relative(entry.path(), base).string();
      bool found = false;
      for (const auto& embedded : device::embedded_files()) {
        if (embedded.path == name) found = embedded.text == text;
      }
      INFO(name);
      CHECK(found);
    }
  };
  compare(root / "kernels", root / "kernels");
  compare(root / "include/photile/device", root / "include");
  CHECK(count == device::embedded_files().size());
}

// Launches cut by their measured time.

TEST_CASE("the next launch takes a tenth of a second at the speed of the last") {
  CHECK(next_launch(100'000, 0.1) == 100'000);
  CHECK(next_launch(100'000, 0.4) == 25'000);
  CHECK(next_launch(100'000, 0.05) == 200'000);
}

TEST_CASE("launches grow four times at most, and never to nothing") {
  CHECK(next_launch(16'384, 1e-6) == 4 * 16'384);
  CHECK(next_launch(16'384, 0) == 4 * 16'384);
  CHECK(next_launch(16'384, 1e6) == 1024);
  CHECK(next_launch(1u << 30, 1e-6) == 1u << 30);
}

TEST_CASE("whatever the speed of a device, launches come to keep below a fifth of a second") {
  for (const double items_per_second : {2e4, 1e6, 1e9}) {
    std::uint32_t items = 1u << 14;
    for (int launch = 0; launch < 20; ++launch)
      items = next_launch(items, items / items_per_second);
    CHECK(items / items_per_second < 0.2);
  }
}

}  // namespace
}  // namespace photile::test
