// Every analytic case, measured by photon maps and by paths.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "photile/renderer.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::validation {

/// Independent seeds of every measurement: its noise is that of their mean. A case takes more than
/// the fewest until all of its readings are within the tolerance or miss it.
inline constexpr int fewest_seeds = 16, most_seeds = 1024;

/// The bound on the error, relative.
inline constexpr double tolerance = 0.01;

struct ValidationParameters {
  RenderParameters photons;  ///< for each seed; all follow from photons.seed
  int paths = 0;             ///< for each seed, shared by the sensors of a case
  bool by_photons = true, by_paths = true;
  int most_seeds = validation::most_seeds;
};

enum class Verdict {
  within,    ///< error and noise together are within the tolerance
  misses,    ///< beyond the tolerance, whatever the noise
  too_noisy  ///< the noise leaves it open
};

/// The reading of one method.
struct Measured {
  double value = 0;  ///< mean over seeds
  double error = 0;  ///< relative to what was expected
  double noise = 0;  ///< half of the 99% confidence interval of `error` (Student t)
  int seeds = 0;
  Verdict verdict = Verdict::too_noisy;
};

struct ValidationRow {
  std::string name, source, place;
  Quantity quantity = Quantity::illuminance;
  double expected = 0;
  std::optional<Measured> photons, paths;
};

/// Student's t that 1% of a normal mean's deviations exceed, on either side: its expansion in
/// `freedom`, the degrees of freedom, which is right to 1e-3 from 8 on (Abramowitz and Stegun,
/// "Handbook of mathematical functions", 26.7.5).
double student_t_99(int freedom);

/// Compares the values of some seeds with what was expected.
Measured measured(std::span<const double> values, double expected);

/// How many seeds are likely to decide whether all of these are within the tolerance, from the
/// noise of the seeds so far; at most twice as many. 0 where it is decided.
int seeds_to_tell(std::span<const Measured> readings);

/// Measures all readings of a case. Errors: those of `measure` and `measure_by_paths`.
std::vector<ValidationRow> validate(const AnalyticCase& analytic, std::span<Device> devices,
                                    const ValidationParameters& parameters, Progress& progress);

}  // namespace photile::validation
