// Scenes that cannot be rendered, files that ask for too much, outputs that cannot be written.
#include <fmt/format.h>
#include <stdlib.h>
#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <filesystem>

#include "box_scene.hpp"
#include "command/processes.hpp"
#include "loading/luminaires.hpp"
#include "photile/image.hpp"
#include "view/moods.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

TEST_CASE("of an unreadable scene info and render say the same, and nothing is written") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  std::filesystem::permissions(scene, std::filesystem::perms::none);
  Run run{.arguments = {"info", scene}, .held_to_permissions = true};
  const std::string line = only_error(run_photile(run), bad_input);
  CHECK_THAT(line, Contains("box.obj"));
  run.arguments = {"render", scene, "-o", folder / "out.exr"};
  CHECK(last_error(run_photile(run), bad_input) == line);
  CHECK_FALSE(std::filesystem::exists(folder / "out.exr"));
}

// Small files that ask for much: refused, and in little memory. (Time is no matter of assertions;
// each of these takes less than a second.)

constexpr long most_kilobytes = 256 << 10;  ///< beside the file itself

TEST_CASE("a small EXR that says that it is huge is refused in little memory") {
  // A header of 9,000 x 9,000 pixels of six channels: zeros would compress to two megabytes; what
  // follows the pixels does not count.
  const std::size_t size = GENERATE(2'100'000, 6'000'000);
  CAPTURE(size);
  Image row;
  row.width = 9'000;
  row.height = 1;
  for (const char* name :
       {"R", "G", "B", "Combined_lamp.R", "Combined_lamp.G", "Combined_lamp.B"}) {
    row.add(name);
  }
  const FileFolder folder;
  write_exr(folder / "row.exr", row);
  std::string bytes = folder.read("row.exr");
  const std::string window("dataWindow\0box2i\0", 17);
  const std::int32_t last = 8'999;
  std::memcpy(&bytes[bytes.find(window) + window.size() + 4 * sizeof last], &last, sizeof last);
  bytes.resize(size);
  const std::string file = folder.write("a.exr", bytes);
  for (const auto& command :
       {typed("relight", file, "-o", folder / "b.exr"), typed("compare", file, file),
        typed("render", write_box(folder), "-o", folder / "b.exr", "--environment", file)}) {
    const Outcome taken = run_photile(command);
    CHECK_THAT(last_error(taken, bad_input),
               Contains("a.exr: ") && Contains("pixels per byte") && Contains("scale it down"));
    CHECK(taken.kilobytes < most_kilobytes);
  }
}

TEST_CASE("JSON that is nested a million deep is refused in a line") {
  constexpr std::size_t levels = 1'000'000;
  const FileFolder folder;
  const std::string file =
      folder.write("deep.json", std::string(levels, '[') + "0" + std::string(levels, ']'));
  CHECK_THROWS_WITH(view::Moods(file), Contains("deep.json: the JSON is nested more than"));
  // Brackets in texts are none.
  const std::string text = "[{\"name\": \"\\\"" + std::string(levels, '[') + "\"}]";
  CHECK(loading::LuminaireList::parse(text, "texts").entries.size() == 1);
}

// Runs that are held to few threads, or to little address space.

// --threads: how many threads work on the host.

