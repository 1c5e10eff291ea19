// `photile walk`: frames, their names, and what a second run leaves alone.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>

#include "box_scene.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

constexpr const char* path = R"([
    {"time": 0, "position": [0, 0, 0.9], "look_at": [0, 0, -1], "fov": 60},
    {"time": 1, "position": [0.5, 0, 0.9], "look_at": [0, 0, -1], "fov": 60}])";

std::vector<std::string> walk(const FileFolder& folder, const std::vector<std::string>& more = {},
                              const std::string& frames_per_second = "3") {
  return typed("walk", write_box(folder), "-o", folder / "f.##.exr", "--fps", frames_per_second,
               "--quality draft --photons 20k --size 16x12 --camera-path",
               folder.write("path.json", path), more);
}

std::filesystem::file_time_type written(const std::string& file) {
  return std::filesystem::last_write_time(file);
}

}  // namespace

TEST_CASE("a walk writes its frames, PNGs and a contact sheet, and again only those that lack") {
  const FileFolder folder;
  const std::vector<std::string> arguments =
      walk(folder, {"--png", folder / "f.##.png", "--contact-sheet", folder / "sheet.png"});
  succeed(arguments);
  for (const char* name : {"f.01.exr", "f.02.exr", "f.03.exr", "f.04.exr", "f.04.png"}) {
    CHECK(std::filesystem::exists(folder / name));
  }
  CHECK_FALSE(std::filesystem::exists(folder / "f.05.exr"));
  CHECK(folder.read("f.01.exr") != folder.read("f.04.exr"));
  const Image sheet = read_image(folder / "sheet.png");
  CHECK(sheet.width == 2 * 16 + 3 * 4);
  CHECK(sheet.height == 2 * 12 + 3 * 4);

  const std::string third = folder.read("f.03.exr"), component_bytes = folder.read("sheet.png");
  const auto first_written = written(folder / "f.01.exr");
  std::filesystem::remove(folder / "f.03.exr");
  folder.write("f.04.exr", "no picture");
  const Outcome again = succeed(arguments);
  CHECK_THAT(again.errors, Contains("2 of 4 frames are already finished"));
  CHECK(written(folder / "f.01.exr") == first_written);
  CHECK(folder.read("sheet.png") == component_bytes);
  const Image now = read_image(folder / "f.03.exr");
  folder.write("before.exr", third);
  CHECK(*now.find("G") == *read_image(folder / "before.exr").find("G"));
  CHECK_THAT(succeed(arguments).errors, Contains("4 of 4 frames are already finished"));
}

TEST_CASE("damaged frames and PNGs of a walk are made again, and no others") {
  const FileFolder folder;
  const std::vector<std::string> arguments = walk(folder, {"--png", folder / "f.##.png"});
  succeed(arguments);
  const std::string second = folder.read("f.02.exr"), third = folder.read("f.03.exr"),
                    png = folder.read("f.04.png");
  folder.write("f.02.exr", second.substr(0, second.size() / 2));
  std::string flipped = third;
  flipped[third.size() - 100] = static_cast<char>(~flipped[third.size() - 100]);
  folder.write("f.03.exr", flipped);
  folder.write("f.04.png", png.substr(0, png.size() / 2));
  const auto first_written = written(folder / "f.01.exr"),
             last_written = written(folder / "f.04.exr");
  CHECK_THAT(succeed(arguments).errors, Contains("2 of 4 frames are already finished"));
  CHECK(written(folder / "f.01.exr") == first_written);
  CHECK(written(folder / "f.04.exr") == last_written);
  folder.write("whole.exr", second);
  CHECK(*read_image(folder / "f.02.exr").find("G") == *read_image(folder / "whole.exr").find("G"));
  CHECK(read_image(folder / "f.03.exr").width == 16);
  CHECK(folder.read("f.04.png") == png);
}

TEST_CASE("a walk that is killed keeps its whole frames, and loses the one in progress at most") {
  constexpr std::size_t frames = 201;
  const FileFolder folder;
  const auto file = [&](std::size_t number) { return folder / fmt::format("f.{:02}.exr", number); };
  const Run run{.arguments = walk(folder, {}, std::to_string(frames - 1)),
                .terminal = true,
                .signal_when = "frames/s",  // the bar, after the first frame
                .signal = SIGKILL};
  CHECK(run_photile(run).exit_code == 128 + SIGKILL);
  std::size_t finished = 0;
  while (std::filesystem::exists(file(finished + 1))) {
    CHECK(read_image(file(++finished)).width == 16);  // whole
  }
  REQUIRE(finished >= 1);
  REQUIRE(finished < frames);
  for (std::size_t number = finished + 1; number <= frames; ++number) {
    CHECK_FALSE(std::filesystem::exists(file(number)));
  }
  const auto first_written = written(file(1)), last_written = written(file(finished));
  CHECK_THAT(succeed(run.arguments).errors,
             Contains(fmt::format("{} of {} frames are already finished", finished, frames)));
  CHECK(written(file(1)) == first_written);
  CHECK(written(file(finished)) == last_written);
  CHECK(read_image(file(frames)).width == 16);
}

