#include "report/false_colour.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "image/display.hpp"
#include "image/light_layers.hpp"
#include "photile/errors.hpp"
#include "photile/scene.hpp"
#include "report/sheet.hpp"
#include "report/tables.hpp"

namespace photile::report {

namespace {

/// Part of a step that a band takes, around its middle.
constexpr double band_begin = 0.4, band_end = 0.6;

}  // namespace

double rounded_top(double top, int steps) {
  if (!(top > 0)) return top;
  return rounded_up(top / steps, {1.0, 1.2, 1.6, 2.0, 3.0, 4.0, 6.0, 8.0}) * steps;
}

double automatic_top(std::span<const float> values) {
  constexpr double share_above = 0.02;
  std::vector<float> known;
  std::copy_if(values.begin(), values.end(), std::back_inserter(known),
               [](float value) { return std::isfinite(value) && value > 0; });
  if (known.empty()) return 0;
  const auto above = static_cast<std::size_t>(share_above * static_cast<double>(known.size()));
  const auto top = known.begin() + static_cast<std::ptrdiff_t>(known.size() - 1 - above);
  std::nth_element(known.begin(), top, known.end());
  return static_cast<double>(*top);
}

ColourScale::ColourScale(const FalseColour& options, double automatic)
    : top_(options.scale > 0 ? options.scale : automatic),
      decades_(options.decades),
      steps_(options.steps),
      stepped_(options.contours == Contours::steps),
      palette_(options.palette) {
  if (!(top_ > 0)) top_ = 1;  // a dark grid
}

double ColourScale::share_of(double value) const {
  if (!(decades_ > 0)) return value / top_;
  return value > 0 ? 1 + std::log10(value / top_) / decades_ : 0;
}

double ColourScale::drawn_fraction(double value) const {
  const double share = share_of(value);
  if (!stepped_ || std::isnan(share)) return share;
  return (std::floor(std::clamp(share, 0.0, 1.0 - 1e-9) * steps_) + 0.5) / steps_;
}

double ColourScale::value_at(double share) const {
  return decades_ > 0 ? top_ * std::pow(10, (share - 1) * decades_) : share * top_;
}

std::vector<double> ColourScale::levels() const {
  std::vector<double> values;
  for (int step = 0; step < steps_; ++step) values.push_back(value_at((step + 0.5) / steps_));
  return values;
}

bool ColourScale::in_band(double value) const {
  const double share = share_of(value);
  if (!(share > 0) || !(share < 1)) return false;
  const double part = share * steps_ - std::floor(share * steps_);
  return part > band_begin && part < band_end;
}

int ColourScale::levels_below(double value) const {
  const double below = std::floor(share_of(value) * steps_ + 0.5);
  return std::isnan(below) ? 0 : static_cast<int>(std::clamp(below, 0.0, steps_ + 0.0));
}

namespace {

// Sizes in pixels.
constexpr int least_step = 16;

/// Bars of the legend's steps with the values of their middles, the largest at the top.
struct Legend {
  std::string label;
  std::vector<std::pair<std::array<std::uint8_t, 3>, std::string>> steps;

  Legend(const FalseColour& options, const ColourScale& scale) : label(options.label) {
    for (const double level : scale.levels()) {
      steps.emplace_back(scale.rgb(level), number_text(level, 4));
    }
    std::reverse(steps.begin(), steps.end());
  }

  int width() const {
    int widest = Sheet::width_of(label);
    for (const auto& [colour, value] : steps) {
      widest = std::max(widest, bar_width + gap / 2 + Sheet::width_of(value));
    }
    return std::max(widest, bar_width) + gap;
  }
  int least_height() const { return title_height + static_cast<int>(steps.size()) * least_step; }

