#include "report/false_colour.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace photile::report {
namespace {

/// Part of a step that a band takes, around its middle.
constexpr double band_begin = 0.4, band_end = 0.6;

}  // namespace

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

double ColourScale::drawn_share(double value) const {
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

std::vector<std::array<double, 2>> ColourScale::bands() const {
  std::vector<std::array<double, 2>> values;
  for (int step = 0; step < steps_; ++step) {
    values.push_back(
        {value_at((step + band_begin) / steps_), value_at((step + band_end) / steps_)});
  }
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

}  // namespace photile::report
