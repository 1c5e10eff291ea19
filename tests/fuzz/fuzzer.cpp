// What libFuzzer calls. PHOTILE_FUZZ_TARGET says which reader is tried.
#include <tbb/global_control.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "json_mutator.hpp"

namespace {

using namespace photile::test;

std::string_view target_name() {
  const char* const name = std::getenv("PHOTILE_FUZZ_TARGET");
  return name == nullptr ? "" : name;
}

FuzzTarget chosen_target() {
  const auto found = fuzz_targets().find(target_name());
  if (found != fuzz_targets().end()) return found->second;
  std::fputs("PHOTILE_FUZZ_TARGET names no target; there are", stderr);
  for (const auto& [name, target] : fuzz_targets()) std::fprintf(stderr, " %s", name.data());
  std::fputs("\n", stderr);
  std::exit(2);
}

}  // namespace

extern "C" {

/// A short memory of what was freed and where: inputs are small, and the memory that is used stays
/// in the caches. Leaks are told by the tests under the preset "sanitizers". ASAN_OPTIONS overrides
/// it.
const char* __asan_default_options() {
  return "quarantine_size_mb=4:malloc_context_size=2:detect_leaks=0";
}

std::size_t LLVMFuzzerMutate(std::uint8_t* bytes, std::size_t size, std::size_t most);

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const FuzzTarget target = chosen_target();
  // Threads that are woken take longer than an input.
  static const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  target({bytes, size});
  return 0;
}

/// Half of the changes to JSON leave it JSON: changes of bytes seldom get beyond the parser.
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* bytes, std::size_t size, std::size_t most,
                                    unsigned seed) {
  static const bool json = target_name() == "gltf" || target_name() == "planes" ||
                           target_name() == "moods" || target_name() == "camera_path" ||
                           target_name() == "luminaires";
  if (json && seed % 2 == 0) {
    const std::string changed = mutated_json({bytes, size}, seed / 2);
    if (!changed.empty() && changed.size() <= most) {
      changed.copy(reinterpret_cast<char*>(bytes), changed.size());
      return changed.size();
    }
  }
  return LLVMFuzzerMutate(bytes, size, most);
}
}
