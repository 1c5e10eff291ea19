#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "image/pixel_lights.hpp"
#include "image/srgb.hpp"
#include "photile/errors.hpp"
#include "photile/image.hpp"
#include "photile/scene.hpp"

namespace photile {
namespace {

constexpr double mid_grey = 0.18;  ///< reflectance of a photographer's grey card

/// Luminances farther than this factor from the median say nothing about the room: a lamp seen
/// directly, a black background.
constexpr double outlier_factor = 20.0;

struct RootPlanes {
  const std::vector<float>&r, &g, &b;
  glm::dvec3 operator[](std::size_t pixel) const { return {r[pixel], g[pixel], b[pixel]}; }
};

RootPlanes root_of(const Image& image) {
  const std::vector<float>*r = image.find("R"), *g = image.find("G"), *b = image.find("B");
  if (!r || !g || !b) {
    throw InputError("the picture has no channels R, G and B to show; relight it first");
  }
  return {*r, *g, *b};
}

void check_exposure(double stops) {
  if (!std::isfinite(stops)) throw UsageError("exposure must be a finite number of stops");
}

/// DisplayView::standard of values from 0 to `brightest`.
glm::dvec3 standard(const glm::dvec3& rgb) {
  const double largest = std::max({rgb.r, rgb.g, rgb.b});
  return largest > 1.0 ? rgb / largest : rgb;
}

/// DisplayView::neutral of values from 0 to `brightest`. Names are those of the specification.
glm::dvec3 neutral(const glm::dvec3& rgb) {
  constexpr double f90 = 0.04, ks = 0.8 - f90, kd = 0.15;
  const double x = std::min({rgb.r, rgb.g, rgb.b});
  const double f = x <= 2 * f90 ? x - x * x / (4 * f90) : f90;
  const glm::dvec3 base = rgb - f;
  const double p = std::max({base.r, base.g, base.b});
  if (p <= ks) return base;
  const double pn = 1 - (1 - ks) * (1 - ks) / (p + 1 - 2 * ks);
  const double g = 1 / (kd * (p - pn) + 1);
  return glm::mix(glm::dvec3(pn), base * (pn / p), g);
}

/// Into [0,1].
glm::dvec3 displayed(glm::dvec3 rgb, DisplayView view) {
  constexpr double brightest = 1e30;  // for infinities: as bright as any, and fit to compute with
  for (int channel = 0; channel < 3; ++channel) {
    double& value = rgb[channel];
    value = value > 0.0 ? std::min(value, brightest) : 0.0;  // NaN too
  }
  // Rounding may leave a little more than 1, or less than 0.
  return glm::clamp(view == DisplayView::neutral ? neutral(rgb) : standard(rgb), 0.0, 1.0);
}

}  // namespace

std::vector<std::uint8_t> image::tone_mapped_texels(std::span<const glm::vec3> rgb, double exposure,
                                                    DisplayView view) {
  check_exposure(exposure);
  const double scale = std::exp2(exposure);
  std::vector<std::uint8_t> texels(3 * rgb.size());
  for_each_pixel(rgb.size(), [&](std::size_t pixel) {
    const glm::dvec3 shown = displayed(scale * glm::dvec3(rgb[pixel]), view);
    for (int channel = 0; channel < 3; ++channel) {
      texels[3 * pixel + static_cast<std::size_t>(channel)] =
          srgb8_from_linear(static_cast<float>(shown[channel]));
    }
  });
  return texels;
}

std::string_view name_of(DisplayView view) {
  switch (view) {
    case DisplayView::neutral:
      return "neutral";
    case DisplayView::standard:
      return "standard";
  }
  return "unknown";
}

double automatic_exposure(const Image& scene_referred) {
  const RootPlanes root = root_of(scene_referred);
  std::vector<double> luminances;
  for (std::size_t pixel = 0; pixel < root.r.size(); ++pixel) {
    const double value = luminance(root[pixel]);
    if (value > 0.0 && std::isfinite(value)) luminances.push_back(value);
  }
  if (luminances.empty()) return 1.0;
  const auto middle = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() / 2);
  std::nth_element(luminances.begin(), middle, luminances.end());
  const double median = *middle;

  double sum_of_logs = 0.0;
  std::size_t count = 0;
  for (const double value : luminances) {
    if (value > outlier_factor * median || value < median / outlier_factor) continue;
    sum_of_logs += std::log(value);
    ++count;
  }
  return mid_grey / std::exp(sum_of_logs / static_cast<double>(count));
}

Image tone_map(const Image& scene_referred, const ToneMapping& parameters) {
  check_exposure(parameters.exposure);
  const RootPlanes root = root_of(scene_referred);
  const double scale = std::exp2(parameters.exposure) *
                       (parameters.automatic_exposure ? automatic_exposure(scene_referred) : 1.0);

  Image display;
  display.width = scene_referred.width;
  display.height = scene_referred.height;
  for (const char* channel : {"R", "G", "B"}) display.add(channel);
  image::for_each_pixel(root.r.size(), [&](std::size_t pixel) {
    const glm::dvec3 rgb = displayed(scale * root[pixel], parameters.view);
    for (int channel = 0; channel < 3; ++channel) {
      display.channels[static_cast<std::size_t>(channel)][pixel] = static_cast<float>(rgb[channel]);
    }
  });
  return display;
}

}  // namespace photile
