// Targets of photons and rays: mirrors and glass, and bright surface.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "photile/scene.hpp"

namespace photile::trace {

/// A few spheres at which paths are aimed. Aimed photons and rays carry their flux, or their light,
/// divided by the density of the line: Jensen's projection maps ("Global illumination using photon
/// maps", 1996) with spheres in place of cells.
class Targets {
 public:
  struct Sphere {
    glm::dvec3 centre;
    double radius;
    double brightness = 1;  ///< times its solid angle: how often it is chosen
  };
  static constexpr std::size_t most_spheres = 64;

  /// The first `most_spheres` of them.
  explicit Targets(std::vector<Sphere> spheres);

  bool empty() const { return spheres_.empty(); }

  struct Line {
    glm::dvec3 point;  ///< on the line, beside the middle of a sphere
    double density;    ///< per square metre across the lines
  };
  /// A line along `travel`, unit, evenly over the disc of one of the spheres, chosen in proportion
  /// to its disc.
  Line line_along(const glm::dvec3& travel, glm::dvec2 u) const;

 private:
  friend class Aim;
  std::vector<Sphere> spheres_;
};

/// A few spheres that hold all mirrors and glass of a scene; none without such. Every path to a
/// caustic begins with a straight line to one of them.
Targets specular_targets(const Scene& scene);

/// Directions from a point to targets.
class Aim {
 public:
  /// The normal is kept as a reference. Directions lie in the cones of the spheres, chosen in
  /// proportion to brightness, solid angle and the largest cosine in the cone, and evenly within a
  /// cone. From within a sphere they go in all directions, by the cosine law where there is a
  /// normal.
  ///   normal   unit, of a surface that sends or receives light by the cosine law; null: all
  ///            cosines count as 1
  Aim(const Targets& targets, const glm::dvec3& from, const glm::vec3* normal);

  /// Whether some target rises above the horizon.
  bool possible() const { return all_ > 0; }

  struct Direction {
    glm::vec3 direction;  ///< unit
    double density;       ///< per steradian, of this direction among all that could be sampled
  };
  /// Only where `possible` holds.
  ///   u   in [0, 1)^2: points that fill it evenly give directions that fill the cones evenly
  Direction sample(glm::dvec2 u) const;
  /// The density, per steradian, with which `sample` gives this direction.
  double density(const glm::vec3& direction) const;

 private:
  struct Cone {
    glm::dvec3 axis;
    double below_one;  ///< 1 - cosine of its half angle
    double weight;     ///< of a direction in it
  };
  double weight_around(const glm::vec3& direction) const;

  const glm::vec3* normal_;
  std::size_t cones_ = 0;  ///< spheres that do not contain the point
  std::array<Cone, Targets::most_spheres> cone_;
  double around_ = 0;  ///< weight of each direction, or over its cosine, from within spheres
  std::array<double, Targets::most_spheres + 1> share_;  ///< of the cones, and of all directions
  double all_ = 0;                                       ///< of these
};

}  // namespace photile::trace
