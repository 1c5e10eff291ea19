#include "glare/ratings.hpp"

#include <algorithm>
#include <cmath>

#include "photile/defaults.hpp"

namespace photile::glare {
namespace {

double contrast_sum(std::span<const Source> sources) {
  double sum = 0;
  for (const Source& s : sources) {
    sum += s.luminance * s.luminance * s.solid_angle / (s.position_index * s.position_index);
  }
  return sum;
}

}  // namespace

double ugr(std::span<const Source> sources, double background) {
  return 8 * std::log10(0.25 / background * contrast_sum(sources));
}

Source as_small_source(Source source, double projected_area) {
  const double share = projected_area / defaults::small_source_area;
  if (share >= 1) return source;
  source.luminance *= share;
  source.solid_angle /= share;
  return source;
}

double ggr(double ugr, double direct, double indirect, double coverage) {
  const double of_ceiling = std::clamp(coverage, 0.15, 1.0);
  return ugr + (1.18 - 0.18 / of_ceiling) * 8 *
                   std::log10(2.55 * (1 + direct / 220) / (1 + direct / indirect));
}

double dgp(std::span<const Source> sources, double illuminance) {
  const double contrast =
      illuminance > 0 ? std::log10(1 + contrast_sum(sources) / std::pow(illuminance, 1.87)) : 0;
  return std::min(1.0, 5.87e-5 * illuminance + 0.0918 * contrast + 0.16);
}

double low_light_correction(double illuminance) {
  if (illuminance >= 1000) return 1;
  const double e = std::exp(0.024 * illuminance - 4);
  return e / (1 + e);
}

double dgi(std::span<const Source> sources, double background) {
  double sum = 0;
  for (const Source& s : sources) {
    const double weighed = s.solid_angle / (s.position_index * s.position_index);
    sum += 0.478 * std::pow(s.luminance, 1.6) * std::pow(weighed, 0.8) /
           (background + 0.07 * std::sqrt(s.solid_angle) * s.luminance);
  }
  return 10 * std::log10(sum);
}

}  // namespace photile::glare
