// Killed at any moment, and on a disk that is full: old files or whole new ones, and nothing else.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <random>
#include <thread>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"
#include "skipped.hpp"

namespace photile::test {
namespace {

using Clock = std::chrono::steady_clock;

/// Runs photile in a folder of a disk of such a size, which no other process sees; tells what is
/// left there.
Outcome run_on_small_disk(const FileFolder& folder, const std::string& arguments,
                          const std::string& size = "64k") {
  const std::string script = "mount -t tmpfs -o size=" + size + " none '" + (folder / "disk") +
                             "' && '" PHOTILE_COMMAND "' " + arguments + "; code=$?; ls -A '" +
                             (folder / "disk") + "'; exit $code";
  const std::string file = folder.write("run.sh", script);
  const std::string output = folder / "output", errors = folder / "errors";
  const int status = std::system(("XDG_CACHE_HOME='" PHOTILE_TEST_CACHE "' unshare -m sh '" + file +
                                  "' > '" + output + "' 2> '" + errors + "'")
                                     .c_str());
  return {WEXITSTATUS(status), folder.read("output"), folder.read("errors")};
}

}  // namespace

TEST_CASE("killed a hundred times at any moment, a render leaves the old picture or a new one",
          "[slow]") {
  const FileFolder folder;
  const std::vector<std::string> arguments{
      "render", write_box(folder),  "-o",        folder / "out.exr",
      "-o",     folder / "out.png", "--photons", "20k",
      "--size", "200x150",          "--quality", "draft"};
  const auto begin = Clock::now();
  REQUIRE(run_photile(arguments).exit_code == 0);
  const auto whole = std::chrono::duration<double>(Clock::now() - begin);
  const std::vector<float> expected = *read_image(folder / "out.exr").find("G");
  const std::string png = folder.read("out.png");
  std::mt19937 random(1);
  int killed = 0, old = 0;
  for (int turn = 0; turn < 100; ++turn) {
    const std::string before = "old";
    folder.write("out.exr", before);
    folder.write("out.png", before);
    const pid_t child = start_photile(arguments);
    std::this_thread::sleep_for(whole * std::uniform_real_distribution<double>(0.2, 1.1)(random));
    ::kill(child, SIGKILL);
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    killed += WIFSIGNALED(status) ? 1 : 0;
    if (folder.read("out.exr") == before) {
      ++old;
    } else {
      CHECK(*read_image(folder / "out.exr").find("G") == expected);
    }
    CHECK((folder.read("out.png") == before || folder.read("out.png") == png));
  }
  CHECK(killed > 20);
  CHECK(old > 20);
  REQUIRE(run_photile(arguments).exit_code == 0);
  CHECK(folder.file_count() == 4);  // the scene's, and the pictures: nothing of killed runs
}

/// A command, by its words: FOLDER and DISK stand for folders, SCENE, LARGE and MANY for files of
/// the former, NOWHERE for a picture that nobody looks at.
std::string filled(std::string command, const FileFolder& folder) {
  const std::vector<std::pair<std::string, std::string>> words{
      {"DISK", folder / "disk"},
      {"SCENE", folder / "box.obj"},
      {"LARGE", folder / "large.exr"},
      {"MANY", folder / "many.pts"},
      {"PATH", folder / "path.json"},
      {"NOWHERE", folder / "other"},
      {"DRAFT", "--quality draft -q --photons 5k"},
      {"POINTS", "-q --photons 5k --rays 1 --repeats 2 --points"}};
  for (const auto& [word, meaning] : words) {
    for (std::size_t at = 0; (at = command.find(word, at)) != std::string::npos;
         at += meaning.size()) {
      command.replace(at, word.size(), meaning);
    }
  }
  return command;
}

TEST_CASE("on a disk of 64 KB, or 4 KB, every kind of output fails by its name and leaves nothing",
          "[slow]") {
  const FileFolder folder;
  write_box(folder);
  std::filesystem::create_directory(folder / "disk");
  if (run_on_small_disk(folder, "--version").exit_code != 0) {
    skip("this process may mount nothing");
    return;
  }
  REQUIRE(run_photile({"render", folder / "box.obj", "-o", folder / "large.exr", "--photons", "5k",
                       "--size", "200x150", "--quality", "draft"})
              .exit_code == 0);
  std::string points;
  for (int i = 0; i < 3'000; ++i) points += "0.1 -0.9 0.1 0 1 0\n";
  folder.write("many.pts", points);
  folder.write("path.json", R"([{"time": 0, "position": [0, 0, 0.5], "look_at": [0, 0, 0],
    "fov": 60}])");
  const auto [size, command, name] = GENERATE(table<std::string, std::string, std::string>({
      {"64k", "render SCENE DRAFT --size 200x150 -o DISK/a.exr", "a.exr"},
      {"4k", "render SCENE DRAFT --size 200x150 -o DISK/a.png", "a.png"},
      {"64k", "render SCENE DRAFT --size 4x4 --save-maps DISK/a.maps -o NOWHERE.exr", "a.maps"},
      {"64k", "render SCENE -q --photons 5k --size 200x150 -o NOWHERE.exr --errors DISK/e.exr",
       "e.exr"},
      {"4k", "render SCENE DRAFT --size 200x150 -o NOWHERE.exr --illuminance DISK/lux.png",
       "lux.png"},
      {"4k", "render SCENE DRAFT --size 200x150 -o NOWHERE.exr --luminance DISK/cd.png", "cd.png"},
      {"4k", "render SCENE DRAFT --size 200x150 -o NOWHERE.exr --glare DISK/glare.png",
       "glare.png"},
      {"4k", "render SCENE DRAFT --size 4x4 -o NOWHERE.exr --stats DISK/a.json", "a.json"},
      {"64k", "relight LARGE -o DISK/a.exr", "a.exr"},
      {"64k", "measure SCENE POINTS MANY -o DISK/a.csv", "a.csv"},
      {"64k", "measure SCENE POINTS MANY -o DISK/a.json", "a.json"},
      {"64k", "walk SCENE DRAFT --camera-path PATH --size 200x150 -o DISK/frame.#.exr",
       "frame.1.exr"},
      {"64k", "bake SCENE -q --photons 5k --texel 0.02 -o DISK/room.gltf", "room.light00.exr"},
      {"4k", "compare LARGE LARGE -o DISK/c.png", "c.png"},
  }));
  CAPTURE(command);
  const Outcome outcome = run_on_small_disk(folder, filled(command, folder), size);
  CHECK_THAT(last_error(outcome, failure), Catch::Contains("disk/" + name));
  CHECK_THAT(outcome.errors, !Catch::Contains("No such file"));
  CHECK(outcome.output.empty());
}

}  // namespace photile::test
