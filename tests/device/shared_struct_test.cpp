// The structs of include/photile/device/*.h, as the host's compiler and the device's lay them out.
// The lists are made by CMakeLists.txt from the headers, so that no struct can be forgotten.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "device/context.hpp"
#include "device/program_source.hpp"
#include "shared_headers.inc"

namespace {

struct SharedStruct {
  std::string name;
  unsigned bytes;
};

std::vector<SharedStruct> shared_structs() {
  return {
#define SHARED_HEADER(path)
#define SHARED_STRUCT(name) {#name, sizeof(name)},
#include "shared_structs.inc"
#undef SHARED_HEADER
#undef SHARED_STRUCT
  };
}

std::string includes() {
  std::string text;
#define SHARED_HEADER(path) text += "#include \"" #path "\"\n";
#define SHARED_STRUCT(name)
#include "shared_structs.inc"
#undef SHARED_HEADER
#undef SHARED_STRUCT
  return text;
}

}  // namespace

TEST_CASE("every shared struct has the same size on host and device") {
  const auto structs = shared_structs();
  std::string source = includes() + "kernel void sizes(global uint* out) {\n";
  for (std::size_t i = 0; i < structs.size(); ++i) {
    source += fmt::format("  out[{}] = sizeof({});\n", i, structs[i].name);
  }
  photile::device::register_kernel_source("test/sizes.cl", source + "}\n");
  photile::device::Context context({});
  auto out = context.allocate<unsigned>(structs.size(), "sizes");
  context.run(context.kernel("test/sizes.cl", "sizes", {}), 1, 1, out);
  std::vector<unsigned> sizes(structs.size());
  context.read<unsigned>(out, sizes);
  for (std::size_t i = 0; i < structs.size(); ++i) {
    INFO(structs[i].name);
    CHECK(sizes[i] == structs[i].bytes);
  }
}
