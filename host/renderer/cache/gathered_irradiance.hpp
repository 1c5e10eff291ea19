// Irradiance at points of surfaces, per light, with what is known of its error, and the sums of
// light and batch that it is made from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "estimate/lit_lights.hpp"
#include "photile/defaults.hpp"
#include "photile/estimator.hpp"
#include "photile/scene.hpp"

namespace photile::cache {

/// Each value is the mean of batches that are independent of each other. They are kept, so that the
/// error of any mix of lights is known, and that of what is averaged over points.
struct GatheredIrradiance {
  static constexpr int max_batches = 64;

  /// Irradiance alone, each layer at power 1, in the form of Estimates.
  Estimates mean;
  int batches = 0;
  /// Luminance that each batch alone gives, row-major [estimate][batch].
  std::vector<float> batch;
  /// Variance of the luminance that all batches share, of caustics; empty where there are none.
  std::vector<float> shared_variance;

  std::uint64_t bytes() const;

  std::size_t points(std::size_t lights) const {
    return mean.first.empty() ? mean.irradiance.size() / lights : mean.first.size() - 1;
  }

  /// Standard error of the luminance of one estimate.
  double error(std::size_t estimate) const;
  /// Standard error by which it may differ from a point beside it that sees the same light: of the
  /// error that batches share the part `defaults::aimed_noise`.
  double scatter(std::size_t estimate) const;

  /// Luminance of all lights together, and the error by which it may differ from a point beside it.
  struct Total {
    double luminance = 0, error = 0;
  };
  /// At a point, with these powers of the layers.
  Total total(std::size_t point, std::span<const double> layer_powers) const;

  /// Appends what `other` has of one of its points.
  void append(const GatheredIrradiance& other, std::size_t point, std::size_t lights);
  /// Appends all points of `other`, which has as many batches.
  void append(GatheredIrradiance other);

 private:
  double error(std::size_t estimate, double of_shared) const;
};

/// Light of two kinds, or found twice, at the same points, whose batches are as many.
///   share_a, share_b   what each counts
GatheredIrradiance sum_of(const GatheredIrradiance& a, const GatheredIrradiance& b,
                          std::size_t lights, float share_a = 1, float share_b = 1);

/// Writes points one after another. Sums run in the order of the calls.
class BatchSums {
 public:
  /// References are kept. `result` is empty.
  ///   caustics   whether add_to_all is called at all
  BatchSums(const SceneNeeds& needs, int batches, bool caustics, GatheredIrradiance& result);

  /// Before anything is added to a point of this unit normal, in scenes with smooth shading.
  void begin_point(const glm::vec3& normal) { normal_ = normal; }

  /// Light of a layer at power 1, W/m2 or lm/m2, that one batch found: a light in this direction.
  void add_light(std::uint32_t layer, std::uint32_t batch, const glm::vec3& irradiance,
                 const glm::vec3& direction) {
    add(layer, batch, irradiance);
    if (smooth_) add_by_normal(layer, irradiance, direction, 0.0f, no_bound);
  }
  /// Adds surface, met by a ray with the density of the cosine, which is likely to go on beyond the
  /// horizon of the point.
  void add_surface(std::uint32_t layer, std::uint32_t batch, const glm::vec3& irradiance,
                   const glm::vec3& direction) {
    add(layer, batch, irradiance);
    if (smooth_) add_by_normal(layer, irradiance, direction, 0.5f, defaults::most_inverse_cosine);
  }
  /// Adds light from no known direction, the same for every normal.
  void add_even(std::uint32_t layer, std::uint32_t batch, const glm::vec3& irradiance) {
    add(layer, batch, irradiance);
    if (smooth_) by_normal_[layer].w += static_cast<float>(luminance(glm::dvec3(irradiance)));
  }

  /// Light that no batch has to find, likewise.
  ///   relative_variance   of it
  void add_to_all(std::uint32_t layer, const glm::vec3& irradiance, double relative_variance);

  /// Writes the point; the next one begins.
  void end_point();

 private:
  static constexpr float no_bound = std::numeric_limits<float>::infinity();

  void add(std::uint32_t layer, std::uint32_t batch, const glm::vec3& irradiance) {
    lit_.add(layer);
    sums_[std::size_t{layer} * batches_ + batch] += irradiance;
  }
  void add_by_normal(std::uint32_t layer, const glm::vec3& irradiance, const glm::vec3& direction,
                     float even, float most_inverse_cosine);
  void write(std::uint32_t layer);

  bool sparse_, caustics_, smooth_;
  std::size_t batches_;
  GatheredIrradiance& result_;
  glm::vec3 normal_{0.0f};
  std::vector<glm::vec3> sums_;       ///< [layer][batch]
  std::vector<glm::vec4> by_normal_;  ///< [layer], of all batches; empty without smooth shading
  std::vector<double> shared_variance_;
  estimate::LitLights lit_;
};

}  // namespace photile::cache
