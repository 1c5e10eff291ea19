// Program binaries between processes, on Oclgrind's simulator: every runtime but PoCL is treated
// so.
#include "device/program_cache.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "child_process.hpp"
#include "device/cache_key.hpp"
#include "device/checked_file.hpp"
#include "probe_output.hpp"
#include "temporary_folder.hpp"

namespace photile::test {
namespace {

namespace fs = std::filesystem;

/// A machine whose only runtime is the simulator, with a cache of its own.
struct Simulator {
  TemporaryFolder folder;
  Simulator() {
    fs::create_directory(folder.path / "vendors");
    std::ofstream(folder.path / "vendors" / "oclgrind.icd") << PHOTILE_OCLGRIND_ICD << '\n';
  }
  ChildResult probe() const {
    return run_child({PHOTILE_DEVICE_PROBE, "run"},
                     {{"OCL_ICD_VENDORS", (folder.path / "vendors").string()},
                      {"XDG_CACHE_HOME", (folder.path / "cache").string()},
                      {"PHOTILE_DEVICE", std::nullopt}});
  }
  fs::path program() const {
    return *fs::directory_iterator(folder.path / "cache" / "photile" / "kernels");
  }
};

}  // namespace

TEST_CASE("a program is compiled once and loaded by the next process") {
  const Simulator simulator;
  const auto first = simulator.probe();
  INFO(first.errors);
  CHECK(first.output == compiled);
  const auto second = simulator.probe();
  INFO(second.errors);
  CHECK(second.output == restored);
  CHECK(second.errors.empty());
}

TEST_CASE("a damaged program file is compiled again, with one warning, and replaced") {
  const Simulator simulator;
  simulator.probe();
  for (const auto size : {0, 40, 60, 1000}) {
    fs::resize_file(simulator.program(), static_cast<std::uintmax_t>(size));
    const auto result = simulator.probe();
    INFO(size << " bytes: " << result.errors);
    CHECK(result.output == compiled);
    CHECK_THAT(result.errors, Catch::StartsWith("photile: warning: compiled program"));
    CHECK(simulator.probe().output == restored);
  }
}

TEST_CASE("a program file of another program under this one's name is a miss") {
  const TemporaryFolder folder;
  const photile::device::ProgramCache cache(folder.path);
  const auto key = photile::device::hash("one"), other = photile::device::hash("other");
  CHECK_FALSE(cache.load(key));
  cache.store(key, "binary");
  CHECK(cache.load(key) == "binary");
  fs::copy_file(cache.file(key), cache.file(other));
  CHECK_FALSE(cache.load(other));
}

}  // namespace photile::test
