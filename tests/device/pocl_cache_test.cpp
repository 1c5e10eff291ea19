// PoCL's compiled kernels between processes: PoCL itself aborts on a damaged cache.
#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "child_process.hpp"
#include "file_bytes.hpp"
#include "probe_output.hpp"
#include "temporary_folder.hpp"

namespace photile::test {
namespace {

namespace fs = std::filesystem;

ChildEnvironment cache_in(const fs::path& folder) {
  return {{"XDG_CACHE_HOME", folder.string()},
          {"POCL_CACHE_DIR", std::nullopt},
          {"PHOTILE_DEVICE", "Portable Computing Language"}};
}

ChildResult probe(const fs::path& cache, const char* mode = "run") {
  return run_child({PHOTILE_DEVICE_PROBE, mode}, cache_in(cache));
}

std::vector<fs::path> entries(const fs::path& folder, const std::string& wanted) {
  std::vector<fs::path> found;
  if (!fs::exists(folder)) return found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename().string().find(wanted) != std::string::npos) {
      found.push_back(entry.path());
    }
  }
  return found;
}

std::vector<fs::path> packs(const fs::path& cache) {
  return entries(cache / "photile" / "kernels", "");
}
std::vector<fs::path> run_folders(const fs::path& cache) {
  return entries(cache / "photile", "pocl-run-");
}

}  // namespace

TEST_CASE("PoCL's kernels are compiled once and restored by the next process") {
  const TemporaryFolder cache;
  const auto first = probe(cache.path);
  INFO(first.errors);
  CHECK(first.output == compiled);
  CHECK(packs(cache.path).size() == 1);
  CHECK(run_folders(cache.path).empty());
  const auto second = probe(cache.path);
  INFO(second.errors);
  CHECK(second.output == restored);
  CHECK(second.errors.empty());
}

TEST_CASE("PoCL's kernels that were compiled at the installation are not compiled for a user") {
  const TemporaryFolder installed, cache;
  probe(installed.path);
  const fs::path share = installed.path / "share";
  fs::create_directories(share / "photile");
  fs::rename(installed.path / "photile" / "kernels", share / "photile" / "kernels");
  auto environment = cache_in(cache.path);
  environment["XDG_DATA_DIRS"] = share.string();
  const auto result = run_child({PHOTILE_DEVICE_PROBE, "run"}, environment);
  INFO(result.errors);
  CHECK(result.output == restored);
  CHECK(packs(cache.path).empty());
}

TEST_CASE("a pack holds what PoCL needs: without recompiling nothing is published again") {
  const TemporaryFolder cache;
  probe(cache.path);
  const auto pack = packs(cache.path).at(0);
  CHECK_THAT(bytes_of(pack), Catch::Contains("/program.bc") && Catch::Contains(".so"));
  const auto written = fs::last_write_time(pack);
  probe(cache.path);
  CHECK(fs::last_write_time(pack) == written);
}

TEST_CASE("a damaged pack of PoCL's files ends in the right result and one warning", "[slow]") {
  const TemporaryFolder cache;
  probe(cache.path);
  const auto pack = packs(cache.path).at(0);
  const auto good = bytes_of(pack);
  auto flipped = good;
  flipped[good.size() / 2] ^= 1;
  auto garbage = good;
  // The shared object sorts before program.bc or after it: spoil both halves of the payload.
  std::fill(garbage.begin() + 200, garbage.begin() + 300, 'x');
  std::fill(garbage.end() - 300, garbage.end() - 200, 'x');
  for (const auto& bad : {std::string(), good.substr(0, 30), good.substr(0, good.size() / 2),
                          good.substr(0, good.size() - 1), flipped, garbage}) {
    put(pack, bad);
    const auto result = probe(cache.path);
    INFO(bad.size() << " bytes: " << result.errors);
    CHECK(result.exit_code == 0);
    CHECK(result.output == compiled);
    CHECK_THAT(result.errors, Catch::StartsWith("photile: warning: ") &&
                                  Catch::Contains(pack.filename().string()));
    CHECK(std::count(result.errors.begin(), result.errors.end(), '\n') == 1);
    CHECK(probe(cache.path).output == restored);
  }
}

TEST_CASE("damaged files in the folder of a killed process are never used, and go") {
  const TemporaryFolder cache;
  probe(cache.path);
  // Files as a process leaves them that was killed while PoCL wrote: each empty, cut, or garbage.
  for (const int damage : {0, 1, 2}) {
    probe(cache.path, "abort");
    int files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(run_folders(cache.path).at(0))) {
      if (!entry.is_regular_file() || entry.path().filename() == "lock") continue;
      const auto text = bytes_of(entry.path());
      put(entry.path(), damage == 0   ? ""
                        : damage == 1 ? text.substr(0, text.size() / 2)
                                      : std::string(text.size(), 'x'));
      ++files;
    }
    CHECK(files > 1);
    const auto result = probe(cache.path);
    INFO(result.errors);
    CHECK(result.output == restored);
    CHECK(run_folders(cache.path).empty());
  }
}

TEST_CASE("a process that dies publishes nothing, and the next removes its folder") {
  const TemporaryFolder cache;
  CHECK(probe(cache.path, "abort").signal == SIGABRT);
  CHECK(packs(cache.path).empty());
  CHECK(run_folders(cache.path).size() == 1);
  CHECK(probe(cache.path).output == compiled);
  CHECK(run_folders(cache.path).empty());
}

TEST_CASE("several processes may start at a time on an empty cache") {
  const TemporaryFolder cache;
  std::vector<ChildProcess> running;
  for (int i = 0; i < 6; ++i) {
    running.emplace_back(std::vector<std::string>{PHOTILE_DEVICE_PROBE, "run"},
                         cache_in(cache.path));
  }
  for (auto& child : running) {
    const auto result = child.wait();
    INFO(result.errors);
    CHECK(result.exit_code == 0);
    CHECK_THAT(result.output, Catch::StartsWith(right));
    CHECK(result.errors.empty());
  }
  CHECK(packs(cache.path).size() == 1);
  CHECK(run_folders(cache.path).empty());
  CHECK(probe(cache.path).output == restored);
}

TEST_CASE("without the cache nothing is read and nothing is kept") {
  const TemporaryFolder cache;
  const auto uncached = [&] {
    return run_child({PHOTILE_DEVICE_PROBE, "run", "--no-cache"}, cache_in(cache.path));
  };
  CHECK(uncached().output == compiled);
  CHECK(packs(cache.path).empty());
  probe(cache.path);
  CHECK(uncached().output == compiled);
  CHECK(run_folders(cache.path).empty());
}

}  // namespace photile::test
