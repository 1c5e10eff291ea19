#include "device/program_source.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "device/embedded_files.hpp"
#include "device/launch.hpp"
#include "photile/errors.hpp"
#include "source_folder.hpp"

namespace photile::test {

using photile::device::assemble_source;
using photile::device::register_kernel_source;

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

TEST_CASE("a file under a condition is there for whoever includes it without one") {
  // Compilers see what is wrong: with the guards of the first include alone, `value` is missing.
  register_kernel_source("source/value.clh", "#pragma once\nconstant int value = 3;\n");
  register_kernel_source("source/twice.clh",
                         "#pragma once\n#include \"source/value.clh\"\n"
                         "static int twice(void) { return 2 * value; }\n");
  register_kernel_source("source/conditional.cl",
                         "#if FIRST\n#include \"source/twice.clh\"\n#endif\n"
                         "#include \"source/twice.clh\"\n#include \"source/value.clh\"\n"
                         "kernel void k(global int* out) { *out = twice() + value; }\n");
  photile::device::Context context({});
  for (const long long first : {0ll, 1ll}) {
    CAPTURE(first);
    photile::device::Defines defines;
    defines.set("FIRST", first);
    auto out = context.allocate<int>(1, "result");
    photile::device::Launch(context, context.kernel("source/conditional.cl", "k", defines))
        .set("out", out)
        .run_no_more(1, 1);
    int result = 0;
    context.read(out, std::span(&result, 1));
    CHECK(result == 9);
  }
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
  photile::device::Context context({});
  CHECK_NOTHROW(context.kernel("source/guards.cl", "k", {}));
}

TEST_CASE("an unknown include names itself and its includer") {
  register_kernel_source("source/d.cl", "\n#include \"source/nowhere.clh\"\n");
  CHECK_THROWS_WITH(assemble_source("source/d.cl"), Catch::Contains("'source/nowhere.clh'") &&
                                                        Catch::Contains("'source/d.cl' line 2"));
  CHECK_THROWS_AS(assemble_source("source/none.cl"), photile::KernelBuildError);
}

TEST_CASE("files that include each other end") {
  register_kernel_source("source/e.cl", "#include \"source/f.clh\"\ne\n");
  register_kernel_source("source/f.clh", "#include \"source/e.cl\"\nf\n");
  CHECK_THAT(assemble_source("source/e.cl"), Catch::Contains("\ne\n") && Catch::Contains("\nf\n"));
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
      std::ifstream file(entry.path(), std::ios::binary);
      const std::string text{std::istreambuf_iterator<char>(file), {}};
      const auto name = std::filesystem::relative(entry.path(), base).string();
      bool found = false;
      for (const auto& embedded : photile::device::embedded_files()) {
        if (embedded.path == name) found = embedded.text == text;
      }
      INFO(name);
      CHECK(found);
    }
  };
  compare(root / "kernels", root / "kernels");
  compare(root / "include/photile/device", root / "include");
  CHECK(count == photile::device::embedded_files().size());
}

}  // namespace photile::test
