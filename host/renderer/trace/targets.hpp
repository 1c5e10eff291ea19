// Where mirrors and glass are, for photons that are aimed at them.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "photile/scene.hpp"

namespace photile::trace {

/// A few spheres that hold all mirrors and glass of a scene. Every path to a caustic begins with a
/// straight line to one of them, so that paths which are aimed at them, and carry their flux over
/// the density of their line, find the same light as paths in all directions: Jensen's projection
/// maps ("Global illumination using photon maps", 1996) with spheres in place of cells.
class Targets {
 public:
  explicit Targets(const Scene& scene);

  /// Whether there are no mirrors and no glass.
  bool empty() const { return spheres_.empty(); }

  struct Direction {
    glm::vec3 direction;  ///< unit
    double density;       ///< per steradian, of this direction among all that could be sampled
  };
  /// From a point into one of the cones of the spheres, each in proportion to its solid angle times
  /// the largest cosine in it; evenly in a cone. From within a sphere in all directions, by the
  /// cosine law where there is a normal. No density where no sphere rises above the horizon.
  ///   normal   of the surface that emits by the cosine law; null: all cosines count 1
  ///   u        in [0, 1)^2: points that fill it evenly give directions that do
  Direction direction_from(const glm::dvec3& from, const glm::vec3* normal, glm::dvec2 u) const;

  struct Line {
    glm::dvec3 point;  ///< on the line, beside the middle of a sphere
    double density;    ///< per square metre across the lines
  };
  /// A line along `travel`, unit, evenly over the disc that one of the spheres shows, each in
  /// proportion to its disc.
  Line line_along(const glm::dvec3& travel, glm::dvec2 u) const;

 private:
  struct Sphere {
    glm::dvec3 centre;
    double radius;
  };
  std::vector<Sphere> spheres_;
};

}  // namespace photile::trace
