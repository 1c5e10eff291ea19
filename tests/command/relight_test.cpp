// `photile relight` on pictures of the program's own.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <sstream>

#include "box_scene.hpp"
#include "image/display.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

/// Renders the box to `name` with some more options.
std::string render(const FileFolder& folder, const std::string& name,
                   const std::vector<std::string>& options = {}) {
  succeed(typed("render", write_box(folder), "-o", folder / name,
                "--photons 50k -k 50 --samples 4 --size 24x16 --set light_map_rays=0", options));
  return folder / name;
}

void check_same_root(const std::string& a, const std::string& b, double relative) {
  const Image first = read_image(a), second = read_image(b);
  double brightest = 0;
  for (const char* channel : {"R", "G", "B"}) {
    REQUIRE(first.find(channel) != nullptr);
    REQUIRE(second.find(channel) != nullptr);
    const auto& left = *first.find(channel);
    const auto& right = *second.find(channel);
    REQUIRE(left.size() == right.size());
    for (std::size_t i = 0; i < left.size(); ++i) {
      brightest = std::max(brightest, static_cast<double>(left[i]));
      if (left[i] == Approx(right[i]).epsilon(relative).margin(1e-12)) continue;
      FAIL(channel << " of pixel " << i << ": " << left[i] << " and " << right[i]);
    }
  }
  CHECK(brightest > 0);  // two black pictures would agree as well
}

TEST_CASE("relighting equals rendering with that power up to float rounding") {
  const std::string change = GENERATE("left=x2.5", "left=7", "right=off", "left=1500lm");
  INFO(change);
  const FileFolder folder;
  const std::string original = render(folder, "original.exr");
  const std::string rendered = render(folder, "rendered.exr", {"--light", change});
  succeed({"relight", original, "--light", change, "-o", folder / "relit.exr"});
  check_same_root(folder / "relit.exr", rendered, 4 * std::numeric_limits<float>::epsilon());
}

TEST_CASE("a group of lights is one light of the picture, and its power scales them all") {
  const FileFolder folder;
  const std::string grouped = render(folder, "grouped.exr", {"--light-group", "*=both"});
  CHECK(read_image(grouped).channel_names.size() == 4 + 4);
  CHECK_THAT(run_photile({"relight", grouped}).output, Contains("group: both: "));
  succeed({"relight", grouped, "--light", "both=x2.5", "-o", folder / "relit.exr"});
  const std::string each =
      render(folder, "each.exr", {"--light", "left=x2.5", "--light", "right=x2.5"});
  // 50 photons of each of 4 samples, in another order.
  check_same_root(folder / "relit.exr", each, 2 * (50 + 4 + 10) * std::ldexp(1.0, -24));
}

TEST_CASE("a relit picture can be relit again and comes back to the original") {
  const FileFolder folder;
  const std::string original = render(folder, "original.exr");
  succeed({"relight", original, "--light", "left=x4", "-o", folder / "a.exr"});
  succeed({"relight", folder / "a.exr", "--light", "left=x0.25", "-o", folder / "b.exr"});
  check_same_root(original, folder / "b.exr", 0);  // powers of two are exact
}

TEST_CASE("relight writes a PNG that changes with the exposure") {
  const FileFolder folder;
  const std::string original = render(folder, "a.exr");
  for (const auto& [name, stops] : {std::pair{"dark.png", "-2"}, std::pair{"light.png", "1"}}) {
    succeed({"relight", original, "-o", folder / name, "--exposure", stops});
  }
  const auto mean = [&](const char* name) {
    const Image picture = read_image(folder / name);
    return std::accumulate(picture.find("G")->begin(), picture.find("G")->end(), 0.0);
  };
  CHECK(mean("light.png") > 1.5 * mean("dark.png"));
}

