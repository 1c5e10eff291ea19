// Where PoCL's compiled kernels go when the usual folder cannot be used: PoCL itself aborts.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>

#include "child_process.hpp"
#include "device/cache_folder.hpp"
#include "probe_output.hpp"
#include "temporary_folder.hpp"

namespace photile::test {
namespace {

namespace fs = std::filesystem;

ChildResult probe(ChildEnvironment environment) {
  environment["PHOTILE_DEVICE"] = "Portable Computing Language";
  environment.try_emplace("POCL_CACHE_DIR", std::nullopt);
  environment.try_emplace("XDG_CACHE_HOME", std::nullopt);
  return run_child({PHOTILE_DEVICE_PROBE, "run"}, environment);
}

void check_right_and_silent(const ChildResult& result) {
  INFO(result.errors);
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.output, Catch::StartsWith(right));
  CHECK(result.errors.empty());
}

}  // namespace

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
  const auto again = probe({{"HOME", home.string()}});
  CHECK(again.output == right + " built=0 cached=1\n");
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
  CHECK(photile::device::folder_problem(folder.path / "new" / "folder").empty());
  CHECK_FALSE(photile::device::folder_problem("/dev/null/x").empty());
  CHECK_FALSE(photile::device::folder_problem("/proc/x").empty());
}

}  // namespace photile::test
