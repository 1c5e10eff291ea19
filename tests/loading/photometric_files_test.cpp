// IES LM-63 and EULUMDAT files.
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "files/scene_files.hpp"
#include "message_of.hpp"
#include "photometric_texts.hpp"
#include "photometry/photometric_file.hpp"

namespace photile::test {
namespace {

using files::ResourceError;
using photometry::read_ies;
using std::numbers::pi;

// LM-63 files against closed forms, their oddities, and files that are none.

IntensityDistribution read_ies(const std::string& text) {
  files::Warnings warnings;
  return read_ies("lamp.ies", text, warnings);
}

std::string ies_refusal(const std::string& text) {
  return message_of<ResourceError>([&] { read_ies(text); });
}

/// A direction at gamma from -z and at azimuth C from +x by +y.
glm::dvec3 towards(double c, double gamma) {
  const double radians = pi / 180;
  return {std::sin(gamma * radians) * std::cos(c * radians),
          std::sin(gamma * radians) * std::sin(c * radians), -std::cos(gamma * radians)};
}

TEST_CASE("an even lamp of 100 cd emits 400 pi lm, whatever part of the circle was measured",
          "[ies]") {
  for (const auto& horizontal :
       {std::vector<double>{0}, angles(0, 90, 3), angles(0, 180, 4), angles(90, 270, 4),
        angles(0, 360, 8), angles(0, 345, 23), angles(-180, 180, 12)}) {
    IesText file;
    file.horizontal = horizontal;
    const IntensityDistribution lamp = read_ies(file.str());
    CAPTURE(horizontal.front(), horizontal.back());
    CHECK(lamp.flux() == Approx(400 * pi).epsilon(1e-12));
    for (const double c : {-170.0, 0.0, 45.0, 180.0, 352.5, 359.9999}) {
      CHECK(lamp.intensity(towards(c, 77)) == Approx(100));
    }
  }
}

TEST_CASE("flux is the exact integral of what is interpolated", "[ies]") {
  // I = 100 (1 - gamma / pi): 2 pi 100 (2 - 1).
  IesText linear;
  linear.vertical = {0, 180};
  linear.candela = [](double, double v) { return 100 * (1 - v / 180); };
  CHECK(read_ies(linear.str()).flux() == Approx(200 * pi).epsilon(1e-12));
  CHECK(read_ies(linear.str()).intensity(towards(10, 45)) == Approx(75));
  // Twice as bright on one half of the circle, linear between: I = 100 + 100 C / 180.
  IesText turned;
  turned.horizontal = {0, 180};
  turned.candela = [](double h, double) { return 100 + 100 * h / 180; };
  CHECK(read_ies(turned.str()).flux() == Approx(150 * 4 * pi).epsilon(1e-12));
  CHECK(read_ies(turned.str()).intensity(towards(-45, 90)) == Approx(125));
}

TEST_CASE("a Lambertian lamp emits pi times its intensity, downwards only", "[ies]") {
  IesText file;
  file.vertical = angles(0, 90, 90);
  file.candela = [](double, double v) { return 100 * std::cos(v * pi / 180); };
  const IntensityDistribution lamp = read_ies(file.str());
  CHECK(lamp.flux() == Approx(100 * pi).epsilon(1e-4));
  CHECK(lamp.intensity({0, 0, -1}) == Approx(100));
  CHECK(lamp.intensity(towards(200, 60)) == Approx(50));
  CHECK(lamp.intensity(towards(200, 91)) == 0);
}

TEST_CASE("planes left out by symmetry are mirrored ones", "[ies]") {
  const auto candela = [](double h, double v) { return h + v; };
  IesText quarter;
  quarter.vertical = {0, 90, 180};
  quarter.candela = candela;
  quarter.horizontal = angles(0, 90, 3);
  IesText half = quarter, side = quarter, full = quarter;
  half.horizontal = angles(0, 180, 6);
  side.horizontal = angles(90, 270, 6);
  full.horizontal = angles(0, 360, 12);
  for (const double c : {0.0, 10.0, 80.0, 90.0, 100.0, 179.0, 181.0, 265.0, 300.0, 359.0}) {
    CAPTURE(c);
    const double to_half = c <= 180 ? c : 360 - c;
    const double to_quarter = to_half <= 90 ? to_half : 180 - to_half;
    const double to_side = c < 90 ? 180 - c : c <= 270 ? c : 540 - c;
    CHECK(read_ies(quarter.str()).intensity(towards(c, 90)) == Approx(90 + to_quarter));
    CHECK(read_ies(half.str()).intensity(towards(c, 90)) == Approx(90 + to_half));
    CHECK(read_ies(side.str()).intensity(towards(c, 90)) == Approx(90 + to_side));
    CHECK(read_ies(full.str()).intensity(towards(c, 90)) == Approx(90 + c));
  }
}

TEST_CASE("types A and B turn about a pole above, or to the right", "[ies]") {
  const double h = GENERATE(-30.0, 0.0, 60.0), v = GENERATE(-60.0, 0.0, 30.0);
  IesText file;
  file.vertical = file.horizontal = angles(-90, 90, 6);
  file.candela = [&](double hh, double vv) { return hh == h && vv == v ? 500.0 : 0.0; };
  const double radians = pi / 180;
  const double ch = std::cos(h * radians), sh = std::sin(h * radians);
  const double cv = std::cos(v * radians), sv = std::sin(v * radians);
  // Aimed at -z with +x above: -y is to the right.
  file.type = 2;
  CHECK(read_ies(file.str()).intensity({ch * sv, -sh, -ch * cv}) == Approx(500));
  file.type = 3;
  CHECK(read_ies(file.str()).intensity({sv, -cv * sh, -cv * ch}) == Approx(500));
}

TEST_CASE("an even lamp of types A and B emits 2 pi lm per candela, also measured by a quarter",
          "[ies]") {
  for (const int type : {2, 3}) {
    IesText file;
    file.type = type;
    file.vertical = file.horizontal = angles(-90, 90, 4);
    CHECK(read_ies(file.str()).flux() == Approx(200 * pi).epsilon(1e-12));
    file.vertical = file.horizontal = angles(0, 90, 2);
    CHECK(read_ies(file.str()).flux() == Approx(200 * pi).epsilon(1e-12));
    CHECK(read_ies(file.str()).intensity({0, 0, -1}) == Approx(100));
    CHECK(read_ies(file.str()).intensity({0, 0, 1}) == 0);
  }
}

TEST_CASE("the multiplier and the ballast factor multiply, the lumens and the size do not",
          "[ies]") {
  IesText file;
  file.multiplier = 2.5;
  file.ballast = "0.8 1 60";
  file.lamps = "2 3000";
  file.units = 1;
  CHECK(read_ies(file.str()).intensity({0, 0, -1}) == Approx(200));
}

TEST_CASE("numbers may be wrapped, separated by commas and ended in any way", "[ies]") {
  IesText file;
  file.vertical = angles(0, 180, 18);
  file.horizontal = angles(0, 360, 4);
  file.candela = [](double h, double v) { return 1 + h / 100 + v; };
  const double flux = read_ies(file.str()).flux();
  for (const char* separator : {"\n", ", ", ",", "\r\n", "\r", "\t", "  \n \n"}) {
    file.separator = separator;
    CHECK(read_ies(file.str()).flux() == flux);
  }
  file.separator = " +";  // the sign of the next number
  std::string text = file.str();
  for (std::size_t at; (at = text.find("+\n")) != std::string::npos;) text.erase(at, 1);
  CHECK(read_ies(text).flux() == flux);
  CHECK(read_ies("\xEF\xBB\xBF" + file.first_line + "[MANUFAC] M\xFCller\n" + IesText().str())
            .flux() == Approx(400 * pi));
  CHECK(read_ies(IesText().str() + "\x1A").flux() == Approx(400 * pi));
}

TEST_CASE("keywords and input watts describe the luminaire", "[ies]") {
  IesText file;
  file.first_line =
      "IESNA:LM-63-2002\n[MANUFAC] Good Light Ltd\n[LUMCAT] GL-40\n[LUMINAIRE] Panel\n"
      "[MORE] recessed\n[LAMP] LED 4000 K CRI>80\n";
  file.ballast = "1 1 36.5";
  LuminaireData data = read_ies(file.str()).data();
  CHECK(data.maker == "Good Light Ltd");
  CHECK(data.article == "GL-40");
  CHECK(data.luminaire == "Panel recessed");
  CHECK(data.source == "LED 4000 K CRI>80");
  CHECK(data.watts == 36.5);
  CHECK(data.kelvin == 4000);
  CHECK(data.rendering == 80);
  file.first_line = "IESNA:LM-63-2002\n[LAMP] LED 5000lm\n[_CCT] 2700\n[_CRI] 95\n";
  data = read_ies(file.str()).data();
  CHECK(data.kelvin == 2700);  // and no lumens
  CHECK(data.rendering == 95);
  // A description holds the letters of CRI, and that of red is not Ra.
  file.first_line = "IESNA:LM-63-2002\n[_DESCRIPTION] 60 W\n[_CRI] 92\n[_CRI_R9] 50\n";
  CHECK(read_ies(file.str()).data().rendering == 92);
  file.first_line = "IESNA:LM-63-2002\n[_DESCRIPTION] 60 W\n";
  CHECK(read_ies(file.str()).data().rendering == 0);
  file.first_line = "IESNA:LM-63-2002\n";
  data = read_ies(file.str()).data();
  CHECK(data.maker.empty());
  CHECK(data.kelvin == 0);
}

TEST_CASE("colours of lamps are found in the words for them", "[ies]") {
  using photometry::kelvin_in, photometry::highest_kelvin_in, photometry::rendering_in;
  using Kelvin = std::tuple<int, int, std::vector<const char*>>;
  for (const auto& [lowest, highest, texts] :
       {Kelvin{4000, 0, {"4000", "4000 K/840", "840"}}, Kelvin{3000, 0, {"3000K", "ww/3000"}},
        Kelvin{2700, 0, {"warm white / 2700 K"}}, Kelvin{2700, 6500, {"tw 2700-6500", "927-965"}},
        Kelvin{0, 0, {"warm", "12", "999999"}}}) {
    for (const char* text : texts) {
      CAPTURE(text);
      CHECK(kelvin_in(text) == lowest);
      CHECK(highest_kelvin_in(text) == highest);
    }
  }
  using Ra = std::pair<int, std::vector<const char*>>;
  for (const auto& [ra, texts] :
       {Ra{100, {"100"}}, Ra{92, {"R9 50, Ra 92"}}, Ra{86, {"1B/86", "86 (1B)"}}, Ra{85, {"85"}},
        Ra{90, {"Ra 90", "Ra > 90", "90+", "1A", "930", "1A/90-100"}}, Ra{83, {"83,5"}},
        Ra{80, {"80", ">80", "80-89", "1B", "1b", "1 B", "1", "CRI 80"}}, Ra{70, {"2A"}},
        Ra{60, {"2B"}}, Ra{40, {"3"}}, Ra{20, {"4"}}, Ra{0, {"5", "", "-", "n/a"}}}) {
    for (const char* text : texts) {
      CAPTURE(text);
      CHECK(rendering_in(text) == ra);
    }
  }
}

TEST_CASE("a file cut before its last number is refused", "[ies]") {
  IesText file;
  file.tilt = "TILT=INCLUDE\n1 2 0 90 1 0.9\n";
  file.horizontal = angles(0, 90, 2);
  const std::string sound = file.str();
  const std::size_t needed = sound.find_last_of('1');  // cut within the last number it is another
  for (std::size_t length = 0; length <= needed; ++length) {
    REQUIRE_FALSE(ies_refusal(sound.substr(0, length)).empty());
  }
}

// EULUMDAT files against closed forms, and files that are none.

IntensityDistribution read_eulumdat(const std::string& text) {
  files::Warnings warnings;
  return photometry::read_eulumdat("lamp.ldt", text, warnings);
}

std::string eulumdat_refusal(const std::string& text) {
  return message_of<ResourceError>([&] { read_eulumdat(text); });
}

glm::dvec3 level_towards(double c) { return {std::cos(c * pi / 180), std::sin(c * pi / 180), 0.0}; }

TEST_CASE("intensities are per 1000 lm of the lamps, times the conversion factor") {
  EulumdatText file;
  file.intensity = [](double, double) { return 1000 / (4 * pi); };
  CHECK(read_eulumdat(file.str()).flux() == Approx(2000).epsilon(1e-6));
  file.conversion = 0.5;
  CHECK(read_eulumdat(file.str()).flux() == Approx(1000).epsilon(1e-6));
}

TEST_CASE("a EULUMDAT file describes its luminaire") {
  const LuminaireData data = read_eulumdat(EulumdatText{}.str()).data();
  CHECK(data.maker == "maker");
  CHECK(data.luminaire == "lamp");
  CHECK(data.article == "number");
  CHECK(data.source == "lamp");
  CHECK(data.watts == 20);
  CHECK(data.kelvin == 3000);
  CHECK(data.rendering == 80);
  EulumdatText tunable;
  tunable.colour = "tw 2700-6500";
  tunable.rendering = "1A/93";
  CHECK(read_eulumdat(tunable.str()).data().kelvin == 2700);
  CHECK(read_eulumdat(tunable.str()).data().highest_kelvin == 6500);
  CHECK(read_eulumdat(tunable.str()).data().rendering == 93);
  tunable.colour = "4000 K/840";  // the field of the rendering is empty
  tunable.rendering = "";
  CHECK(read_eulumdat(tunable.str()).data().rendering == 80);
}

TEST_CASE("decimal commas are points") {
  EulumdatText file;
  file.planes = 24;
  file.gamma = angles(0, 90, 36);
  file.lamp_flux = 1234.5;
  file.intensity = [](double c, double g) { return c / 360 + std::cos(g * pi / 180); };
  const double flux = read_eulumdat(file.str()).flux();
  file.commas = true;
  CHECK(read_eulumdat(file.str()).flux() == flux);
}

TEST_CASE("each symmetry leaves out the planes that mirrors give") {
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

TEST_CASE("of several sets of lamps the first counts, and a warning says so") {
  EulumdatText file;
  file.sets = 3;
  files::Warnings warnings;
  const auto lamp = photometry::read_eulumdat("lamp.ldt", file.str(), warnings);
  CHECK(lamp.flux() == Approx(50 * 2 * 4 * pi));
  CHECK(warnings.lines().size() == 1);
}

TEST_CASE("a EULUMDAT file cut anywhere is refused") {
  const std::string sound = EulumdatText().str();
  for (std::size_t length = 0; length + 4 < sound.size(); ++length) {
    REQUIRE_FALSE(eulumdat_refusal(sound.substr(0, length)).empty());
  }
}

}  // namespace
}  // namespace photile::test
