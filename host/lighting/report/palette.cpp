#include "report/palette.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "image/display.hpp"
#include "photile/errors.hpp"

namespace photile::report {

constexpr int entries = 256;

Palette::Palette(const std::string& name) {
  const auto& known = names();
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    throw UsageError(
        fmt::format("no palette '{}'; the palettes are {}", name, fmt::join(known, ", ")));
  }
  for (int i = 0; i < entries; ++i) {
    const double share = static_cast<double>(i) / (entries - 1);
    const glm::dvec3 rgb = palette_colour(name, share);
    colours_.push_back({image::srgb8_from_linear(static_cast<float>(rgb.r)),
                        image::srgb8_from_linear(static_cast<float>(rgb.g)),
                        image::srgb8_from_linear(static_cast<float>(rgb.b))});
  }
}

std::array<std::uint8_t, 3> Palette::at(double share) const {
  if (std::isnan(share)) return {128, 128, 128};
  return colours_[static_cast<std::size_t>(
      std::lround(std::clamp(share, 0.0, 1.0) * (entries - 1)))];
}

std::string Palette::hex(double share) const {
  const auto [r, g, b] = at(share);
  return fmt::format("#{:02x}{:02x}{:02x}", r, g, b);
}

namespace {

/// Red, green, blue of colours at equal distances, linear. All but blue-red are those of
/// OpenImageIO 2.4's color_map (BSD licence), which took turbo from Google (A. Mikhailov, 2019) and
/// the others with seventeen from matplotlib (S. van der Walt and N. Smith, 2015; CC0).
const std::map<std::string, std::vector<double>>& knots() {
  static const std::map<std::string, std::vector<double>> all{
      {"blue-red", {0.02, 0.08, 0.6, 1, 1, 1, 0.6, 0.03, 0.02}},
      {"heat", {0, 0, 0, 0.05, 0, 0, 0.25, 0, 0, 0.75, 0.75, 0, 1, 1, 1}},
      {"spectrum", {0, 0, 0.05, 0, 0, 0.75, 0, 0.5, 0, 0.5, 0.5, 0, 1, 0, 0}},
      {"turbo", {0.03006, 0.00619, 0.04403, 0.05131, 0.05183, 0.35936, 0.06204, 0.1482,  0.77017,
                 0.0544,  0.29523, 0.99718, 0.0216,  0.50023, 0.8338,  0.00892, 0.72094, 0.54189,
                 0.03205, 0.8879,  0.31235, 0.15318, 0.98683, 0.1231,  0.37185, 0.97738, 0.04454,
                 0.61188, 0.83681, 0.03455, 0.85432, 0.62499, 0.04203, 0.98447, 0.41196, 0.0342,
                 0.9631,  0.20754, 0.01503, 0.82971, 0.08083, 0.00438, 0.63144, 0.02851, 0.0014,
                 0.39907, 0.00776, 0.00033, 0.19564, 0.00123, 0.00082}},
      {"viridis",
       {0.057951, 0.000377, 0.088657, 0.064791, 0.009258, 0.14534,  0.063189, 0.025975, 0.198994,
        0.054539, 0.051494, 0.237655, 0.043139, 0.084803, 0.258811, 0.032927, 0.124348, 0.268148,
        0.025232, 0.169666, 0.271584, 0.019387, 0.221569, 0.270909, 0.014846, 0.281323, 0.263855,
        0.013529, 0.34953,  0.246357, 0.021457, 0.425216, 0.215605, 0.049317, 0.505412, 0.172291,
        0.112305, 0.585164, 0.121207, 0.229143, 0.657992, 0.070438, 0.417964, 0.717561, 0.029928,
        0.683952, 0.762557, 0.009977, 0.984709, 0.799651, 0.018243}},
      {"inferno",
       {0.000113, 3.6e-05,  0.001073, 0.003275, 0.002178, 0.017634, 0.015183, 0.003697, 0.06876,
        0.046307, 0.002834, 0.130327, 0.095494, 0.005137, 0.154432, 0.163601, 0.00992,  0.156097,
        0.25389,  0.016282, 0.143715, 0.367418, 0.024893, 0.119982, 0.500495, 0.038279, 0.089117,
        0.642469, 0.061553, 0.057555, 0.77619,  0.102517, 0.031141, 0.883568, 0.16999,  0.012559,
        0.951614, 0.271639, 0.002704, 0.972636, 0.413571, 0.005451, 0.943272, 0.599923, 0.035112,
        0.8849,   0.822282, 0.140466, 0.973729, 0.996282, 0.373522}},
      {"magma",
       {0.000113, 3.6e-05,  0.001073, 0.003066, 0.002406, 0.016033, 0.012176, 0.005476, 0.062265,
        0.036874, 0.005102, 0.146314, 0.081757, 0.006177, 0.200758, 0.143411, 0.011719, 0.218382,
        0.22611,  0.019191, 0.221188, 0.334672, 0.027718, 0.212689, 0.47168,  0.037966, 0.191879,
        0.632894, 0.053268, 0.15987,  0.79591,  0.083327, 0.124705, 0.913454, 0.146074, 0.106311,
        0.970011, 0.248466, 0.12074,  0.991142, 0.384808, 0.16759,  0.992958, 0.553563, 0.24777,
        0.982888, 0.756759, 0.367372, 0.9708,   0.980633, 0.521749}},
      {"plasma",
       {0.00397,  0.002307, 0.240854, 0.031078, 0.001421, 0.307376, 0.073167, 0.00074,  0.356714,
        0.132456, 6.6e-05,  0.38804,  0.20933,  0.000928, 0.390312, 0.300631, 0.005819, 0.358197,
        0.399925, 0.017084, 0.301977, 0.501006, 0.036122, 0.240788, 0.600808, 0.063814, 0.186921,
        0.698178, 0.101409, 0.142698, 0.790993, 0.151134, 0.106347, 0.874354, 0.216492, 0.076152,
        0.940588, 0.302179, 0.051495, 0.980469, 0.413691, 0.032625, 0.984224, 0.556999, 0.020728,
        0.942844, 0.738124, 0.018271, 0.868931, 0.944416, 0.01559}},
  };
  return all;
}

/// Between the knots.
glm::dvec3 between(const std::vector<double>& values, double share) {
  const std::size_t intervals = values.size() / 3 - 1;
  const double position = share * static_cast<double>(intervals);
  const std::size_t below = std::min(intervals - 1, static_cast<std::size_t>(position));
  const auto colour = [&](std::size_t knot) {
    return glm::dvec3(values[3 * knot], values[3 * knot + 1], values[3 * knot + 2]);
  };
  return glm::mix(colour(below), colour(below + 1), position - static_cast<double>(below));
}

// As falsecolor.pl of Radiance 5 has them; its tbo is OpenImageIO's turbo.

double clip(double x) { return std::clamp(x, 0.0, 1.0); }
double linear(double x) { return std::pow(x, 2.2); }

/// Linear interpolation in a table whose entries are 0.0454545 apart.
double table_at(const std::array<double, 23>& table, double x) {
  const double position = std::clamp(x / 0.0454545, 0.0, 22.0);
  const auto below = std::min<std::size_t>(21, static_cast<std::size_t>(position));
  const double part = position - static_cast<double>(below);
  return (1 - part) * table[below] + part * table[below + 1];
}

glm::dvec3 def(double x) {
  static constexpr std::array red{0.18848,      0.05468174,  0.00103547, 8.311144e-08, 7.449763e-06,
                                  0.0004390987, 0.001367254, 0.003076,   0.01376382,   0.06170773,
                                  0.1739422,    0.2881156,   0.3299725,  0.3552663,    0.372552,
                                  0.3921184,    0.4363976,   0.6102754,  0.7757267,    0.9087369,
                                  1.0,          1.0,         0.9863};
  static constexpr std::array green{0.0009766,  2.35501e-05, 0.0008966244, 0.0264977,  0.1256843,
                                    0.2865799,  0.4247083,   0.4739468,    0.4402732,  0.3671876,
                                    0.2629843,  0.1725325,   0.1206819,    0.07316644, 0.03761026,
                                    0.01612362, 0.004773749, 6.830967e-06, 0.00803605, 0.1008085,
                                    0.3106831,  0.6447838,   0.9707};
  static constexpr std::array blue{
      0.2666,      0.3638662,    0.4770437,    0.5131397,   0.5363797,  0.5193677,
      0.4085123,   0.1702815,    0.05314236,   0.05194055,  0.08564082, 0.09881395,
      0.08324373,  0.06072902,   0.0391076,    0.02315354,  0.01284458, 0.005184709,
      0.001691774, 2.432735e-05, 1.212949e-05, 0.006659406, 0.02539};
  return {table_at(red, x), table_at(green, x), table_at(blue, x)};
}

glm::dvec3 spec(double x) {
  return {1.6 * x - 0.6, x > 0.375 ? 1.6 - 1.6 * x : 8.0 / 3.0 * x, 1 - 8.0 / 3.0 * x};
}

glm::dvec3 pm3d(double x) {
  return {linear(std::sqrt(x)), linear(x * x * x),
          linear(clip(std::sin(2 * std::numbers::pi * x)))};
}

glm::dvec3 hot(double x) {
  return {linear(clip(3 * x)), linear(clip(3 * x - 1)), linear(clip(3 * x - 2))};
}

glm::dvec3 eco(double x) {
  return {linear(clip(2 * x)), linear(clip(2 * (x - 0.5))), linear(clip(2 * (0.5 - x)))};
}

using Function = glm::dvec3 (*)(double);

const std::map<std::string, Function>& functions() {
  static const std::map<std::string, Function> all{
      {"def", def}, {"spec", spec}, {"pm3d", pm3d}, {"hot", hot}, {"eco", eco}};
  return all;
}

}  // namespace

const std::vector<std::string>& Palette::names() {
  static const std::vector<std::string> all{"turbo", "viridis",  "inferno",  "magma", "plasma",
                                            "heat",  "spectrum", "blue-red", "def",   "spec",
                                            "pm3d",  "hot",      "eco"};
  return all;
}

glm::dvec3 palette_colour(const std::string& name, double share) {
  const auto function = functions().find(name);
  const glm::dvec3 colour = function == functions().end() ? between(knots().at(name), clip(share))
                                                          : function->second(clip(share));
  return glm::clamp(colour, 0.0, 1.0);
}

}  // namespace photile::report
