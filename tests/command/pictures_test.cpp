// Pictures on the command line: compared, in false colours, and loaded by OpenImageIO.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "box_scene.hpp"
#include "flat_picture.hpp"
#include "image/display.hpp"
#include "photile/layered_picture.hpp"
#include "report/palette.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

// `photile compare`: figures, layers and the picture.

std::string render_box(const FileFolder& folder, const std::string& name,
                       const std::vector<std::string>& options = {},
                       const std::string& size = "32x32") {
  succeed(typed("render", write_box(folder), "-o", folder / name, "--photons 20k --size", size,
                "--quality draft", options));
  return folder / name;
}

nlohmann::json compare(const FileFolder& folder, const std::string& a, const std::string& b) {
  const Outcome outcome =
      succeed({"compare", a, b, "-o", folder / "compared.png", "--json", folder / "compared.json"});
  CHECK_THAT(outcome.output, Contains("left"));
  return folder.json("compared.json");
}

TEST_CASE("equal pictures are equal files, wherever they are written") {
  const FileFolder folder;
  std::filesystem::create_directory(folder / "elsewhere");
  render_box(folder, "a.exr");
  render_box(folder, "elsewhere/b.exr");
  CHECK(folder.read("a.exr") == folder.read("elsewhere/b.exr"));
}

TEST_CASE("a picture is equal to itself, and the drawing shows both and no difference") {
  const FileFolder folder;
  const std::string picture = render_box(folder, "a.exr");
  const auto record = compare(folder, picture, picture);
  CHECK(record["picture"]["relative_mse"] == 0);
  CHECK(record["picture"]["mean_ratio"] == Approx(1));
  CHECK(record["picture"]["psnr"].is_null());
  REQUIRE(record["layers"].size() == 2);

  const Image drawing = read_image(folder / "compared.png");
  CHECK(drawing.width > 3 * 32);
  const auto& red = *drawing.find("R");
  const auto& blue = *drawing.find("B");
  const auto at = [&](int x, int y) { return static_cast<std::size_t>(y * drawing.width + x); };
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const std::size_t first = at(x, 24 + y), second = at(44 + x, 24 + y),
                        difference = at(88 + x, 24 + y);
      CHECK(red[first] == red[second]);
      CHECK(red[difference] > 0.98f);  // white: neither red nor blue
      CHECK(blue[difference] > 0.98f);
    }
  }
}

TEST_CASE("a light that was doubled doubles its layer, and no other") {
  const FileFolder folder;
  const auto record = compare(folder, render_box(folder, "a.exr", {"--light", "left=x2"}),
                              render_box(folder, "b.exr"));
  CHECK(record["layers"][0]["light"] == "left");
  CHECK(record["layers"][0]["mean_ratio"] == Approx(2).epsilon(1e-6));
  CHECK(record["layers"][0]["worst_region"] == Approx(1).epsilon(1e-5));
  CHECK(record["layers"][1]["relative_mse"] == 0);
  const double ratio = record["picture"]["mean_ratio"];
  CHECK(ratio > 1);
  CHECK(ratio < 2);
}

TEST_CASE("a lamp that is off in the second, or a layer in one picture alone, is told") {
  const FileFolder folder;
  const std::string whole = render_box(folder, "a.exr");
  const Outcome off =
      succeed({"compare", whole, render_box(folder, "b.exr", {"--light", "left=off"})});
  CHECK_THAT(off.output, Contains("luminance, mean") && Contains("lux") && Contains("ratio") &&
                             Contains("0 W") && !Contains("error"));
  const Outcome grouped =
      succeed({"compare", whole, render_box(folder, "c.exr", {"--light-group", "*=both"})});
  CHECK_THAT(grouped.output,
             Contains("left: only in the first") && Contains("both: only in the second"));
}

TEST_CASE("two moods of a picture are compared by their levels") {
  const FileFolder folder;
  const std::string picture = render_box(folder, "a.exr");
  const std::string moods = folder.write("a.moods.json", R"({"photile_moods": 1, "moods": {
      "bright": {"left": {"power": 20, "unit": "W"}, "right": {"power": 0, "unit": "W", "on": false}},
      "half": {"left": {"power": 10, "unit": "W"}, "right": {"power": 5, "unit": "W", "on": false}}}})");
  const std::vector<std::string> two = typed("compare", picture, "--mood bright --mood half --json",
                                             folder / "levels.json", "-o", folder / "two.png");
  const Outcome outcome = succeed(two);  // the file beside the picture
  const auto record = folder.json("levels.json");
  CHECK(record["first"] == "bright");
  REQUIRE(record["levels"].size() == 6);
  for (const auto& level : record["levels"]) {
    CHECK(level["first"].get<double>() == Approx(2 * level["second"].get<double>()).epsilon(1e-5));
  }
  CHECK(record["powers"][0]["first"] == 20);
  CHECK(record["powers"][1]["second"] == 0);
}

