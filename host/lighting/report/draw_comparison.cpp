#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "photile/errors.hpp"
#include "photile/scene.hpp"
#include "report/palette.hpp"
#include "report/picture_comparison.hpp"
#include "report/sheet.hpp"

namespace photile::report {
namespace {

// Sizes in pixels.
constexpr int legend_width = 90;
constexpr int legend_numbers = 5;
constexpr double percentile = 0.99;

const std::vector<float>& plane_of(const Image& image, const char* name) {
  const auto* plane = image.find(name);
  if (!plane) throw UsageError("a picture without channels R, G and B cannot be compared");
  return *plane;
}

double luminance_at(const Image& image, std::size_t pixel) {
  return luminance(
      {plane_of(image, "R")[pixel], plane_of(image, "G")[pixel], plane_of(image, "B")[pixel]});
}

/// At least `value`: 1, 2 or 5 times a power of ten; 1 for 0.
double rounded_up(double value) {
  if (!(value > 0) || !std::isfinite(value)) return 1;
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= value) return factor * power;
  }
  return 10 * power;
}

/// Of the pixels that see no lamp in `b`: a lamp that moved would leave nothing else to see.
double automatic_scale(const std::vector<double>& all, const Image& b) {
  const RelativeErrorWeights weights(b);
  std::vector<double> differences;
  for (std::size_t pixel = 0; pixel < all.size(); ++pixel) {
    if (weights.counts(pixel) && std::isfinite(all[pixel])) {
      differences.push_back(std::abs(all[pixel]));
    }
  }
  if (differences.empty()) return 1;
  const auto at =
      differences.begin() +
      static_cast<std::ptrdiff_t>(percentile * static_cast<double>(differences.size() - 1));
  std::nth_element(differences.begin(), at, differences.end());
  return rounded_up(*at);
}

/// Both pictures under one exposure: a above b.
Image tone_mapped(const Image& a, const Image& b, const ToneMapping& parameters) {
  Image both;
  both.width = a.width;
  both.height = a.height + b.height;
  for (const char* channel : {"R", "G", "B"}) {
    std::vector<float> plane = plane_of(a, channel);
    const std::vector<float>& other = plane_of(b, channel);
    plane.insert(plane.end(), other.begin(), other.end());
    both.add(channel) = std::move(plane);
  }
  return tone_map(both, parameters);
}

void draw_legend(Sheet& sheet, int x, int height, double scale, const Palette& palette) {
  for (int y = 0; y < height; ++y) {
    const double share = 1 - (y + 0.5) / height;
    for (int u = 0; u < bar_width; ++u) sheet.set(x + u, title_height + y, palette.at(share));
  }
  for (int i = 0; i < legend_numbers; ++i) {
    const double share = static_cast<double>(i) / (legend_numbers - 1);
    const double value = (2 * share - 1) * scale;
    const int middle = title_height + static_cast<int>((1 - share) * height);
    const int y = std::clamp(middle + Sheet::font_size / 3, title_height + Sheet::font_size,
                             title_height + height);
    sheet.write(x + bar_width + 6, y, x + legend_width, fmt::format("{:+.4g}", value));
  }
}

}  // namespace

Image draw_comparison(const Image& a, const Image& b, const ComparisonDrawing& options) {
  if (a.width != b.width || a.height != b.height) {
    throw UsageError("pictures of different sizes cannot be compared");
  }
  std::vector<double> differences(a.pixels());
  for (std::size_t i = 0; i < differences.size(); ++i) {
    differences[i] = luminance_at(a, i) - luminance_at(b, i);
  }
  const double scale = options.scale > 0 ? options.scale : automatic_scale(differences, b);
  const Palette palette("blue-red");
  const Image both = tone_mapped(a, b, options.tone_mapping);

  const int step = a.width + gap;
  Sheet sheet(3 * step + legend_width, title_height + a.height + gap);
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) +
                         static_cast<std::size_t>(x);
      for (int panel = 0; panel < 2; ++panel) {
        const std::size_t at = pixel + (panel == 0 ? 0 : a.pixels());
        sheet.set(panel * step + x, title_height + y,
                  std::array{both.channels[0][at], both.channels[1][at], both.channels[2][at]});
      }
      sheet.set(2 * step + x, title_height + y, palette.at(0.5 + 0.5 * differences[pixel] / scale));
    }
  }
  constexpr int baseline = title_height - 7;
  sheet.write(2, baseline, step, options.name_a);
  sheet.write(step + 2, baseline, 2 * step, options.name_b);
  sheet.write(2 * step + 2, baseline, 3 * step + legend_width, "first - second, " + options.unit);
  draw_legend(sheet, 3 * step, a.height, scale, palette);
  return sheet.take();
}

}  // namespace photile::report
