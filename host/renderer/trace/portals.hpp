// Windows as seen by what comes from beyond the scene, or goes there.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "photile/scene.hpp"
#include "trace/distant_light.hpp"

namespace photile::trace {

/// The portals of a scene. Light "enters" by one along its inward normal alone.
class Portals {
 public:
  explicit Portals(const Scene& scene);

  bool empty() const { return portals_.empty(); }

  /// What all portals together show to light that travels in a unit direction, square metres.
  double area_facing(const glm::dvec3& travel) const;

  /// How many portals a line enters by.
  int entered_by(const glm::dvec3& point, const glm::dvec3& travel) const;

  /// A point on a portal that light enters by, evenly over what they show; none shows nothing.
  ///   choice     in [0, 1): which portal
  ///   u, v       in [0, 1): where on it
  glm::dvec3 entrance(const glm::dvec3& travel, double choice, double u, double v) const;

  /// Samples directions from a point through portals: which are in front of it and about how
  /// large they look. Returns the sum of weights; 0 where none can be seen.
  double weigh(const glm::dvec3& from, std::vector<double>& weights) const;

  /// A unit direction through one of them, chosen by its weight, evenly over its area.
  glm::dvec3 sample_direction(const glm::dvec3& from, const std::vector<double>& weights,
                              double sum, double choice, double u, double v) const;

  /// Density of `sample_direction` per steradian.
  double density(const glm::dvec3& from, const glm::dvec3& direction,
                 const std::vector<double>& weights, double sum) const;

 private:
  struct Rectangle {
    glm::dvec3 corner, u, v, normal;  ///< metres; the normal is unit and points inwards
    double area, uu, vv;              ///< m2; squared lengths of the sides
  };
  static bool crosses(const Rectangle& portal, const glm::dvec3& point);

  std::vector<Rectangle> portals_;
};

/// What portals show to a sun's disc or a patch of the sky, on average over its solid angle, square
/// metres.
double area_facing(const Portals& portals, const DistantSampler& light);

}  // namespace photile::trace