TEST_CASE("a lamp turned up beyond what files hold is told with its name and its pixels") {
  const FileFolder folder;
  const std::string original = render(folder, "original.exr", {"--light", "left=1e29"});
  const Outcome outcome = succeed(
      {"relight", original, "--light", "left=1e30", "--light", "left=x1", "-o", folder / "a.exr"});
  CHECK(outcome.errors.empty());  // a power that floats carry
  CHECK_THAT(
      only_error(run_photile({"relight", original, "--light", "left=x1e9", "-o", folder / "b.exr"}),
                 usage),
      Contains("'left'") && Contains("1e+30"));
  Image bright = read_image(original);
  for (std::vector<float>& plane : bright.channels) {
    for (float& value : plane) value = 3e38f;
  }
  write_exr(folder / "bright.exr", bright);
  const Outcome told =
      succeed({"relight", folder / "bright.exr", "--light", "left=x5", "-o", folder / "c.exr"});
  CHECK_THAT(told.errors, Contains("warning: light 'left': 384 of 384 pixels"));
}

// The white of a set of pictures: found, kept, shown, and asked for.

/// Renders the box with lamps of this light, W/(m2 sr).
std::string render_lit_box(const FileFolder& folder, const std::string& name,
                           const std::string& light, const std::vector<std::string>& options = {}) {
  folder.write("box.mtl", "newmtl wall\nKd 0.7 0.6 0.5\nnewmtl red_lamp\nKd 0 0 0\nKe " + light +
                              "\nnewmtl blue_lamp\nKd 0 0 0\nKe " + light + "\n");
  succeed(typed("render", folder.write("box.obj", box_obj()), "-o", folder / name,
                "--photons 20k --size 16x12 --quality draft", options));
  return folder / name;
}

std::array<double, 3> white_in(const std::string& picture) {
  std::array<double, 3> white{};
  std::istringstream stream(read_header(picture).attributes["photile.white"]);
  for (double& part : white) stream >> part;
  return white;
}

/// Whether a PNG has each pixel of an EXR over the white, by the curve of sRGB.
///   stops   that it was exposed by
void check_shown(const std::string& png, const std::string& exr, const std::array<double, 3>& white,
                 double stops) {
  const Image shown = read_image(png), light = read_image(exr);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const std::string name(1, "RGB"[channel]);
    for (std::size_t pixel = 0; pixel < light.pixels(); ++pixel) {
      const double linear = std::exp2(stops) * double{(*light.find(name))[pixel]} / white[channel];
      REQUIRE(linear < 1);
      const double value = image::srgb_from_linear((*shown.find(name))[pixel]);
      REQUIRE(std::abs(255 * (value - image::srgb_from_linear(linear))) < 0.51);
    }
  }
}

/// The values between 0 and 1 that a PNG holds.
Image shown_values(const std::string& png) {
  Image image = read_image(png);
  for (auto& channel : image.channels) {
    for (float& value : channel) value = static_cast<float>(image::srgb_from_linear(value));
  }
  return image;
}

const std::vector<std::string> as_it_is{
    "--set", "view=standard", "--set", "auto_exposure=off", "--exposure", "-7"};

TEST_CASE("a set of pictures has the white of the lamps as the scene has them") {
  const FileFolder folder;
  // Of luminance 0.2126 x 20 + 0.7152 x 10 + 0.0722 x 5 = 11.765.
  const std::array<double, 3> white{20 / 11.765, 10 / 11.765, 5 / 11.765};
  const auto check_white = [&](const std::string& picture) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      CHECK(white_in(picture)[channel] == Approx(white[channel]).epsilon(1e-5));
    }
  };
  const std::string rendered = render_lit_box(folder, "a.exr", "20 10 5");
  check_white(rendered);
  // No change of a lamp moves it, by whichever command.
  check_white(render_lit_box(folder, "warmer.exr", "20 10 5", {"--light", "*=2000K"}));
  check_white(render_lit_box(folder, "dark.exr", "20 10 5", {"--light", "left=off"}));
  for (const std::string kelvin : {"6500K", "2700K"}) {
    succeed(typed("relight", rendered, "--light", "*=" + kelvin, "-o", folder / (kelvin + ".exr"),
                  "-o", folder / (kelvin + ".png"), as_it_is));
    check_white(folder / (kelvin + ".exr"));
    check_shown(folder / (kelvin + ".png"), folder / (kelvin + ".exr"), white, -7);
  }
  // A relit picture that is relit again is of the set as well.
  succeed(typed("relight", folder / "2700K.exr", "--light", "*=6500K", "-o", folder / "back.png",
                as_it_is));
  CHECK(folder.read("back.png") == folder.read("6500K.png"));
  CHECK(folder.read("2700K.png") != folder.read("6500K.png"));
}

