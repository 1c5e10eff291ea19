#include "tools/report/radiance_palettes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

namespace photile::image {
namespace {

double clip(double x) { return std::clamp(x, 0.0, 1.0); }
double linear(double x) { return std::pow(x, 2.2); }

/// Linear interpolation in a table whose entries are 0.0454545 apart.
double table_at(const std::array<double, 23>& table, double x) {
  const double place = std::clamp(x / 0.0454545, 0.0, 22.0);
  const auto below = std::min<std::size_t>(21, static_cast<std::size_t>(place));
  const double part = place - static_cast<double>(below);
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

const std::map<std::string, std::function<glm::dvec3(double)>>& palettes() {
  static const std::map<std::string, std::function<glm::dvec3(double)>> all{
      {"def", def}, {"spec", spec}, {"pm3d", pm3d}, {"hot", hot}, {"eco", eco}};
  return all;
}

}  // namespace

bool is_radiance_palette(const std::string& name) { return palettes().contains(name); }

glm::dvec3 radiance_palette(const std::string& name, double share) {
  return glm::clamp(palettes().at(name)(clip(share)), 0.0, 1.0);
}

}  // namespace photile::image