  void draw(Sheet& sheet, int x, int height, int sheet_width) const {
    sheet.write(x, title_height - 7, sheet_width, label);
    const auto edge = [&](std::size_t step) {
      return title_height +
             static_cast<int>(step * static_cast<std::size_t>(height - title_height) /
                              steps.size());
    };
    for (std::size_t step = 0; step < steps.size(); ++step) {
      const auto& [colour, value] = steps[step];
      for (int y = edge(step); y < edge(step + 1); ++y) {
        for (int u = 0; u < bar_width; ++u) sheet.set(x + u, y, colour);
      }
      const int middle = (edge(step) + edge(step + 1)) / 2;
      sheet.write(x + bar_width + gap / 2, middle + Sheet::font_size / 3, sheet_width, value);
    }
  }
};

}  // namespace

std::vector<float> illuminance_of(const LayeredPicture& picture) {
  constexpr int rows_per_read = 64;  // of a picture of many lights, little is in memory
  const int height = picture.header().height;
  const auto width = static_cast<std::size_t>(picture.header().width);
  std::vector<double> sums(picture.header().pixels());
  for (int first = 0; first < height; first += rows_per_read) {
    for (std::size_t light = 0; light < picture.lights(); ++light) {
      const LightRows rows = picture.read(light, first, std::min(first + rows_per_read, height));
      if (rows.illuminance.empty()) {
        const std::string channel = picture.channel_names(light).front();  // Combined_LIGHT.R
        throw InputError(
            fmt::format("the picture has channel {} but no illuminance; render it with photile, or "
                        "leave out --illuminance",
                        channel));
      }
      const std::size_t offset = static_cast<std::size_t>(first) * width;
      for (std::size_t i = 0; i < rows.illuminance.size(); ++i) {
        sums[offset + i] += static_cast<double>(rows.illuminance[i]);
      }
    }
  }
  return {sums.begin(), sums.end()};
}

std::vector<float> luminance_of(const Image& picture) {
  const auto white = picture.numbers.find("whiteLuminance");
  const std::vector<float>*r = picture.find("R"), *g = picture.find("G"), *b = picture.find("B");
  if (white == picture.numbers.end() || !r || !g || !b) {
    throw InputError(
        "the picture lacks R, G, B or the attribute whiteLuminance, which states cd/m2; render it "
        "with photile, or leave out --luminance");
  }
  std::vector<float> values(picture.pixels());
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<float>(static_cast<double>(white->second) *
                                   luminance({(*r)[i], (*g)[i], (*b)[i]}));
  }
  return values;
}

void draw_false_colour(std::span<const float> values, int width, const FalseColour& options,
                       std::span<std::uint8_t> rgb) {
  const ColourScale scale(options, automatic_top(values));
  const auto columns = static_cast<std::size_t>(width);
  const auto value_at = [&](std::size_t pixel) { return static_cast<double>(values[pixel]); };
  const auto on_line = [&](std::size_t pixel) {
    const int level = scale.levels_below(value_at(pixel));
    const bool right =
        (pixel + 1) % columns != 0 && scale.levels_below(value_at(pixel + 1)) != level;
    const bool below =
        pixel + columns < values.size() && scale.levels_below(value_at(pixel + columns)) != level;
    return right || below;
  };
  image::for_each_pixel(values.size(), [&](std::size_t pixel) {
    if (options.contours == Contours::lines && !on_line(pixel)) return;
    if (options.contours == Contours::bands && !scale.in_band(value_at(pixel))) return;
    const auto colour = scale.rgb(value_at(pixel));
    std::copy(colour.begin(), colour.end(), rgb.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
  });
}

Image false_colour_picture(std::span<const float> values, const Image& displayed,
                           const FalseColour& options) {
  std::vector<std::uint8_t> rgb = image::srgb8_texels(displayed);
  draw_false_colour(values, displayed.width, options, rgb);
  const Legend legend(options, ColourScale(options, automatic_top(values)));
  const int left = displayed.width + gap, width = left + legend.width();
  const int height = std::max(displayed.height, legend.least_height());
  Sheet sheet(width, height);
  for (int y = 0; y < displayed.height; ++y) {
    for (int x = 0; x < displayed.width; ++x) {
      const std::size_t texel =
          3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(displayed.width) +
               static_cast<std::size_t>(x));
      sheet.set(x, y, std::array{rgb[texel], rgb[texel + 1], rgb[texel + 2]});
    }
  }
  legend.draw(sheet, left, height, width);
  return sheet.take();
}

}  // namespace photile::report