TEST_CASE("moods are put on one sheet with one exposure") {
  const FileFolder folder;
  const std::string picture = render_box(folder, "a.exr", {}, "128x128");
  folder.write("a.moods.json", R"({"photile_moods": 1, "moods": {
      "bright": {"left": {"power": 20, "unit": "W"}, "right": {"on": false}},
      "dim": {"left": {"power": 5, "unit": "W"}, "right": {"on": false}}}})");
  succeed({"relight", picture, "--sheet", folder / "all.png", "--set", "view=standard",
           "--exposure", "-2"});
  const Image sheet = read_image(folder / "all.png");
  const Image one = read_image(picture);
  CHECK(sheet.width > 2 * one.width);
  CHECK(sheet.height < 2 * one.height);
  // Walls of both, away from their names: as bright as their powers.
  const auto& shown = *sheet.find("R");
  const int gap = (sheet.width - 2 * one.width) / 3;
  int compared = 0;
  for (int y = 10; y < 90; ++y) {
    for (int x = 10; x < one.width; ++x) {
      const auto at = static_cast<std::size_t>(y * sheet.width + x);
      const auto beside = at + static_cast<std::size_t>(one.width + gap);
      const double bright = static_cast<double>(shown[at]);
      const double dim = static_cast<double>(shown[beside]);
      if (bright > 0.9 || bright < 0.1) continue;
      CHECK(bright == Approx(4 * dim).epsilon(0.05));  // of 8 bits
      ++compared;
    }
  }
  CHECK(compared > 100);
  succeed({"relight", picture, "--mood", "dim", "--mood", "bright", "--mood", "dim", "--sheet",
           folder / "three.png"});
  CHECK(read_image(folder / "three.png").height > 2 * one.height);
}

TEST_CASE("layers of 11 bits are near to those of 24, in less room, and lossy ones in less still") {
  const FileFolder folder;
  const std::string whole = render_box(folder, "a.exr");
  const auto written = [&](const std::string& how) {
    succeed({"relight", whole, "--set", "exr=" + how, "-o", folder / (how + ".exr")});
    return read_image(folder / (how + ".exr"));
  };
  const Image exact = read_image(whole);
  CHECK(written("float").channels == exact.channels);
  const Image half = written("half");
  CHECK(*half.find("G") == *exact.find("G"));  // the root keeps all
  const std::vector<float>&a = *exact.find("Combined_left.G"), &b = *half.find("Combined_left.G");
  CHECK(a != b);
  for (std::size_t i = 0; i < a.size(); ++i) REQUIRE(b[i] == Approx(a[i]).epsilon(1.0 / 2048));
  const Image lossy = written("dwaa");
  for (std::size_t i = 0; i < a.size(); ++i) {
    REQUIRE((*lossy.find("Combined_left.G"))[i] == Approx(a[i]).epsilon(0.2).margin(1));
  }
  const auto size = [&](const char* name) {
    return static_cast<double>(std::filesystem::file_size(folder / name));
  };
  CHECK(size("half.exr") < 0.8 * size("float.exr"));
  CHECK(size("dwaa.exr") < size("half.exr"));
}

TEST_CASE("a sky of patches is one line of the lights") {
  const FileFolder folder;
  const std::string picture = render_box(folder, "a.exr", {"--sky", "patches=145"});
  const std::string listed = succeed({"relight", picture}).output;
  CHECK_THAT(listed, Contains("sky: 145 patches and the ground, a light each") &&
                         Contains("light: left") && !Contains("light: sky"));
  CHECK(std::count(listed.begin(), listed.end(), '\n') == 3);
}

TEST_CASE("a mood is the same in render, relight and measure as its powers by --light") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  folder.write("box.moods.json", R"({"photile_moods": 1, "moods": {"night": {
      "left": {"power": 3, "unit": "W"}, "right": {"power": 9, "unit": "W", "on": false}}}})");
  const std::vector<std::string> plain{"--light", "left=3", "--light", "right=off"};
  const std::string by_mood = render_box(folder, "mood.exr", {"--mood", "night"});
  const std::string by_light = render_box(folder, "light.exr", plain);
  CHECK(read_image(by_mood).channels == read_image(by_light).channels);
  const std::string whole = render_box(folder, "whole.exr");
  succeed({"relight", whole, "--mood", "night", "-o", folder / "night.exr"});
  const Image relit = read_image(folder / "night.exr"), rendered = read_image(by_light);
  for (std::size_t i = 0; i < rendered.pixels(); ++i) {
    REQUIRE((*relit.find("G"))[i] == Approx((*rendered.find("G"))[i]).epsilon(1e-5));
  }
  const auto measured = [&](const std::vector<std::string>& options) {
    return succeed(
               typed("measure", scene, "--plane 1 --rays 16 --photons 10k --repeats 2 -q", options))
        .output;
  };
  CHECK(measured({"--mood", "night"}) == measured(plain));
  // --light goes on from a mood.
  const std::string dimmer =
      render_box(folder, "d.exr", {"--mood", "night", "--light", "left=x0.5"});
  CHECK((*read_image(dimmer).find("G"))[500] ==
        Approx(0.5 * (*read_image(by_light).find("G"))[500]).epsilon(1e-5));
}

