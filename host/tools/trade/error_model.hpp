// Fits ErrorModel to what quick renderings show.
#pragma once

#include <span>
#include <vector>

#include "tools/trade/quality_target.hpp"

namespace photile::trade {

/// Squared differences of pictures by photons of two independent seeds, relative as in
/// PictureError::relative_mse.
struct PilotErrors {
  std::vector<double> neighbours;  ///< the k, ascending
  std::vector<double> variance;    ///< per k: half the squared difference of the seeds
  /// [i][j]: the product over seeds of the differences between k i and k j. Noise drops out of its
  /// mean: what is left is the squared difference of the biases.
  std::vector<std::vector<double>> squared_bias_difference;
  double photons = 0;  ///< emitted
  double samples = 1;  ///< per pixel
};

ErrorModel fit_error_model(const PilotErrors& pilot);

}  // namespace photile::trade
