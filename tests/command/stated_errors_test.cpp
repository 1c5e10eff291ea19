// `photile render --errors`: the noise of each light's layer, as the picture states it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

constexpr int seeds = 6;

void render_picture(const FileFolder& folder, const std::string& file, const std::string& seed,
                    const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"render",    write_box(folder),
                                     "-o",        file,
                                     "--size",    "24x18",
                                     "--samples", "4",
                                     "--photons", "50k",
                                     "-k",        "50",
                                     "--set",     "light_map_rays=16",
                                     "--seed",    seed};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome outcome = run_photile(arguments);
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
}

/// A picture and its errors, of this seed.
void render(const FileFolder& folder, int seed) {
  const std::string name = std::to_string(seed);
  render_picture(folder, folder / name + ".exr", name, {"--errors", folder / name + "-errors.exr"});
}

}  // namespace

TEST_CASE("the stated errors of a light are the scatter of its layer from seed to seed") {
  const FileFolder folder;
  std::vector<Image> pictures, errors;
  for (int seed = 1; seed <= seeds; ++seed) {
    render(folder, seed);
    pictures.push_back(read_image(folder / std::to_string(seed) + ".exr"));
    errors.push_back(read_image(folder / std::to_string(seed) + "-errors.exr"));
    REQUIRE(errors.back().channel_names == pictures.back().channel_names);
  }
  for (const std::string channel : {"Illuminance_left.Y", "Illuminance_right.Y"}) {
    CAPTURE(channel);
    double stated = 0, measured = 0;
    for (std::size_t pixel = 0; pixel < pictures.front().pixels(); ++pixel) {
      double sum = 0, squares = 0;
      for (int i = 0; i < seeds; ++i) {
        const double value = (*pictures[i].find(channel))[pixel];
        sum += value;
        squares += value * value;
        stated += std::pow((*errors[i].find(channel))[pixel], 2) / seeds;
      }
      measured += (squares - sum * sum / seeds) / (seeds - 1);
    }
    // A ratio of variances: the stated error leaves out what photons share.
    CHECK(stated / measured > 0.4);
    CHECK(stated / measured < 2.0);
  }
}

TEST_CASE("stating errors changes no bit of the picture") {
  const FileFolder folder;
  render(folder, 1);
  render_picture(folder, folder / "alone.exr", "1", {});
  CHECK(read_image(folder / "1.exr").channels == read_image(folder / "alone.exr").channels);
}

TEST_CASE("errors are relit as pictures are: a light's own in proportion to its power") {
  const FileFolder folder;
  render(folder, 1);
  REQUIRE(run_photile({"relight", folder / "1-errors.exr", "--light", "left=x3", "-o",
                       folder / "relit.exr"})
              .exit_code == 0);
  const Image before = read_image(folder / "1-errors.exr"),
              after = read_image(folder / "relit.exr");
  const auto& own = *before.find("Combined_left.G");
  const auto& tripled = *after.find("Combined_left.G");
  CHECK(*std::max_element(own.begin(), own.end()) > 0);
  for (std::size_t pixel = 0; pixel < own.size(); ++pixel) {
    CHECK(tripled[pixel] == Approx(3 * own[pixel]));
  }
  CHECK(*before.find("Combined_right.G") == *after.find("Combined_right.G"));
}

TEST_CASE("errors are not stated where no nodes gather") {
  const FileFolder folder;
  const auto refusal = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render",         write_box(folder), "-o",
                                       folder / "a.exr", "--errors",        folder / "errors.exr"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return only_error(run_photile(arguments), usage);
  };
  CHECK_THAT(refusal({"--quality", "draft"}), Contains("--errors") && Contains("--quality good"));
  CHECK_THAT(refusal({"--integrator", "path"}), Contains("--errors"));
  CHECK_THAT(refusal({"--save-maps", folder / "a.maps"}), Contains("--errors"));
}

}  // namespace photile::test
