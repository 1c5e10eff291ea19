// Removes noise from irradiance at points that see nearly the same: each becomes the mean of itself
// and its neighbours, as far as their light may differ by noise alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "common/index_rows.hpp"
#include "photile/defaults.hpp"
#include "photile/light_table.hpp"

namespace photile::cache {

/// The differences that count as noise.
struct NoiseTolerance {
  /// At differences of this many standard errors the weight falls to 1 / e.
  double errors = defaults::tolerated_errors;
  /// Where one standard error is larger than this many times the other, the two count less, by the
  /// square of what is more: they do not see the same light.
  double ratio = std::numeric_limits<double>::infinity();
  /// The ratio counts only where the smaller error is at most this fraction of the light it is of:
  /// where few rays or none found light, the error is unknown.
  double known = defaults::known_error;
};

/// Which points are neighbours on one surface: those that each is linked to. The caller decides
/// what one surface is.
struct PointLinks : IndexRows {
  std::vector<glm::vec3> position;  ///< of each point
};

struct IrradianceFilterParameters {
  int rounds = 8;  ///< light spreads over one link a round
  NoiseTolerance tolerated = {};
};

/// Replaces each point's light by the mean of it and its neighbours', weighted by
/// exp(-d^2 / (t^2 (se_a^2 + se_b^2))), d the difference of luminance, se its standard errors and t
/// those that are tolerated, and less where these differ more than is tolerated, a few times over.
/// Where a layer differs by more than its own noise, this weight is used for that layer alone:
/// otherwise the border of the sun would leave the noise of lights in their layers. All other
/// layers use the weight of their sum at `layer_powers`. Where neighbours lie to one side, as where
/// surface ends, nearer ones get more weight, as far as light changes along it: their mean is then
/// that of a plane through them, at the point (a regression of the first order, as in Bitterli et
/// al. 2016 for pixels). All batches of a layer have the same weights, so that errors remain known
/// afterwards. Points without error change only by points that are equal. Does not depend on
/// threads, nor on whether they flush denormal numbers.
LightTable filter_irradiance(LightTable irradiance, const PointLinks& links,
                             std::span<const double> layer_powers,
                             const IrradianceFilterParameters& parameters = {});

/// One round of the same for only some of the points, without the plane.
///   rows     of `irradiance`: the points that links and `chosen` count
///   chosen   of these; the result has a row for each
LightTable means_with_neighbours(const LightTable& irradiance, std::span<const std::uint32_t> rows,
                                 const PointLinks& links, std::span<const std::uint32_t> chosen,
                                 std::span<const double> layer_powers,
                                 const NoiseTolerance& tolerated);

/// Points with their light and its standard errors, of each layer and of all at their powers: each
/// point is compared with many others, and its errors are found once.
class KnownPoints {
 public:
  /// Keeps a reference.
  ///   rows   the points of `irradiance`, which are counted in this order
  KnownPoints(const LightTable& irradiance, std::vector<std::size_t> rows,
              std::span<const double> layer_powers);
  /// All points of `irradiance`.
  KnownPoints(const LightTable& irradiance, std::span<const double> layer_powers);

  const LightTable& irradiance() const { return irradiance_; }
  std::size_t row(std::size_t point) const { return rows_[point]; }
  const LightTable::Total& all(std::size_t point) const { return all_[point]; }
  /// Calls visit(layer, its light at power 1) for the layers that a point has.
  template <class Visit>
  void for_each_layer(std::size_t point, const Visit& visit) const {
    std::size_t next = first_[point];
    irradiance_.for_each(rows_[point],
                         [&](std::size_t layer, std::size_t) { visit(layer, layers_[next++]); });
  }

 private:
  const LightTable& irradiance_;
  std::vector<std::size_t> rows_, first_;
  std::vector<LightTable::Total> all_, layers_;
};

}  // namespace photile::cache
