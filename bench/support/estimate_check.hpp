// What a bench times, held against the double-precision oracle of the tests.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "oracle/clipped_area.hpp"
#include "oracle/density_oracle.hpp"
#include "photile/estimator.hpp"

namespace photile::bench {

/// The estimate that is timed.
struct TimedEstimate {
  int k = 0;
  double radius = 0;                                ///< metres
  const reference::ClippedArea* surface = nullptr;  ///< what discs are clipped to; null: whole ones
  DensityKernel kernel = DensityKernel::constant;
};

/// Irradiance and radius at some hits, by the oracle.
class EstimateCheck {
 public:
  /// Evaluates the oracle at some of the hits of `index`, the fewer the more photons there are:
  /// each goes through all of them.
  ///   index   of hits that every timed call estimates, ascending
  EstimateCheck(const reference::DensityOracle& oracle, std::size_t photons,
                const TimedEstimate& estimate, const PrimaryHits& hits,
                std::span<const std::uint32_t> index);
  /// At some of all hits.
  EstimateCheck(const reference::DensityOracle& oracle, std::size_t photons,
                const TimedEstimate& estimate, const PrimaryHits& hits);

  /// How much of what an estimator found at all hits is not the oracle's. Says so in a line.
  ///   timed   names the case in that line
  std::uint64_t count_faults(const std::string& timed, Estimator& estimator,
                             const LightTable& estimates) const;

  /// The hits that are checked, ascending.
  const std::vector<std::uint32_t>& index() const { return index_; }

  /// How many of them have another irradiance for some light. Hits whose last photon ties with the
  /// next are left out.
  ///   irradiance   [hit][light] of the hits `of`, ascending; empty: of all hits
  std::uint64_t irradiances_that_differ(std::span<const glm::vec3> irradiance,
                                        std::span<const std::uint32_t> of = {}) const;

  /// How many of them have another radius.
  ///   squared_radius   of the hits `of`, ascending; empty: of all hits
  std::uint64_t radii_that_differ(std::span<const float> squared_radius,
                                  std::span<const std::uint32_t> of = {}) const;

 private:
  struct Truth {
    bool tied = false;
    double squared_radius = 0;
    std::vector<glm::dvec3> irradiance, tolerance;  ///< per light
  };

  std::vector<std::uint32_t> index_;
  PrimaryHits hits_;           ///< of each, as Estimator::nearest needs them
  std::vector<Truth> truths_;  ///< of each
};

/// Prints the line of a bench whose results are wrong.
///   differences   > 0
void print_fault(const std::string& timed, std::uint64_t differences);

}  // namespace photile::bench
