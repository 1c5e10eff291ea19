// Compiled kernels between processes, on Oclgrind's simulator: every runtime but PoCL is treated
// so.
#include "device/kernel_store.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "child_process.hpp"
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
  ChildResult probe(const std::string& data_folders = "") const {
    return run_child({PHOTILE_DEVICE_PROBE, "run"},
                     {{"OCL_ICD_VENDORS", (folder.path / "vendors").string()},
                      {"XDG_CACHE_HOME", (folder.path / "cache").string()},
                      {"XDG_DATA_DIRS", data_folders},
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
    CHECK_THAT(result.errors, Catch::StartsWith("photile: warning: compiled kernels"));
    CHECK(simulator.probe().output == restored);
  }
}

TEST_CASE("a program file of another program under this one's name is a miss") {
  const TemporaryFolder folder;
  const photile::device::KernelStore cache(folder.path, {}, ".program");
  const auto key = photile::device::hash("one"), other = photile::device::hash("other");
  CHECK_FALSE(cache.load(key));
  cache.store(key, "binary");
  CHECK(cache.load(key) == "binary");
  fs::copy_file(cache.file(key), cache.file(other));
  CHECK_FALSE(cache.load(other));
}

TEST_CASE("kernels compiled at the installation are read where the user has none, and left alone") {
  const Simulator simulator;
  CHECK(simulator.probe().output == compiled);
  const fs::path share = simulator.folder.path / "share", kernels = share / "photile" / "kernels";
  fs::create_directories(kernels);
  fs::copy(simulator.program().parent_path(), kernels);
  const fs::path installed = *fs::directory_iterator(kernels);
  fs::remove_all(simulator.folder.path / "cache");
  const std::string missing = simulator.folder.path / "missing";
  const auto probe = [&](const std::string& folders) { return simulator.probe(folders); };
  CHECK(probe(missing + ":" + share.string()).output == restored);
  CHECK(fs::is_empty(simulator.folder.path / "cache" / "photile" / "kernels"));
  // What is damaged is compiled again, for the user alone.
  fs::resize_file(installed, 60);
  const auto damaged = probe(share.string());
  CHECK(damaged.output == compiled);
  CHECK_THAT(damaged.errors, Catch::Contains(installed.string()));
  CHECK(fs::file_size(installed) == 60);
  CHECK(probe(share.string()).output == restored);
}

}  // namespace photile::test
