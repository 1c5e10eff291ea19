// The surface of a textured lamp, cut into cells of even light.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "photile/scene.hpp"

namespace photile::scene {

/// Triangles of an area light with an emission texture, each cut into congruent triangles about as
/// large as a texel. A cell's light is the mean of a few lookups in it.
class EmissionCells {
 public:
  /// References are kept. `light` has an emission texture and Light::texel_radiance, in any unit.
  EmissionCells(const Scene& scene, const Light& light);

  /// Integral of the radiance over one side of the light, per channel; times square metres.
  const glm::dvec3& integral() const { return integral_; }

  /// A point of the light's surface.
  struct Place {
    std::uint32_t triangle;  ///< into Scene::triangles
    double u, v;             ///< barycentric weights of the second and third corner
  };
  /// Numbers in [0, 1) to a place: a cell by its luminance times its area, then evenly over the
  /// cell. No cell is left out: each counts at least a fiftieth of the mean luminance.
  Place sample(double cell, double u1, double u2) const;
  /// Of `sample` at a place, per square metre.
  double density(const Place& place) const;

 private:
  struct Triangle {
    std::uint32_t cuts;  ///< of each edge; cuts^2 cells
    std::size_t first_cell;
    double cell_area;  ///< square metres
  };
  double weight(std::size_t cell) const {
    return weight_up_to_[cell] - (cell == 0 ? 0.0 : weight_up_to_[cell - 1]);
  }

  /// Of the cells [first, last), the first whose weight_up_to_ exceeds a weight; else `last`.
  std::uint32_t first_beyond(std::size_t first, std::size_t last, double weight) const;

  const Light* light_;
  std::vector<Triangle> triangles_;   ///< of the light's, in their order
  std::vector<double> weight_up_to_;  ///< of the cells up to and with this one
  /// Of 2^n equal shares of all weight, the cell in which each begins, and the number of cells:
  /// where to look for a weight (Chen and Asau's guide table, 1974). Without it half of the time
  /// of a look at a lamp with a large picture goes into a search through all cells.
  std::vector<std::uint32_t> first_of_share_;
  glm::dvec3 integral_{0.0};
};

/// Radiance of a textured light at a place, in the unit of Light::texel_radiance.
glm::dvec3 textured_radiance(const Scene& scene, const Light& light,
                             const EmissionCells::Place& place);

}  // namespace photile::scene
