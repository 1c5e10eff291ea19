// EULUMDAT files against closed forms, and files that are none.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "files/scene_files.hpp"
#include "photometric_texts.hpp"
#include "photometry/photometric_file.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

IntensityDistribution read_eulumdat(const std::string& text) {
  files::Warnings warnings;
  return photometry::read_eulumdat("lamp.ldt", text, warnings);
}

std::string eulumdat_refusal(const std::string& text) {
  try {
    read_eulumdat(text);
  } catch (const files::ResourceError& error) {
    return error.what();
  }
  return "";
}

glm::dvec3 level_towards(double c) { return {std::cos(c * pi / 180), std::sin(c * pi / 180), 0.0}; }

TEST_CASE("intensities are per 1000 lm of the lamps, times the conversion factor", "[eulumdat]") {
  EulumdatText file;
  file.intensity = [](double, double) { return 1000 / (4 * pi); };
  CHECK(read_eulumdat(file.str()).flux() == Approx(2000).epsilon(1e-6));
  file.conversion = 0.5;
  CHECK(read_eulumdat(file.str()).flux() == Approx(1000).epsilon(1e-6));
}

TEST_CASE("decimal commas are points", "[eulumdat]") {
  EulumdatText file;
  file.planes = 24;
  file.gamma = angles(0, 90, 36);
  file.lamp_flux = 1234.5;
  file.intensity = [](double c, double g) { return c / 360 + std::cos(g * pi / 180); };
  const double flux = read_eulumdat(file.str()).flux();
  file.commas = true;
  CHECK(read_eulumdat(file.str()).flux() == flux);
}

TEST_CASE("each symmetry leaves out the planes that mirrors give", "[eulumdat]") {
  EulumdatText file;
  file.planes = 12;
  file.lamp_flux = 1000;
  file.intensity = [](double c, double) { return c; };
  for (const double c : {0.0, 5.0, 30.0, 90.0, 100.0, 170.0, 185.0, 270.0, 280.0, 345.0}) {
    CAPTURE(c);
    const auto at = [&](int symmetry) {
      EulumdatText asked = file;
      asked.symmetry = symmetry;
      if (symmetry == 3) {  // ascends from C270 through C0
        asked.intensity = [](double angle, double) { return angle < 180 ? angle + 360 : angle; };
      }
      return read_eulumdat(asked.str()).intensity(level_towards(c));
    };
    const double to_half = c <= 180 ? c : 360 - c;
    const double to_quarter = to_half <= 90 ? to_half : 180 - to_half;
    const double to_side = c <= 90 ? 360 + c : c <= 270 ? 540 - c : c;
    CHECK(at(0) == Approx(c <= 330 ? c : 330 * (360 - c) / 30));
    CHECK(at(1) == Approx(0).margin(1e-9));
    CHECK(at(2) == Approx(to_half).margin(1e-9));
    CHECK(at(3) == Approx(to_side));
    CHECK(at(4) == Approx(to_quarter).margin(1e-9));
  }
}

TEST_CASE("of several sets of lamps the first counts, and a warning says so", "[eulumdat]") {
  EulumdatText file;
  file.sets = 3;
  files::Warnings warnings;
  const auto lamp = photometry::read_eulumdat("lamp.ldt", file.str(), warnings);
  CHECK(lamp.flux() == Approx(50 * 2 * 4 * pi));
  CHECK(warnings.lines().size() == 1);
}

TEST_CASE("what is wrong with a EULUMDAT file is told with its line", "[eulumdat]") {
  EulumdatText file;
  CHECK_THAT(eulumdat_refusal(""), Catch::Contains("ends before the symmetry"));
  CHECK_THAT(eulumdat_refusal("a\nb\nc\n"), Catch::Contains("line 3: no number"));
  file.symmetry = 5;
  CHECK_THAT(eulumdat_refusal(file.str()), Catch::Contains("line 3: the symmetry indicator is 5"));
  file.symmetry = 4;
  file.planes = 6;
  CHECK_THAT(eulumdat_refusal(file.str()), Catch::Contains("6 C planes cannot have symmetry 4"));
  file = {};
  file.lamp_flux = 0;
  CHECK_THAT(eulumdat_refusal(file.str()), Catch::Contains("not above 0"));
  file = {};
  file.gamma = {0, 90, 90};
  CHECK_THAT(eulumdat_refusal(file.str()), Catch::Contains("angles ascend"));
  file = {};
  file.intensity = [](double, double) { return -1.0; };
  CHECK_THAT(eulumdat_refusal(file.str()), Catch::Contains("-2 cd"));
  std::string text = EulumdatText().str();
  text.replace(text.find("\n1\n0\r\n4\r\n"), 9, "\n1\n0\r\n4e9\r");
  CHECK_THAT(eulumdat_refusal(text), Catch::Contains("4000000000"));
}

TEST_CASE("openings are millimetres: length along C90, width 0 of round ones", "[eulumdat]") {
  EulumdatText file;
  file.sizes = {1300, 400, 80, 1200, 300, 40, 40, 40, 40};
  const LuminousOpening linear = read_eulumdat(file.str()).opening();
  CHECK(linear.along_quarter == Approx(1.2));
  CHECK(linear.along_zero == Approx(0.3));
  CHECK(linear.height == Approx(0.04));
  CHECK_FALSE(linear.round);
  file.sizes = {250, 0, 80, 200, 0, 0, 0, 0, 0};
  const IntensityDistribution round = read_eulumdat(file.str());
  CHECK(round.opening().round);
  CHECK(round.opening().projected_area(round.axes(), {0, 0, -1}) == Approx(pi * 0.01));
}

TEST_CASE("a EULUMDAT file cut anywhere, or with bytes replaced at random, is read or refused",
          "[eulumdat]") {
  const std::string sound = EulumdatText().str();
  for (std::size_t length = 0; length + 4 < sound.size(); ++length) {
    REQUIRE_FALSE(eulumdat_refusal(sound.substr(0, length)).empty());
  }
  std::mt19937 random(8);
  for (int trial = 0; trial < 20'000; ++trial) {
    eulumdat_refusal(damaged(sound, random));  // nothing but a ResourceError
  }
}

}  // namespace
}  // namespace photile::test
