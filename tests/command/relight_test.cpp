// `photile relight` on pictures of the program's own.
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
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

}  // namespace

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

}  // namespace photile::test
