// Frames of a walk.
#include "walk/frames.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "photile/defaults.hpp"
#include "photile/errors.hpp"
#include "photile/renderer.hpp"
#include "render/pictures.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using walk::ContactSheet;
using walk::FrameNames;

// Names of numbered frames.

TEST_CASE("hashes and printf's numbers become frame numbers, as wide as they say at least") {
  const auto [pattern, frame, name] = GENERATE(table<std::string, int, std::string>({
      {"frame.####.exr", 7, "frame.0007.exr"},
      {"frame.####.exr", 123456, "frame.123456.exr"},
      {"#.exr", 12, "12.exr"},
      {"a%04d.exr", 7, "a0007.exr"},
      {"a%d.exr", 7, "a7.exr"},
      {"a%3d.exr", 7, "a  7.exr"},
      {"a%09d.exr", 7, "a000000007.exr"},
      {"a%%0d.exr", 7, "a%7.exr"},
      {"c#/b##.exr", 3, "c#/b03.exr"},
      {"out/walk.png", 3, "out/walk.0003.png"},
      {"walk", 3, "walk.0003"},
  }));
  CHECK(FrameNames(pattern).of(frame).string() == name);
}

TEST_CASE("a place of any width takes no more stack than another") {
  const std::string hashes(200'000, '#');
  CHECK(FrameNames(hashes + ".exr").of(7).string() == std::string(199'999, '0') + "7.exr");
}

TEST_CASE("a name with two places for the number, or a wrong one, is refused") {
  const std::string pattern =
      GENERATE("##-##.exr", "a%d#.exr", "####/frame.exr", "%s.exr", "%0", "%00d", "%12d");
  INFO(pattern);
  CHECK_THROWS_AS(FrameNames(pattern), UsageError);
}

// Ranges of frames as render farms write them.

TEST_CASE("a range of frames is one, all between two, or every so many of them") {
  const auto [text, numbers] = GENERATE(table<std::string, std::vector<int>>({
      {"7", {7}},
      {"0", {0}},
      {"3-6", {3, 4, 5, 6}},
      {"3-3", {3}},
      {"1-10x4", {1, 5, 9}},
  }));
  const auto range = walk::parse_frame_range(text);
  REQUIRE(range);
  std::vector<int> found;
  for (int number = 0; number < 20; ++number) {
    if (range->contains(number)) found.push_back(number);
  }
  CHECK(found == numbers);
}

TEST_CASE("what is no range of frames is none") {
  const std::string text =
      GENERATE("", "-", "-3", "3-", "6-3", "1-4x0", "1-4x", "1-4x-1", "a", "1 - 4", "1-4x2x2",
               "1.5", "99999999999", "1-99999999999", "+1");
  CAPTURE(text);
  CHECK_FALSE(walk::parse_frame_range(text));
}

// Frames on a contact sheet, each in its place.

constexpr int gap = 4;

/// Red on its left half and black on the right; green all over.
Image frame(int width, int height, float red, float green) {
  Image image;
  image.width = width;
  image.height = height;
  for (const char* channel : {"R", "G", "B"}) image.add(channel);
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    const bool left = static_cast<int>(i) % width < width / 2;
    image.channels[0][i] = left ? red : 0;
    image.channels[1][i] = green;
  }
  return image;
}

float at(const Image& sheet, const char* channel, int x, int y) {
  return (*sheet.find(channel))[static_cast<std::size_t>(y * sheet.width + x)];
}

TEST_CASE("frames lie from left to right and from top to bottom, the rest of the sheet is grey") {
  constexpr int width = 6, height = 4;
  ContactSheet sheet(5, width, height);  // 3 columns, 2 rows
  for (int i = 0; i < 5; ++i) sheet.add(i, frame(width, height, 0.5f, 0.1f * float(i + 1)));
  const Image& image = sheet.image();
  CHECK(image.width == 3 * width + 4 * gap);
  CHECK(image.height == 2 * height + 3 * gap);
  for (int i = 0; i < 5; ++i) {
    INFO("frame " << i);
    const int left = gap + i % 3 * (width + gap), top = gap + i / 3 * (height + gap);
    CHECK(at(image, "G", left, top) == Approx(0.1 * (i + 1)));
    CHECK(at(image, "G", left + width - 1, top + height - 1) == Approx(0.1 * (i + 1)));
    CHECK(at(image, "R", left + 2, top) == 0.5f);
    CHECK(at(image, "R", left + 3, top) == 0.0f);
    CHECK(at(image, "G", left - 1, top) == at(image, "G", 0, 0));
  }
  const int sixth = gap + 2 * (width + gap);
  CHECK(at(image, "G", sixth, gap + height + gap) == at(image, "G", 0, 0));
}

TEST_CASE("of more frames than a sheet holds it shows as many as it holds, at even distances") {
  const auto [count, most] = GENERATE(table<int, int>({{3, 5}, {5, 5}, {6, 5}, {9, 5}, {1000, 7}}));
  CAPTURE(count, most);
  std::vector<int> shown;
  for (int frame = 0; frame < count; ++frame) {
    const int place = walk::place_on_sheet(frame, count, most);
    if (place < 0) continue;
    CHECK(place == static_cast<int>(shown.size()));
    shown.push_back(frame);
  }
  REQUIRE(shown.size() == static_cast<std::size_t>(std::min(count, most)));
  CHECK(shown.front() == 0);
  shown.push_back(count);
  const double even = std::max(1.0, double(count) / most);
  for (std::size_t i = 1; i < shown.size(); ++i) {
    CHECK(std::abs(shown[i] - shown[i - 1] - even) < 1);
  }
}

TEST_CASE("large frames are drawn small, as the means of their pixels") {
  constexpr int small = defaults::contact_sheet_width;
  ContactSheet sheet(1, 4 * small, 4 * 100);
  Image stripes = frame(4 * small, 4 * 100, 0, 0);
  for (std::size_t i = 0; i < stripes.pixels(); i += 2) stripes.channels[2][i] = 1;
  sheet.add(0, stripes);
  CHECK(sheet.image().width == small + 2 * gap);
  CHECK(sheet.image().height == 100 + 2 * gap);
  for (const int x : {0, 100, small - 1}) {
    CHECK(at(sheet.image(), "B", gap + x, gap + 50) == Approx(0.5));
  }
}

// Many pictures from one set of maps are those of one rendering each.

RenderParameters small() { return small_picture(20'000, 24, 16); }

TEST_CASE("each picture is the one that render gives, bit for bit, of several passes as well") {
  const Scene scene = test::furnished_room();
  RenderParameters parameters = small();
  parameters.passes = GENERATE(1, 3);
  std::span<Device> devices(&test::device(), 1);
  SceneRenderer renderer(scene, devices, parameters);
  for (const double x : {0.5, 2.0, 0.5}) {
    const Camera camera = Camera::look_at({x, 0.3, 1.5}, {2, 2, 0.5}, {0, 0, 1}, 1.0);
    const RenderResult kept = renderer.render(camera, parameters.film);
    const RenderResult once = render(scene, camera, devices, parameters);
    REQUIRE(kept.layers.layers.size() == 2);
    CHECK(test::same_bits(kept.layers, once.layers));
    CHECK(kept.used.radius == once.used.radius);
    CHECK(kept.stored_photons == once.stored_photons);
  }
}

TEST_CASE("light maps of several passes are refused") {
  const Scene scene = test::furnished_room();
  RenderParameters parameters = small();
  parameters.passes = 3;
  parameters.light_maps = LightMapMode::on;
  std::span<Device> devices(&test::device(), 1);
  CHECK_THROWS_WITH(SceneRenderer(scene, devices, parameters),
                    Catch::Contains("one photon pass") && Catch::Contains("there are 3"));
}

}  // namespace
}  // namespace photile::test
