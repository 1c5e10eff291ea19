// The structs of include/photile/device/*.h, as the host's compiler and the device's lay them out.
// The lists are made by CMakeLists.txt from the headers, so that no struct or member is forgotten.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstddef>

#include "device/launch.hpp"
#include "device/program_source.hpp"
#include "shared_headers.inc"

namespace photile::test {
namespace {

/// A number of a struct's layout, on the host, and what computes it on the device.
struct LayoutNumber {
  std::string what;
  std::size_t on_host;
  std::string on_device;
};

std::vector<LayoutNumber> layout_numbers() {
  return {
#define SHARED_HEADER(path)
#define SHARED_STRUCT(name) {"size of " #name, sizeof(name), "sizeof(" #name ")"},
#define SHARED_MEMBER(name, member)            \
  {#name "::" #member, offsetof(name, member), \
   "(uint)((private char*)&of_" #name "." #member " - (private char*)&of_" #name ")"},
#include "shared_structs.inc"
#undef SHARED_HEADER
#undef SHARED_STRUCT
#undef SHARED_MEMBER
  };
}

std::string source_of(const std::vector<LayoutNumber>& numbers) {
  std::string includes, structs, writes;
#define SHARED_HEADER(path) includes += "#include \"" #path "\"\n";
#define SHARED_STRUCT(name) structs += "  " #name " of_" #name ";\n";
#define SHARED_MEMBER(name, member)
#include "shared_structs.inc"
#undef SHARED_HEADER
#undef SHARED_STRUCT
#undef SHARED_MEMBER
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    writes += fmt::format("  out[{}] = {};\n", i, numbers[i].on_device);
  }
  return includes + "kernel void layout(global uint* out) {\n" + structs + writes + "}\n";
}

}  // namespace

TEST_CASE(
    "every shared struct has the same size and members at the same places on host and device") {
  const std::vector<LayoutNumber> numbers = layout_numbers();
  REQUIRE(numbers.size() > 40);
  device::register_kernel_source("test/layout.cl", source_of(numbers));
  device::Context context({});
  auto out = context.allocate<unsigned>(numbers.size(), "layout");
  device::Launch(context, context.kernel("test/layout.cl", "layout", {}))
      .set("out", out)
      .run_no_more(1, 1);
  std::vector<unsigned> on_device(numbers.size());
  context.read<unsigned>(out, on_device);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    INFO(numbers[i].what);
    CHECK(on_device[i] == numbers[i].on_host);
  }
}

}  // namespace photile::test
