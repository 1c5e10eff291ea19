// `photile render --save-maps` and `--load-maps`.
#include <catch2/catch.hpp>
#include <filesystem>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

std::vector<std::string> arguments_of(const FileFolder& folder, const std::string& name,
                                      const std::vector<std::string>& more) {
  std::vector<std::string> arguments{
      "render", write_box(folder), "-o",      folder / name, "--photons", "20k",
      "--size", "24x16",           "--quiet", "--quality",   "draft"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace

TEST_CASE("saved photons give the picture again, in other powers and sizes as well") {
  const FileFolder folder;
  const std::string maps = folder / "box.maps";
  const auto [option, value] = GENERATE(table<std::string, std::string>(
      {{"--set", "light_maps=auto"}, {"--set", "light_maps=off"}, {"--set", "light_map_rays=8"}}));
  const auto render = [&](const std::string& name, std::vector<std::string> more) {
    more.insert(more.end(), {option, value});
    return run_photile(arguments_of(folder, name, more));
  };
  REQUIRE(render("a.exr", {"--save-maps", maps}).exit_code == 0);
  REQUIRE(std::filesystem::exists(maps));
  const Outcome loaded = render("b.exr", {"--load-maps", maps});
  INFO(loaded.errors);
  REQUIRE(loaded.exit_code == 0);
  REQUIRE(render("c.exr", {}).exit_code == 0);
  const Image a = read_image(folder / "a.exr");
  CHECK(a.channels == read_image(folder / "b.exr").channels);
  CHECK(a.channels == read_image(folder / "c.exr").channels);
  CHECK(render("d.exr", {"--load-maps", maps, "--light", "left=x2", "--samples", "1"}).exit_code ==
        0);
}

TEST_CASE("rays that gather refuse saved photons without caustics, and say what to do") {
  const FileFolder folder;
  const std::string maps = folder / "box.maps";
  REQUIRE(run_photile(arguments_of(folder, "a.exr", {"--save-maps", maps})).exit_code == 0);
  const Outcome outcome = run_photile(
      arguments_of(folder, "b.exr", {"--load-maps", maps, "--set", "light_map_rays=4"}));
  CHECK_THAT(only_error(outcome, 2), Contains("light_map_rays") && Contains("save them again"));
}

TEST_CASE("photons of other settings or scenes, and broken files, are refused by name") {
  const FileFolder folder;
  const std::string maps = folder / "box.maps";
  REQUIRE(run_photile(arguments_of(folder, "a.exr", {"--save-maps", maps})).exit_code == 0);
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

}  // namespace photile::test
