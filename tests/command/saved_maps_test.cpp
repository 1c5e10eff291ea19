// Photons between runs, and frames of several processes.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

// `photile render --save-maps` and `--load-maps`.

std::vector<std::string> arguments_of(const FileFolder& folder, const std::string& name,
                                      const std::vector<std::string>& more) {
  return typed("render", write_box(folder), "-o", folder / name,
               "--photons 20k --size 24x16 --quiet --quality draft", more);
}

TEST_CASE("saved photons give the picture again, in other powers and sizes as well") {
  const FileFolder folder;
  const std::string maps = folder / "box.maps";
  const auto [option, value] = GENERATE(table<std::string, std::string>(
      {{"--set", "light_map_rays=0"}, {"--set", "light_maps=off"}, {"--set", "light_map_rays=8"}}));
  const auto render = [&](const std::string& name, std::vector<std::string> more) {
    more.insert(more.end(), {option, value});
    return succeed(arguments_of(folder, name, more));
  };
  render("a.exr", {"--save-maps", maps});
  REQUIRE(std::filesystem::exists(maps));
  const Outcome loaded = render("b.exr", {"--load-maps", maps});
  render("c.exr", {});
  const Image a = read_image(folder / "a.exr");
  CHECK(a.channels == read_image(folder / "b.exr").channels);
  CHECK(a.channels == read_image(folder / "c.exr").channels);
  CHECK(render("d.exr", {"--load-maps", maps, "--light", "left=x2", "--samples", "1"}).exit_code ==
        0);
}

TEST_CASE("rays that gather refuse saved photons without caustics, and say what to do") {
  const FileFolder folder;
  const std::string maps = folder / "box.maps";
  succeed(arguments_of(folder, "a.exr", {"--save-maps", maps, "--set", "light_map_rays=0"}));
  const Outcome outcome = run_photile(
      arguments_of(folder, "b.exr", {"--load-maps", maps, "--set", "light_map_rays=4"}));
  CHECK_THAT(only_error(outcome, 2), Contains("light_map_rays") && Contains("save them again"));
}

TEST_CASE("photons of other settings or scenes, and broken files, are refused by name") {
  const FileFolder folder;
  const std::string maps = folder / "box.maps";
  succeed(arguments_of(folder, "a.exr", {"--save-maps", maps}));
  CHECK_THAT(
      only_error(run_photile(arguments_of(folder, "b.exr", {"--load-maps", maps, "--seed", "2"})),
                 3),
      Contains("seed 1") && Contains("seed 2"));
  CHECK_THAT(
      only_error(run_photile(arguments_of(folder, "b.exr", {"--load-maps", folder / "none"})), 3),
      Contains("none"));
  CHECK_THAT(only_error(run_photile(arguments_of(
                            folder, "b.exr", {"--load-maps", folder.write("x.maps", "photons")})),
                        3),
             Contains("x.maps") && Contains("no photon maps"));
  CHECK_THAT(
      only_error(run_photile(arguments_of(folder, "b.exr", {"--load-maps", "/dev/null"})), 3),
      Contains("/dev/null: is not a regular file"));
  CHECK_THAT(only_error(run_photile(arguments_of(folder, "b.exr",
                                                 {"--save-maps", maps, "--integrator", "path"})),
                        2),
             Contains("photon"));
  CHECK_FALSE(std::filesystem::exists(folder / "b.exr"));
}

// `photile trace`, and frames that several processes share.

/// `photile trace` of the box, to a file of the folder.
std::vector<std::string> trace(const FileFolder& folder, const std::string& file,
                               const std::vector<std::string>& more = {}) {
  return typed("trace", write_box(folder), "-o", folder / file, "--photons 20k -q", more);
}

TEST_CASE("traced photons render the picture of their scene, with any settings of groups") {
  const FileFolder folder;
  succeed(trace(folder, "all.photons"));
  const auto render = [&](const std::string& picture, const std::vector<std::string>& more) {
    return typed("render", write_box(folder), "-o", folder / picture,
                 "--photons 20k -q --size 24x16 --samples 1", more);
  };
  succeed(render("own.exr", {}));
  succeed(render("loaded.exr", {"--load-maps", folder / "all.photons"}));
  CHECK(read_image(folder / "own.exr").channels == read_image(folder / "loaded.exr").channels);
  succeed(render("wide.exr", {"--set", "radius=0.3", "--load-maps", folder / "all.photons"}));
  const std::string other = only_error(
      run_photile(render("seed.exr", {"--seed", "5", "--load-maps", folder / "all.photons"})), 3);
  CHECK_THAT(other, Contains("seed 1") && Contains("seed 5"));
}

TEST_CASE("frames that several processes make are those of one, with its exposure") {
  const FileFolder one, several;
  const auto walk = [](const FileFolder& folder, const std::vector<std::string>& more) {
    const std::string path = folder.write("path.json", R"([
        {"time": 0, "position": [0, 0, 0.9], "look_at": [0, 0, -1], "fov": 60},
        {"time": 1, "position": [0.5, 0, 0.2], "look_at": [0, 0, -1], "fov": 60}])");
    return typed("walk", write_box(folder), "-o", folder / "f.##.exr", "--png", folder / "f.##.png",
                 "--fps 4 --quality draft --photons 20k --size 16x12 --camera-path", path, more);
  };
  succeed(walk(one, {}));
  succeed(walk(several, {"--frames", "2-4x2"}));
  CHECK_FALSE(std::filesystem::exists(several / "f.01.exr"));
  CHECK_FALSE(std::filesystem::exists(several / "f.03.png"));
  CHECK_THAT(succeed(walk(several, {"--frames", "3-5"})).errors,
             Contains("1 of 3 frames are finished"));  // 3, 4 and 5
  CHECK_FALSE(std::filesystem::exists(several / "f.01.exr"));
  succeed(walk(several, {"--frames", "1-2"}));
  for (int frame = 1; frame <= 5; ++frame) {
    CAPTURE(frame);
    const std::string name = fmt::format("f.{:02}", frame);
    CHECK(several.read(name + ".png") == one.read(name + ".png"));
    CHECK(read_image(several / (name + ".exr")).channels ==
          read_image(one / (name + ".exr")).channels);
  }
  CHECK_THAT(last_error(run_photile(walk(several, {"--frames", "7-9"})), 2),
             Contains("--frames") && Contains("1 to 5"));
  CHECK_THAT(only_error(run_photile(walk(several, {"--frames", "4-2"})), 2), Contains("A-BxS"));
  CHECK_THAT(
      only_error(
          run_photile(walk(several, {"--frames", "1-2", "--contact-sheet", several / "sheet.png"})),
          2),
      Contains("--contact-sheet"));
}

}  // namespace
}  // namespace photile::test