TEST_CASE("pictures are compared as the light that their files say they are") {
  const FileFolder folder;
  const auto write = [&](const std::string& name, float value, float white) {
    Image image = flat_picture(8, 8, value);
    if (white > 0) image.numbers["whiteLuminance"] = white;
    write_exr(folder / name, image);
    return folder / name;
  };
  const auto mean_ratio = [&](const std::string& a, const std::string& b) {
    succeed({"compare", a, b, "--json", folder / "compared.json"});
    return folder.json("compared.json")["picture"]["mean_ratio"].get<double>();
  };
  std::string radiance = "#?RADIANCE\nEXPOSURE=4\nFORMAT=32-bit_rle_rgbe\n\n+X 8 +Y 8\n";
  for (int i = 0; i < 64; ++i) radiance += "\x80\x80\x80\x82";  // 2
  folder.write("a.hdr", radiance);
  const std::string half = write("half.exr", 0.5f, 0);
  CHECK(mean_ratio(folder / "a.hdr", half) == Approx(1));
  // 50 in units of 1 cd/m2 are 0.5 in units of 100 cd/m2.
  const std::string hundreds = write("hundreds.exr", 0.5f, 100), ones = write("ones.exr", 50, 1);
  CHECK(mean_ratio(hundreds, ones) == Approx(1));
  CHECK(mean_ratio(ones, hundreds) == Approx(1));
  CHECK(mean_ratio(hundreds, half) == Approx(1));  // of which no unit is known
}

// `--illuminance` and `--luminance` of `photile render` and `photile relight`.

using Colour = std::array<std::uint8_t, 3>;

Colour colour_at(const Image& png, int x, int y) {
  Colour colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    const float light = png.channels[c][static_cast<std::size_t>(y * png.width + x)];
    colour[c] = image::srgb8_from_linear(light);
  }
  return colour;
}

/// An EXR of 3 x 1 pixels with 100, 200 and 400 lux by a lamp of 10 lm, and 25, 50 and 100 cd/m2.
std::string write_picture(const FileFolder& folder) {
  LightLayers layers(3, 1, std::vector<std::string>{"lamp"});
  layers.layers[0].illuminance = {10, 20, 40};
  layers.layers[0].radiance = {glm::vec3(2.5f), glm::vec3(5), glm::vec3(10)};
  LightMix mix;
  mix.lights.resize(1);
  mix.lights[0].name = "lamp";
  mix.lights[0].power = 10;
  write_exr(folder / "lamp.exr", *mixed_picture(layers, mix));
  return folder / "lamp.exr";
}

void run(const std::vector<std::string>& arguments) {
  const Outcome outcome = succeed(arguments);
  CHECK_THAT(outcome.errors, !Contains("warning"));
}

TEST_CASE("relight draws known lux and cd/m2 in their colours, as its changes leave them") {
  const FileFolder folder;
  const std::string picture = write_picture(folder);
  const report::Palette palette("turbo");
  const double factor = GENERATE(1.0, 2.0);
  run({"relight", picture, "--light", factor == 1 ? "lamp=10" : "lamp=20", "--illuminance",
       folder / "lux.png", "--luminance", folder / "luminance.png", "-s", "1000"});
  const Image lux = read_image(folder / "lux.png");
  const Image luminance = read_image(folder / "luminance.png");
  const std::array values{100.0, 200.0, 400.0};
  for (int x = 0; x < 3; ++x) {
    INFO("pixel " << x << ", lamp x" << factor);
    const double expected = factor * values[static_cast<std::size_t>(x)];
    CHECK(colour_at(lux, x, 0) == palette.at(expected / 1000));
    CHECK(colour_at(luminance, x, 0) == palette.at(expected / 4 / 1000));
  }
}

TEST_CASE("relight takes the options of falsecolor") {
  const FileFolder folder;
  const std::string picture = write_picture(folder);
  run({"relight", picture, "--illuminance", folder / "auto.png", "-s", "auto", "--pal", "viridis"});
  CHECK(colour_at(read_image(folder / "auto.png"), 1, 0) == report::Palette("viridis").at(0.5));
  run({"relight", picture, "--illuminance", folder / "log.png", "-s", "400", "--log", "1"});
  CHECK(colour_at(read_image(folder / "log.png"), 1, 0) ==
        report::Palette("turbo").at(1 + std::log10(0.5)));
  run({"relight", picture, "--illuminance", folder / "steps.png", "--cp", "-n", "4"});
  CHECK(colour_at(read_image(folder / "steps.png"), 2, 0) == report::Palette("turbo").at(0.375));
}

