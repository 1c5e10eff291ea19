// Windows as seen by what comes from beyond the scene, or goes there.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "photile/scene.hpp"
#include "trace/distant_light.hpp"
#include "trace/rectangle.hpp"

namespace photile::trace {

/// Portals as they look from a point.
struct PortalSizes {
  std::vector<double> solid_angle;  ///< of each, about; 0 of what is seen from behind
  double sum = 0;
};

/// The portals of a scene. Light "enters" by one along its inward normal alone.
class Portals {
 public:
  explicit Portals(const Scene& scene);

  bool empty() const { return portals_.empty(); }

  /// The projected area of all portals for light that travels in a unit direction, square metres.
  double area_facing(const glm::dvec3& travel) const;

  /// How many portals a line enters by.
  int entered_by(const glm::dvec3& point, const glm::dvec3& travel) const;

  /// A point on a portal that light enters by, evenly over what they show; none shows nothing.
  ///   choice     in [0, 1): which portal
  ///   u, v       in [0, 1): where on it
  glm::dvec3 entrance(const glm::dvec3& travel, double choice, double u, double v) const;

  /// About how large each portal looks from a point.
  void measure(const glm::dvec3& from, PortalSizes& sizes) const;

  /// A unit direction through one of them, chosen by its size, evenly over its area. One can be
  /// seen.
  glm::dvec3 sample_direction(const glm::dvec3& from, const PortalSizes& sizes, double choice,
                              double u, double v) const;

  /// Density of `sample_direction` per steradian.
  double density(const glm::dvec3& from, const glm::dvec3& direction,
                 const PortalSizes& sizes) const;

 private:
  std::vector<Rectangle> portals_;  ///< their normals point inwards
};

/// What portals show to a sun's disc or a patch of the sky, on average over its solid angle, square
/// metres.
double area_facing(const Portals& portals, const DistantSampler& light);

}  // namespace photile::trace
