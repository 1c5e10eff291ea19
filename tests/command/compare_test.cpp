// `photile compare`: figures, layers, the picture and refusals.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

std::string render_box(const FileFolder& folder, const std::string& name,
                       const std::vector<std::string>& options = {},
                       const std::string& size = "32x32") {
  std::vector<std::string> arguments{"render", write_box(folder), "-o", folder / name, "--photons",
                                     "20k",    "--size",          size, "--quality",   "draft"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = run_photile(arguments);
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  return folder / name;
}

nlohmann::json compare(const FileFolder& folder, const std::string& a, const std::string& b) {
  const Outcome outcome = run_photile(
      {"compare", a, b, "-o", folder / "compared.png", "--json", folder / "compared.json"});
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.output, Contains("left"));
  return nlohmann::json::parse(folder.read("compared.json"));
}

}  // namespace

TEST_CASE("a picture with a value that is no number is refused by its name") {
  const FileFolder folder;
  Image image;
  image.width = image.height = 2;
  for (const char* name : {"R", "G", "B"}) image.add(name) = {1, 1, 1, 1};
  write_exr(folder / "sound.exr", image);
  image.channels.front()[2] = std::numeric_limits<float>::quiet_NaN();
  write_exr(folder / "damaged.exr", image);
  for (const auto& [a, b] : {std::pair("sound.exr", "damaged.exr"), {"damaged.exr", "sound.exr"}}) {
    CHECK_THAT(only_error(run_photile({"compare", folder / a, folder / b}), bad_input),
               Contains("damaged.exr") && Contains("1 of its values"));
  }
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
      run_photile({"compare", whole, render_box(folder, "b.exr", {"--light", "left=off"})});
  CHECK(off.exit_code == 0);
  CHECK_THAT(off.output, Contains("luminance, mean") && Contains("lux") && Contains("ratio") &&
                             Contains("0 W") && !Contains("error"));
  const Outcome grouped =
      run_photile({"compare", whole, render_box(folder, "c.exr", {"--light-group", "*=both"})});
  CHECK(grouped.exit_code == 0);
  CHECK_THAT(grouped.output,
             Contains("left: only in the first") && Contains("both: only in the second"));
}

TEST_CASE("two moods of a picture are compared by their levels") {
  const FileFolder folder;
  const std::string picture = render_box(folder, "a.exr");
  const std::string moods = folder.write("a.moods.json", R"({"photile_moods": 1, "moods": {
      "bright": {"left": {"power": 20, "unit": "W"}, "right": {"power": 0, "unit": "W", "on": false}},
      "half": {"left": {"power": 10, "unit": "W"}, "right": {"power": 5, "unit": "W", "on": false}}}})");
  const std::vector<std::string> two{"compare", picture,
                                     "--mood",  "bright",
                                     "--mood",  "half",
                                     "--json",  folder / "levels.json",
                                     "-o",      folder / "two.png"};
  const Outcome outcome = run_photile(two);  // the file beside the picture
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  const auto record = nlohmann::json::parse(folder.read("levels.json"));
  CHECK(record["first"] == "bright");
  REQUIRE(record["levels"].size() == 6);
  for (const auto& level : record["levels"]) {
    CHECK(level["first"].get<double>() == Approx(2 * level["second"].get<double>()).epsilon(1e-5));
  }
  CHECK(record["powers"][0]["first"] == 20);
  CHECK(record["powers"][1]["second"] == 0);
  CHECK_THAT(only_error(run_photile({"compare", picture, "--mood", "bright"}), 2),
             Contains("--mood twice"));
  CHECK_THAT(only_error(run_photile({"compare", picture, "--mood", "bright", "--mood", "dim"}), 2),
             Contains("'dim'") && Contains("'half'"));
  CHECK_THAT(only_error(run_photile({"compare", picture}), 2), Contains("second picture"));
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
  REQUIRE(
      run_photile({"relight", whole, "--mood", "night", "-o", folder / "night.exr"}).exit_code ==
      0);
  const Image relit = read_image(folder / "night.exr"), rendered = read_image(by_light);
  for (std::size_t i = 0; i < rendered.pixels(); ++i) {
    REQUIRE((*relit.find("G"))[i] == Approx((*rendered.find("G"))[i]).epsilon(1e-5));
  }
  const auto measured = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"measure", scene, "--plane", "1", "--rays", "16", "--photons",
                                     "10k", "--repeats", "2", "-q"});
    return run_photile(options).output;
  };
  CHECK(measured({"--mood", "night"}) == measured(plain));
  // --light goes on from a mood.
  const std::string dimmer =
      render_box(folder, "d.exr", {"--mood", "night", "--light", "left=x0.5"});
  CHECK((*read_image(dimmer).find("G"))[500] ==
        Approx(0.5 * (*read_image(by_light).find("G"))[500]).epsilon(1e-5));
  CHECK_THAT(
      only_error(run_photile({"render", scene, "-q", "-o", folder / "x.exr", "--mood", "day"}), 2),
      Contains("'day'") && Contains("'night'"));
  CHECK_THAT(only_error(run_photile({"render", scene, "-q", "-o", folder / "x.exr", "--mood", "day",
                                     "--moods", folder / "none.json"}),
                        2),
             Contains("none.json"));
}

TEST_CASE("compare refuses what it cannot do with one line and the right exit code") {
  const FileFolder folder;
  const std::string picture = render_box(folder, "a.exr");
  CHECK_THAT(only_error(run_photile({"compare", picture, folder / "none.exr"}), 3),
             Contains("none.exr"));
  const std::string wide = render_box(folder, "b.exr", {}, "33x32");
  CHECK_THAT(only_error(run_photile({"compare", picture, wide}), 2), Contains("33x32"));
  CHECK_THAT(only_error(run_photile({"compare", picture, picture, "-o", folder / "a.jpg"}), 2),
             Contains(".png"));
  CHECK_THAT(only_error(run_photile({"compare", picture, picture, "--json", picture}), 2),
             Contains("input"));
}

}  // namespace photile::test