std::size_t allowed() {
  return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

TEST_CASE("where threads cannot be made, every command says so in one line") {
  const FileFolder folder;
  std::filesystem::permissions(folder / "", std::filesystem::perms::all);
  write_box(folder);
  const auto [limit, words] = GENERATE(
      table<int, std::string>({{1, "trace SCENE -o NOWHERE.maps --photons 5k"},
                               {3, "trace SCENE -o NOWHERE.maps --photons 5k"},
                               {1, "render SCENE -o NOWHERE.png -q --photons 5k --size 4x4"},
                               {4, "render SCENE -o NOWHERE.png -q --photons 5k --size 4x4"},
                               {1, "devices"},
                               {2, "devices --test"}}));
  CAPTURE(words, limit);
  const Run run{.arguments = typed(filled(words, folder).c_str()),
                .limits = {{RLIMIT_NPROC, limit}}};
  CHECK_THAT(only_error(run_photile(run), failure), Contains("threads can be created"));
}

TEST_CASE("numbers of threads that PoCL cannot have are bounded before it is asked") {
  const FileFolder folder;
  Run run = small_render(folder);
  run.arguments.emplace_back("-q");
  run.environment["POCL_MAX_PTHREAD_COUNT"] = GENERATE("-1", "0", "100000", "many");
  succeed(run);
}

TEST_CASE("an address space that is too small for a device's compiler is told before it is asked") {
  const FileFolder folder;
  Run run = small_render(folder);
  run.environment["XDG_CACHE_HOME"] = folder / "cache";  // kernels are to be compiled
  const std::uint64_t megabytes = GENERATE(600, 650, 700, 1'000);
  run.limits[RLIMIT_AS] = megabytes << 20;
  CHECK_THAT(last_error(run_photile(run), no_device), Contains("ulimit -v"));
}

TEST_CASE(
    "files and stacks that are too small for a device's compiler are told before it is asked") {
  const FileFolder folder;
  Run run = small_render(folder);
  run.environment["XDG_CACHE_HOME"] = folder / "cache";
  run.limits[RLIMIT_FSIZE] = GENERATE(0, 10'000, 100'000, 1'000'000);
  CHECK_THAT(last_error(run_photile(run), no_device), Contains("ulimit -f"));
  run.limits = {{RLIMIT_STACK, 128 << 10}};
  CHECK_THAT(only_error(run_photile(run), failure), Contains("ulimit -s"));
}

/// glibc reserves 64 MiB for each thread that happens to allocate while another does, else.
constexpr const char* one_arena = "1";

/// The least bytes of address space with which photile asks a device for anything, on this machine:
/// what its libraries take differs from one to the next, and the refusal of less says it.
std::uint64_t least_address_space(const FileFolder& folder) {
  constexpr std::uint64_t refused = 800, requested = 1'024, margin = 8;  // MiB
  Run run = small_render(folder);
  run.environment["MALLOC_ARENA_MAX"] = one_arena;
  run.limits[RLIMIT_AS] = refused << 20;
  const std::string line = last_error(run_photile(run), no_device);
  CAPTURE(line);
  const std::size_t number = line.find_first_of("0123456789");
  REQUIRE(number != std::string::npos);
  REQUIRE_THAT(line, Contains(" MiB of address space are left") && Contains(" up to 1024;"));
  return (refused - std::stoull(line.substr(number)) + requested + margin) << 20;
}

/// A render of photons in that address space, to out.png.
Outcome render_in_least_address_space(const FileFolder& folder, const std::string& photons) {
  return run_photile({.arguments = typed("render", write_box(folder), "-q -o", folder / "out.png",
                                         "--size 16x12 --set light_map_rays=0 --photons", photons),
                      .environment = {{"MALLOC_ARENA_MAX", one_arena}},
                      .limits = {{RLIMIT_AS, least_address_space(folder)}}});
}

TEST_CASE("photons for which the address space is too small end in one line, and not in PoCL") {
  // A photon takes 28 bytes on the host alone, and each path leaves one at least.
  const FileFolder folder;
  CHECK_THAT(only_error(render_in_least_address_space(folder, "50M"), failure),
             Contains("out of memory"));
  CHECK_FALSE(std::filesystem::exists(folder / "out.png"));
}

TEST_CASE("at the border of an address space there is a line or the picture that there is without",
          "[slow]") {
  // Somewhere here the host's photons fit, and those of the device do not.
  const FileFolder folder;
  int failed = 0, rendered = 0;
  for (const char* photons : {"250k", "1M", "2M", "3M", "3500k", "4M", "4500k", "5M", "6M", "8M"}) {
    CAPTURE(photons);
    const Outcome outcome = render_in_least_address_space(folder, photons);
    CAPTURE(outcome.errors);
    if (outcome.exit_code != 0) {
      ++failed;
      CHECK((outcome.exit_code == failure || outcome.exit_code == no_device));
      CHECK_THAT(only_error(outcome, outcome.exit_code),
                 Contains("out of memory") || Contains("ulimit -v") || Contains("may use"));
      continue;
    }
    ++rendered;
    const std::string bounded = folder.read("out.png");
    succeed(typed("render", write_box(folder), "-q -o", folder / "out.png",
                  "--size 16x12 --set light_map_rays=0 --photons", photons));
    CHECK(folder.read("out.png") == bounded);
  }
  CHECK(failed > 0);
  CHECK(rendered > 0);
}

/// The box with 250 more lamps in rows under its ceiling.
std::string write_lamps(const FileFolder& folder) {
  write_box(folder);
  std::string obj = box_obj();
  for (int lamp = 0; lamp < 250; ++lamp) {
    const double x = -0.9 + 0.09 * (lamp % 20), z = -0.9 + 0.05 * (lamp / 20);
    obj +=
        fmt::format("o l{}\nusemtl red_lamp\nv {} 0.9 {}\nv {} 0.9 {}\nv {} 0.9 {}\nf -3 -2 -1\n",
                    lamp, x, z, x + 0.02, z, x + 0.02, z + 0.02);
  }
  return folder.write("lamps.obj", obj);
}

TEST_CASE("the hits of a picture wait for their light in a bounded memory, however many lights") {
  const FileFolder folder;
  // All hits at once, each with the light of 252 lamps, would take 2.6 GB.
  CHECK(succeed(typed("render", write_lamps(folder), "-q -o", folder / "out.png",
                      "--quality draft --photons 20k --size 256x192"))
            .kilobytes < 1'500'000);
}

TEST_CASE("a picture whose pixels have too many lights is refused once its first rows tell") {
  const FileFolder folder;
  const std::vector<std::string> words =
      typed("render", write_lamps(folder), "-q -o", folder / "out.exr",
            "--quality draft --samples 1 --photons 20k --size 16384x16384");
  CHECK_THAT(only_error(run_photile(words), usage),
             Contains("with 252 lights takes") && Contains("--light-group"));
}

TEST_CASE("while a limit of threads lives, TBB keeps to it") {
  const std::size_t before = allowed();
  for (const int count : {1, 2, 3}) {
    const app::ThreadLimit limit(count);
    CHECK(allowed() == static_cast<std::size_t>(count));
  }
  CHECK(allowed() == before);
  const app::ThreadLimit none(0);
  CHECK(allowed() == before);
  for (const char* variable : {"POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT"}) {
    ::unsetenv(variable);  // those of the tests that follow
  }
}

}  // namespace
}  // namespace photile::test