TEST_CASE("frames of other settings are not taken for finished") {
  const FileFolder folder;
  succeed(walk(folder));
  const std::string change = GENERATE("--seed=2", "--neighbours=40", "--light=left=x2",
                                      "--set=radius=0.3", "--samples=2", "--set=quota=equal");
  INFO(change);
  CHECK_THAT(succeed(walk(folder, {change})).errors, !Contains("finished"));
}

TEST_CASE("a frame has the layers and the attributes of any picture, and its own camera") {
  const FileFolder folder;
  succeed(walk(folder));
  const Image first = read_image(folder / "f.01.exr"), last = read_image(folder / "f.04.exr");
  CHECK(first.find("Combined_left.R") != nullptr);
  CHECK(first.find("Illuminance_right.Y") != nullptr);
  CHECK(first.attributes.at("photile.scene") == "box.obj");
  CHECK(first.attributes.at("photile.settings") != last.attributes.at("photile.settings"));
  CHECK(first.matrices.at("worldToCamera") != last.matrices.at("worldToCamera"));
}

TEST_CASE(
    "quick frames are light maps alone, and the same bytes wherever the camera stands still") {
  const FileFolder folder;
  const std::string still = R"({"interpolation": "linear", "keyframes": [
      {"time": 0, "position": [0, 0, 0.9], "look_at": [0, 0, -1], "fov": 60},
      {"time": 1, "position": [0, 0, 0.9], "look_at": [0, 0, -1], "fov": 60},
      {"time": 2, "position": [0.3, 0, 0.9], "look_at": [0, 0, -1], "fov": 60}]})";
  succeed(typed("walk", write_box(folder), "-o", folder / "q.##.png",
                "--fps 2 --quality draft --photons 20k --size 16x12 --quick --camera-path",
                folder.write("still.json", still)));
  CHECK(folder.read("q.01.png") == folder.read("q.02.png"));
  CHECK(folder.read("q.01.png") != folder.read("q.05.png"));
  CHECK_FALSE(std::filesystem::exists(folder / "q.01.exr"));
}

TEST_CASE("quick frames as EXR hold R, G, B, and are not made twice") {
  const FileFolder folder;
  succeed(walk(folder, {"--quick"}));
  const Image frame = read_image(folder / "f.01.exr");
  CHECK(frame.channel_names == std::vector<std::string>{"R", "G", "B"});
  CHECK(frame.attributes.at("photile.scene") == "box.obj");
  const std::vector<float>& green = *frame.find("G");
  CHECK(*std::min_element(green.begin(), green.end()) > 0);
  CHECK_THAT(succeed(walk(folder, {"--quick"})).errors,
             Contains("4 of 4 frames are already finished"));
  CHECK_THAT(succeed(walk(folder)).errors, !Contains("finished"));
}

TEST_CASE("a walk from saved maps draws the same frames, without a photon") {
  const FileFolder folder;
  const std::string maps = folder / "box.maps";
  const std::vector<std::string> rays{"--quick", "--set", "light_map_rays=4"};
  const auto frames = [&](const std::string& option) {
    succeed(typed(walk(folder, rays), option, maps));
    std::vector<Image> images;
    for (const char* name : {"f.01.exr", "f.04.exr"}) {
      images.push_back(read_image(folder / name));
      std::filesystem::remove(folder / name);
    }
    return images;
  };
  const std::vector<Image> saved = frames("--save-maps");
  const std::vector<Image> loaded = frames("--load-maps");
  for (std::size_t i = 0; i < saved.size(); ++i) CHECK(saved[i].channels == loaded[i].channels);
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
             Contains("1 of 3 frames are already finished"));  // 3, 4 and 5
  CHECK_FALSE(std::filesystem::exists(several / "f.01.exr"));
  succeed(walk(several, {"--frames", "1-2"}));
  for (int frame = 1; frame <= 5; ++frame) {
    CAPTURE(frame);
    const std::string name = fmt::format("f.{:02}", frame);
    CHECK(several.read(name + ".png") == one.read(name + ".png"));
    CHECK(read_image(several / (name + ".exr")).channels ==
          read_image(one / (name + ".exr")).channels);
  }
}

}  // namespace photile::test