TEST_CASE("under an even sky of 500 lux a floor has the colour of 500 lux") {
  const FileFolder folder;
  folder.write("floor.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
  const std::string scene = folder.write("floor.obj",
                                         "mtllib floor.mtl\nv -1 0 -1\nv 1 0 -1\nv 1 0 1\n"
                                         "v -1 0 1\no floor\nusemtl grey\nf 4 3 2 1\n");
  // Posterized in steps of 200 lux: a pixel would have to be off by 100 lux to have another colour.
  run({"render", scene, "--sky", "uniform=500", "--size", "64x48", "--photons", "300k", "-k", "600",
       "--quality", "draft", "-o", folder / "floor.exr"});
  run({"relight", folder / "floor.exr", "--illuminance", folder / "lux.png", "--cp", "-n", "5"});
  const Image lux = read_image(folder / "lux.png");
  const report::Palette palette("turbo");
  std::map<Colour, int> pixels;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) ++pixels[colour_at(lux, x, y)];
  }
  const int dark = pixels[palette.at(0.1)];  // where the sky is seen, which is no surface
  const int lit = 64 * 48 - dark;
  CHECK(lit > 200);
  CHECK(pixels[palette.at(0.5)] > 0.8 * lit);  // the rest is the floor's border
}

TEST_CASE("what is drawn of a render is what its EXR holds, in scenes of watts as well") {
  const FileFolder folder;
  run({"render", write_box(folder), "--size", "24x16", "--photons", "20k", "--quality", "draft",
       "-o", folder / "a.exr", "--illuminance", folder / "lux.png", "--luminance",
       folder / "luminance.png", "-s", "3000"});
  const Image exr = read_image(folder / "a.exr");
  const Image lux = read_image(folder / "lux.png"), drawn = read_image(folder / "luminance.png");
  const report::Palette palette("turbo");
  const double efficacy = 683;
  for (std::size_t pixel = 0; pixel < exr.pixels(); ++pixel) {
    const auto value = [&](const char* channel) {
      return static_cast<double>((*exr.find(channel))[pixel]);
    };
    const int x = static_cast<int>(pixel) % 24, y = static_cast<int>(pixel) / 24;
    const double sum = value("Illuminance_left.Y") + value("Illuminance_right.Y");
    CHECK(colour_at(lux, x, y) == palette.at(sum / 3000));
    const double radiance = 0.2126 * value("R") + 0.7152 * value("G") + 0.0722 * value("B");
    CHECK(colour_at(drawn, x, y) == palette.at(efficacy * radiance / 3000));
  }
}

// Who pays for OpenImageIO: the dynamic linker says what it loads.

/// What the dynamic linker prints while a command runs.
std::string loaded_by(const std::vector<std::string>& arguments) {
  const Outcome outcome = succeed({.arguments = arguments, .environment = {{"LD_DEBUG", "files"}}});
  CHECK_THAT(outcome.errors, Contains("libOpenEXR"));
  return outcome.errors;
}

TEST_CASE(
    "OpenImageIO is loaded where a picture is read that is neither EXR nor PNG, nowhere else") {
  const FileFolder folder;
  const std::string box = write_box(folder), picture = folder / "a.exr", png = folder / "a.png";
  const std::vector<std::string> render = typed(
      "render", box, "-o", picture, "-o", png, "--size 16x12 --quality draft --photons 2k --quiet");
  for (const auto& command :
       {typed("--version"), render,
        typed("measure", box, "--plane floor+0.75 --photons 2k --rays 16 --quiet"),
        typed("relight", picture, "--light left=x2 -o", folder / "b.exr"),
        typed("compare", picture, picture), typed("compare", png, png)}) {
    CHECK_THAT(loaded_by(command), !Contains("OpenImageIO"));
  }
  folder.write("rug.ppm", "P6 1 1 255\n\x80\x40\x20");
  folder.write("box.mtl", box_mtl() + "newmtl rug\nmap_Kd rug.ppm\n");
  folder.write("box.obj", box_obj() + "vt 0 0\nvt 1 0\nvt 1 1\nusemtl rug\nf 1/1 2/2 3/3\n");
  const std::string texture = folder / "rug.ppm";
  for (const auto& command : {typed("info", box), typed("compare", texture, texture)}) {
    CHECK_THAT(loaded_by(command),
               Contains("photile_openimageio.so") && Contains("libOpenImageIO.so"));
  }
}

}  // namespace
}  // namespace photile::test
