#include "trace/lamp_intensity.hpp"

#include <algorithm>

namespace photile::trace {

IntensitySampler::IntensitySampler(const Scene& scene, const Light& light)
    : distribution_(&scene.distributions[light.distribution]), axes_(light) {
  double flux = 0;
  flux_up_to_.reserve(distribution_->columns() * distribution_->rows());
  for (std::size_t column = 0; column < distribution_->columns(); ++column)
    for (std::size_t row = 0; row < distribution_->rows(); ++row)
      flux_up_to_.push_back(flux += distribution_->cell_flux(column, row));
}

glm::vec3 IntensitySampler::sample(const RandomStream& random) const {
  const double target = random.block(Purpose::emission, 0).uniform_double(0) * flux_up_to_.back();
  // The last entry is larger than the target, so there always is one.
  const auto chosen = static_cast<std::size_t>(
      std::upper_bound(flux_up_to_.begin(), flux_up_to_.end(), target) - flux_up_to_.begin());
  const std::size_t column = chosen / distribution_->rows(), row = chosen % distribution_->rows();
  const double largest = distribution_->cell_maximum(column, row);
  for (std::uint32_t tries = 1;; ++tries) {
    const RandomBlock numbers = random.block(Purpose::emission, tries);
    const auto place =
        distribution_->in_cell(column, row, numbers.uniform_double(0), numbers.uniform(2));
    if (numbers.uniform(3) * largest < place.intensity)
      return glm::vec3(axes_.to_world(place.direction));
  }
}

}  // namespace photile::trace
