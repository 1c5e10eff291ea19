#include "render/pass_schedule.hpp"

#include <algorithm>
#include <cmath>

#include "photile/defaults.hpp"

namespace photile {
namespace {

/// Squared radius of pass `pass` over that of the first.
double shrinkage(int pass) {
  double product = 1;
  for (int i = 1; i <= pass; ++i) product *= (i + defaults::pass_alpha) / (i + 1);
  return product;
}

}  // namespace

PassEstimate estimate_of_pass(int pass, const PassEstimate& first) {
  const double factor = shrinkage(pass);
  const int least = std::min(first.neighbours, defaults::least_pass_neighbours);
  const auto neighbours = static_cast<int>(std::lround(first.neighbours * factor));
  return {first.radius * std::sqrt(factor), std::max(neighbours, least)};
}

}  // namespace photile
