// Compiled kernels between processes.
#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <set>

#include "child_process.hpp"
#include "device/cache_folder.hpp"
#include "device/kernel_store.hpp"
#include "file_bytes.hpp"
#include "photile/errors.hpp"
#include "temporary_folder.hpp"

namespace photile::test {
namespace {

namespace fs = std::filesystem;
using device::CacheKey;
using device::program_key;
using device::read_checked_file;
using device::write_checked_file;

// What photile_device_probe prints when it runs its kernel.

/// 999^2, and the sum of i^2 for i < 1000.
const std::string right = "last=998001 sum=332833500";
const std::string compiled = right + " built=1 cached=0\n";
const std::string restored = right + " built=0 cached=1\n";

CacheKey key_of(const std::string& text) {
  ContentHash hash;
  hash.add(text);
  return hash.digest();
}

// Compiled kernels between processes, on Oclgrind's simulator: every runtime but PoCL is treated
// so.

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

// PoCL's compiled kernels between processes: PoCL itself aborts on a damaged cache.

ChildEnvironment cache_in(const fs::path& folder) {
  return {{"XDG_CACHE_HOME", folder.string()},
          {"POCL_CACHE_DIR", std::nullopt},
          {"PHOTILE_DEVICE", "Portable Computing Language"}};
}

ChildResult probe(const fs::path& cache, const char* mode = "run") {
  return run_child({PHOTILE_DEVICE_PROBE, mode}, cache_in(cache));
}

std::vector<fs::path> entries(const fs::path& folder, const std::string& requested) {
  std::vector<fs::path> found;
  if (!fs::exists(folder)) return found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename().string().find(requested) != std::string::npos) {
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

void check_right_and_silent(const ChildResult& result) {
  INFO(result.errors);
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.output, Catch::StartsWith(right));
  CHECK(result.errors.empty());
}

TEST_CASE("several processes may start at a time on an empty cache") {
  const TemporaryFolder cache;
  std::vector<ChildProcess> running;
  for (int i = 0; i < 6; ++i) {
    running.emplace_back(std::vector<std::string>{PHOTILE_DEVICE_PROBE, "run"},
                         cache_in(cache.path));
  }
  for (auto& child : running) check_right_and_silent(child.wait());
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

// Where PoCL's compiled kernels go when the usual folder cannot be used: PoCL itself aborts.

ChildResult probe(ChildEnvironment environment) {
  environment["PHOTILE_DEVICE"] = "Portable Computing Language";
  environment.try_emplace("POCL_CACHE_DIR", std::nullopt);
  environment.try_emplace("XDG_CACHE_HOME", std::nullopt);
  return run_child({PHOTILE_DEVICE_PROBE, "run"}, environment);
}

TEST_CASE("a run needs no HOME, nor one that can be written") {
  // Nothing can be created below a file or in /proc, not even by root.
  for (const char* home : {"/dev/null", "/proc", "", "relative"}) {
    INFO("HOME='" << home << "'");
    const TemporaryFolder temporary;
    check_right_and_silent(probe({{"HOME", home}, {"TMPDIR", temporary.path.string()}}));
    CHECK(fs::is_empty(temporary.path));
  }
  check_right_and_silent(probe({{"HOME", std::nullopt}}));
}

TEST_CASE("HOME may have blanks and quotes in its path, and the cache works there") {
  const TemporaryFolder folder;
  const auto home = folder.path / "a user's \"home\" folder";
  fs::create_directory(home);
  check_right_and_silent(probe({{"HOME", home.string()}}));
  CHECK(probe({{"HOME", home.string()}}).output == restored);
  CHECK(fs::exists(home / ".cache" / "photile" / "kernels"));
}

TEST_CASE("an XDG cache folder that cannot be used falls back to HOME") {
  const TemporaryFolder home;
  check_right_and_silent(probe({{"HOME", home.path.string()}, {"XDG_CACHE_HOME", "/dev/null"}}));
  CHECK(fs::exists(home.path / ".cache" / "photile" / "kernels"));
}

TEST_CASE("without any folder to write the message names the remedy") {
  const auto result = probe({{"HOME", "/dev/null"}, {"TMPDIR", "/dev/null"}});
  CHECK(result.exit_code == 4);
  CHECK_THAT(result.errors, Catch::Contains("no folder for compiled kernels") &&
                                Catch::Contains("XDG_CACHE_HOME or TMPDIR"));
  CHECK(std::count(result.errors.begin(), result.errors.end(), '\n') == 1);
}

TEST_CASE("PoCL's folder, where the user set it, is used and left as PoCL wants it") {
  const TemporaryFolder own, home;
  check_right_and_silent(
      probe({{"HOME", home.path.string()}, {"POCL_CACHE_DIR", own.path.string()}}));
  CHECK_FALSE(fs::is_empty(own.path));
  CHECK_FALSE(fs::exists(home.path / ".cache"));
}

TEST_CASE("a folder of the user's that PoCL would abort on is replaced, with one warning") {
  const TemporaryFolder home;
  const std::string folder = GENERATE("/dev/null/x", "/dev/null/x'\nphotile: error: no");
  const auto result = probe({{"HOME", home.path.string()}, {"POCL_CACHE_DIR", folder}});
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.output, Catch::StartsWith(right));
  CHECK_THAT(result.errors, Catch::StartsWith("photile: warning: POCL_CACHE_DIR '/dev/null/x'"));
  CHECK(std::count(result.errors.begin(), result.errors.end(), '\n') == 1);
  check_right_and_silent(probe({{"HOME", home.path.string()}, {"POCL_CACHE_DIR", ""}}));
}

TEST_CASE("a folder is refused with the reason") {
  const TemporaryFolder folder;
  CHECK(device::folder_problem(folder.path / "new" / "folder").empty());
  CHECK_FALSE(device::folder_problem("/dev/null/x").empty());
  CHECK_FALSE(device::folder_problem("/proc/x").empty());
}

DeviceInfo device() {
  DeviceInfo info;
  info.name = "name";
  info.platform = "platform";
  info.vendor = "vendor";
  info.version = "OpenCL 1.2";
  info.driver_version = "driver 1";
  info.platform_version = "OpenCL 1.2 platform";
  return info;
}

TEST_CASE("whatever may change a program's code changes its key") {
  std::set<std::string> keys;
  const auto add = [&](const DeviceInfo& info, const char* options, const char* source) {
    keys.insert(hex(program_key(info, options, source)));
  };
  add(device(), "options", "source");
  add(device(), "options2", "source");
  add(device(), "options", "source2");
  add(device(), "optionss", "ource");
  for (auto field :
       {&DeviceInfo::name, &DeviceInfo::platform, &DeviceInfo::vendor, &DeviceInfo::version,
        &DeviceInfo::driver_version, &DeviceInfo::platform_version}) {
    auto info = device();
    info.*field += "x";
    add(info, "options", "source");
  }
  CHECK(keys.size() == 10);
  add(device(), "options", "source");
  CHECK(keys.size() == 10);
}

TEST_CASE("Code generation variables of PoCL and of Intel's runtime are in their keys alone") {
  auto pocl = device();
  pocl.is_pocl = true;
  const auto plain = program_key(pocl, "", "s");
  const auto plain_other = program_key(device(), "", "s");
  ::setenv("POCL_WORK_GROUP_METHOD", "loops", 1);
  const auto loops = program_key(pocl, "", "s");
  const auto loops_other = program_key(device(), "", "s");
  ::setenv("POCL_WORK_GROUP_METHOD", "cbs", 1);
  const auto cbs = program_key(pocl, "", "s");
  ::unsetenv("POCL_WORK_GROUP_METHOD");
  ::setenv("CL_CONFIG_CPU_TARGET_ARCH", "core-avx2", 1);
  const auto intel = program_key(device(), "", "s");
  const auto intel_pocl = program_key(pocl, "", "s");
  ::unsetenv("CL_CONFIG_CPU_TARGET_ARCH");
  CHECK_FALSE(plain_other == intel);
  CHECK(plain == intel_pocl);
  CHECK_FALSE(plain == loops);
  CHECK_FALSE(loops == cbs);
  CHECK(plain_other == loops_other);
  CHECK(program_key(pocl, "", "s") == plain);
}

TEST_CASE("a hash is XXH3-128 as its specification gives it for the empty text") {
  CHECK(hex(ContentHash().digest()) == "99aa06d3014798d86001c324468d497f");
}

const CacheKey key = key_of("the key");
const std::string payload("binary \0 payload \xff", 18);

TEST_CASE("a checked file reads back, and each that is damaged is a miss with a reason") {
  const TemporaryFolder folder;
  const auto file = folder.path / "entry";
  write_checked_file(file, key, payload);
  const auto good = bytes_of(file);
  REQUIRE(good.size() == CacheKey{}.size() + payload.size());
  CHECK(read_checked_file(file, key).payload == payload);
  CHECK_FALSE(read_checked_file(file, key_of("another")).payload);
  std::vector<std::string> damaged{good + "x"};
  for (std::size_t i = 0; i < good.size(); ++i) {
    damaged.push_back(good.substr(0, i));
    damaged.push_back(good);
    damaged.back()[i] = static_cast<char>(good[i] ^ (1 << i % 8));
  }
  for (const std::string& bad : damaged) {
    put(file, bad);
    const auto read = read_checked_file(file, key);
    CAPTURE(&bad - damaged.data());
    REQUIRE_FALSE(read.payload);
    REQUIRE_FALSE(read.problem.empty());
  }
}

TEST_CASE("a folder or a FIFO in place of a checked file is a miss and does not hang") {
  const TemporaryFolder folder;
  CHECK_FALSE(read_checked_file(folder.path, key).payload);
  REQUIRE(::mkfifo((folder.path / "fifo").c_str(), 0600) == 0);
  CHECK_FALSE(read_checked_file(folder.path / "fifo", key).payload);
  CHECK_THROWS_AS(write_checked_file(folder.path / "no" / "entry", key, payload), OutputError);
}

}  // namespace
}  // namespace photile::test
