// Light at points by batches of rays, whose scatter is its error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "light/row_sum.hpp"
#include "photile/defaults.hpp"
#include "photile/light_table.hpp"
#include "photile/scene.hpp"

namespace photile::cache {

/// Writes the rows of points one after another. Sums run in the order of the calls.
class BatchSums {
 public:
  /// The reference is kept.
  ///   caustics   whether add_to_all is called at all
  ///   table      without rows
  BatchSums(const SceneNeeds& needs, int batches, bool caustics, LightTable& table);

  /// Before anything is added to a point of this unit normal, in scenes with smooth shading.
  void begin_point(const glm::vec3& normal) { normal_ = normal; }

  /// Light of a layer at power 1, W/m2 or lm/m2, that one batch found: a light in this direction.
  void add_light(std::uint32_t layer, std::uint32_t batch, const glm::vec3& irradiance,
                 const glm::vec3& direction) {
    Sums& sums = add(layer, batch, irradiance);
    if (smooth_) add_by_normal(sums, irradiance, direction, 0.0f, no_bound);
  }
  /// Adds surface hit by a ray with the density of the cosine; it is likely to continue below the
  /// horizon of the point.
  void add_surface(std::uint32_t layer, std::uint32_t batch, const glm::vec3& irradiance,
                   const glm::vec3& direction) {
    Sums& sums = add(layer, batch, irradiance);
    if (smooth_) add_by_normal(sums, irradiance, direction, 0.5f, defaults::most_inverse_cosine);
  }
  /// Adds light from no known direction, the same for every normal.
  void add_even(std::uint32_t layer, std::uint32_t batch, const glm::vec3& irradiance) {
    Sums& sums = add(layer, batch, irradiance);
    if (smooth_) sums.by_normal.w += static_cast<float>(luminance(glm::dvec3(irradiance)));
  }

  /// Adds light that no batch has to find, in the same way.
  ///   relative_variance   of it
  void add_to_all(std::uint32_t layer, const glm::vec3& irradiance, double relative_variance);

  /// Writes the point; the next one begins.
  void end_point();

 private:
  static constexpr float no_bound = std::numeric_limits<float>::infinity();

  /// Sums of one layer, besides what each batch found.
  struct Sums {
    glm::vec4 by_normal{0.0f};
    double shared_variance = 0;
  };

  Sums& add(std::uint32_t layer, std::uint32_t batch, const glm::vec3& irradiance) {
    of_batches_[std::size_t{layer} * batches_ + batch] += irradiance;
    return sums_.of(layer);
  }
  void add_by_normal(Sums& sums, const glm::vec3& irradiance, const glm::vec3& direction,
                     float even, float most_inverse_cosine) const;

  bool caustics_, smooth_;
  std::size_t batches_;
  LightTable& table_;
  glm::vec3 normal_{0.0f};
  light::RowSum<Sums> sums_;
  std::vector<glm::vec3> of_batches_;  ///< [layer][batch]
};

}  // namespace photile::cache
