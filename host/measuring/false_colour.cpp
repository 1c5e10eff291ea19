#include "measuring/false_colour.hpp"

#include <cmath>

namespace photile::measuring {

ColourScale::ColourScale(const FalseColour& options, double largest)
    : top_(options.scale > 0 ? options.scale : largest),
      decades_(options.decades),
      steps_(options.steps),
      palette_(options.palette) {
  if (!(top_ > 0)) top_ = 1;  // a dark grid
}

double ColourScale::share_of(double value) const {
  if (!(decades_ > 0)) return value / top_;
  return value > 0 ? 1 + std::log10(value / top_) / decades_ : 0;
}

double ColourScale::value_at(double share) const {
  return decades_ > 0 ? top_ * std::pow(10, (share - 1) * decades_) : share * top_;
}

std::vector<double> ColourScale::levels() const {
  std::vector<double> values;
  for (int step = 0; step < steps_; ++step) values.push_back(value_at((step + 0.5) / steps_));
  return values;
}

}  // namespace photile::measuring
