// `photile compare`: figures, layers, the picture and refusals.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

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
  CHECK_THAT(outcome.output, Contains("picture") && Contains("left"));
  return nlohmann::json::parse(folder.read("compared.json"));
}

}  // namespace

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

TEST_CASE("a layer that is black in the second, or in one picture alone, is told") {
  const FileFolder folder;
  const std::string whole = render_box(folder, "a.exr");
  const Outcome off =
      run_photile({"compare", whole, render_box(folder, "b.exr", {"--light", "left=off"})});
  CHECK(off.exit_code == 0);
  CHECK_THAT(off.output, Contains("black"));
  const Outcome grouped =
      run_photile({"compare", whole, render_box(folder, "c.exr", {"--light-group", "*=both"})});
  CHECK(grouped.exit_code == 0);
  CHECK_THAT(grouped.output,
             Contains("left: only in the first") && Contains("both: only in the second"));
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