TEST_CASE("a picture that lamps of one colour light is shown as if they were white") {
  const FileFolder folder;
  const auto show = [&](const std::string& light) {
    return shown_values(render_lit_box(folder, "a.png", light, as_it_is));
  };
  const Image warm = show("20 10 5"), plain = show("11.765 11.765 11.765");
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (std::size_t pixel = 0; pixel < plain.pixels(); ++pixel) {
      REQUIRE(255 * std::abs(warm.channels[channel][pixel] - plain.channels[channel][pixel]) < 1.5);
    }
  }
}

TEST_CASE("the white of a colour temperature is that which is asked for, and is kept") {
  const FileFolder folder;
  // A black body of 4000 K: x 0.38045, y 0.37675 (CIE 15), in the primaries of Rec.709.
  const double x = 0.38045 / 0.37675, z = (1 - 0.38045 - 0.37675) / 0.37675;
  const std::array<double, 3> white{3.2406 * x - 1.5372 - 0.4986 * z,
                                    -0.9689 * x + 1.8758 + 0.0415 * z,
                                    0.0557 * x - 0.2040 + 1.0570 * z};
  const std::string rendered = render_lit_box(folder, "a.exr", "20 10 5", {"--white", "4000K"});
  succeed(typed("relight", rendered, "--light", "left=off", "-o", folder / "b.exr", "-o",
                folder / "b.png", as_it_is));
  for (const std::string picture : {"a.exr", "b.exr"}) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      CHECK(white_in(folder / picture)[channel] == Approx(white[channel]).epsilon(2e-3));
    }
  }
  check_shown(folder / "b.png", folder / "b.exr", white_in(folder / "b.exr"), -7);
  // Colours as they are, of the same file.
  succeed(typed("relight", folder / "b.exr", "-o", folder / "off.png", "--set white_balance=off",
                as_it_is));
  check_shown(folder / "off.png", folder / "b.exr", {1, 1, 1}, -7);
}

TEST_CASE("a mood on a sheet has the white of the lamps as rendered, not its own") {
  const FileFolder folder;
  const std::string picture = folder / "a.exr", warm = folder / "warm.exr";
  succeed(typed("render", write_box(folder), "-o", picture,
                "--photons 20k --size 16x12 --quality draft"));
  succeed(typed("relight", picture, "--light left=2700K --light right=2700K -o", warm));
  // The same light twice: by the mood, and in the file.
  folder.write("mood.json", R"({"photile_moods": 1, "moods": {
      "evening": {"left": {"kelvin": 2700}, "right": {"kelvin": 2700}}}})");
  folder.write("cold.json", R"({"photile_moods": 1, "moods": {
      "evening": {"left": {"kelvin": 6500}, "right": {"kelvin": 6500}}}})");
  const auto sheet = [&](const std::string& of, const std::string& moods) {
    succeed(typed("relight", of, "--moods", folder / moods, "--sheet", folder / "sheet.png"));
    return shown_values(folder / "sheet.png");
  };
  const Image by_mood = sheet(picture, "mood.json"), by_file = sheet(warm, "mood.json"),
              cold = sheet(picture, "cold.json");
  float largest = 0;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (std::size_t pixel = 0; pixel < cold.pixels(); ++pixel) {
      const float warmer = by_mood.channels[channel][pixel];
      REQUIRE(255 * std::abs(warmer - by_file.channels[channel][pixel]) < 1.5);
      largest = std::max(largest, std::abs(warmer - cold.channels[channel][pixel]));
    }
  }
  CHECK(largest > 0.1);  // 25 steps of 8 bits: it is seen to be warm
}

}  // namespace
}  // namespace photile::test
