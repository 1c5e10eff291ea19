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
      "--png",  folder / "out.png", "--photons", "20k",
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

TEST_CASE("on a disk of 64 KB, or 4 KB, every kind of output fails by its name and leaves nothing",
          "[slow]") {
  const FileFolder folder;
  const std::string scene = "'" + write_box(folder) + "'";
  std::filesystem::create_directory(folder / "disk");
  if (run_on_small_disk(folder, "--version").exit_code != 0) {
    WARN("skipped: this process may mount nothing");
    return;
  }
  REQUIRE(run_photile({"render", folder / "box.obj", "-o", folder / "large.exr", "--photons", "5k",
                       "--size", "200x150", "--quality", "draft"})
              .exit_code == 0);
  std::string points;
  for (int i = 0; i < 3'000; ++i) points += "0.1 -0.9 0.1 0 1 0\n";
  folder.write("many.pts", points);
  const std::string disk = folder / "disk", large = folder / "large.exr",
                    many = folder / "many.pts", few = " --photons 5k -q ",
                    draft = " --quality draft",
                    tiny = "render " + scene + draft + few + "--size 4x4 -o /dev/shm/a.exr ",
                    measure = "measure " + scene + few + "--rays 1 --repeats 2 --points '" + many +
                              "' -o '" + disk;
  const std::string path = folder.write("path.json", R"([{"time": 0, "position": [0, 0, 0.5],
    "look_at": [0, 0, 0], "fov": 60}])");
  const std::string walk = "walk " + scene + draft + few + "--camera-path '" + path + "' ";
  const std::string view = "render " + scene + draft + few + "--size 200x150 -o /dev/shm/a.exr ";
  const auto [command, name] = GENERATE_COPY(table<std::string, std::string>({
      {"4k " + view + "--illuminance '" + disk + "/lux.png'", "lux.png"},
      {"4k " + view + "--luminance '" + disk + "/cd.png'", "cd.png"},
      {"4k " + view + "--glare '" + disk + "/glare.png'", "glare.png"},
      {"4k " + tiny + "--stats '" + disk + "/a.json'", "a.json"},
      {"4k compare '" + large + "' '" + large + "' -o '" + disk + "/same.png'", "same.png"},
      {"4k " + walk + "--size 40x30 -o /dev/shm/frame.#.exr --contact-sheet '" + disk + "/s.png'",
       "s.png"},
      {"render " + scene + draft + few + "--size 200x150 -o '" + disk + "/a.exr'", "a.exr"},
      {"render " + scene + draft + few + "--size 400x300 -o '" + disk + "/a.png'", "a.png"},
      {"render " + scene + draft + few + "--size 4x4 --save-maps '" + disk +
           "/a.maps' -o /dev/shm/a.exr",
       "a.maps"},
      {"relight '" + large + "' -o '" + disk + "/a.exr'", "a.exr"},
      {measure + "/a.csv'", "a.csv"},
      {measure + "/a.json'", "a.json"},
      {measure + "/a.html'", "a.html"},
      {"render " + scene + few + "--size 200x150 -o /dev/shm/a.exr --errors '" + disk + "/e.exr'",
       "e.exr"},
      {walk + "--size 200x150 -o '" + disk + "/frame.#.exr'", "frame.1.exr"},
      {"bake " + scene + few + "--texel 0.01 -o '" + disk + "/room.gltf'", "room"},
  }));
  CAPTURE(command);
  const bool tiny_disk = command.starts_with("4k ");
  const Outcome outcome = tiny_disk ? run_on_small_disk(folder, command.substr(3), "4k")
                                    : run_on_small_disk(folder, command);
  CHECK_THAT(last_error(outcome, failure), Catch::Contains(name));
  CHECK(outcome.output.empty());
  for (const char* other : {"/dev/shm/a.exr", "/dev/shm/frame.1.exr"}) {
    std::filesystem::remove(other);
  }
}

}  // namespace photile::test
