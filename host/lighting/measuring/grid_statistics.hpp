// What standards ask of a grid's illuminances, with what the noise of a measurement leaves open.
#pragma once

#include <span>
#include <vector>

#include "photile/sensors.hpp"

namespace photile::measuring {

/// Mean and standard error at each sensor.
///   repeats   per repeat the values of all sensors; at least 2
std::vector<Measured> means_of(std::span<const std::vector<float>> repeats);

/// Of the sensors first .. first + count - 1. Standard errors are those of the jackknife over
/// repeats (Tukey, "Bias and confidence in not-quite large samples", 1958), which knows that
/// sensors share photons. It holds the darkest and the brightest sensor of all repeats: a jackknife
/// that chose them anew would converge to nothing where several are nearly as dark. The square of
/// the error of a minimum is then the variance of the reading of the sensor that looks darkest. In
/// the mean that is the variance of the minimum where one sensor is darkest in all measurements,
/// and an upper bound of it where noise chooses (Poincare's inequality for normal readings, whether
/// they are correlated or not). It says nothing of the bias, which the next two figures bound.
struct GridStatistics {
  Measured mean;        ///< Em
  Measured minimum;     ///< Emin: the least of the sensors' means
  Measured maximum;     ///< Emax
  Measured uniformity;  ///< Uo = Emin / Em
  Measured diversity;   ///< Ud = Emin / Emax
  /// The minimum of noisy values is low and their maximum high. These are what the sensors that
  /// look darkest (brightest) to all repeats but one read in that one: high (low) if anything. The
  /// truth lies between minimum and minimum_at_most, maximum_at_least and maximum, up to their
  /// standard errors.
  double minimum_at_most = 0;
  double maximum_at_least = 0;
};
GridStatistics statistics_of(std::span<const std::vector<float>> repeats, std::size_t first,
                             std::size_t count);

}  // namespace photile::measuring
