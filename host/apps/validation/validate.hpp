// Every analytic case, measured by photon maps and by paths.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "photile/renderer.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::validation {

/// Independent seeds of every measurement: its noise is that of their mean.
inline constexpr int seeds = 16;

/// The bound on the error, relative.
inline constexpr double tolerance = 0.01;

struct ValidationParameters {
  RenderParameters photons;  ///< for each seed; all follow from photons.seed
  int paths = 0;             ///< for each seed, shared by the sensors of a case
  bool by_photons = true, by_paths = true;
};

enum class Verdict {
  within,    ///< error and noise together are within the tolerance
  misses,    ///< beyond the tolerance, whatever the noise
  too_noisy  ///< the noise leaves it open
};

/// What one method read.
struct Measured {
  double value = 0;  ///< mean over seeds
  double error = 0;  ///< relative to what was expected
  double noise = 0;  ///< half of the 99% confidence interval of `error` (Student t)
  Verdict verdict = Verdict::too_noisy;
};

struct ValidationRow {
  std::string name, source, place;
  Quantity quantity = Quantity::illuminance;
  double expected = 0;
  std::optional<Measured> photons, paths;
};

/// Compares values of `seeds` seeds with what was expected.
Measured measured(std::span<const double> values, double expected);

/// Measures all readings of a case. Errors: those of `measure` and `measure_by_paths`.
std::vector<ValidationRow> validate(const AnalyticCase& analytic, std::span<Device> devices,
                                    const ValidationParameters& parameters, Progress& progress);

}  // namespace photile::validation
