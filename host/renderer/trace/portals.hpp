// Windows, for light from beyond the scene and rays that go there.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "photile/scene.hpp"
#include "trace/distant_light.hpp"
#include "trace/rectangle.hpp"

namespace photile::trace {

/// The apparent sizes of portals from a point.
struct PortalSizes {
  std::vector<double> solid_angle;  ///< of each, about; 0 of what is seen from behind
  double sum = 0;
};

/// The portals of a scene. Light enters a portal only along its inward normal.
class Portals {
 public:
  explicit Portals(const Scene& scene);

  bool empty() const { return portals_.empty(); }

  /// The projected area of all portals for light that travels in a unit direction, square metres.
  double area_facing(const glm::dvec3& travel) const;

  /// The number of portals through which a line enters.
  int entered_by(const glm::dvec3& point, const glm::dvec3& travel) const;

  /// A point on a portal through which the light enters, evenly over their projected area; nothing
  /// where that is 0.
  ///   choice     in [0, 1): which portal
  ///   u, v       in [0, 1): where on it
  glm::dvec3 entrance(const glm::dvec3& travel, double choice, double u, double v) const;

  /// The approximate apparent size of each portal from a point.
  void measure(const glm::dvec3& from, PortalSizes& sizes) const;

  /// A unit direction through one of them, chosen by its size, evenly over its area. At least one
  /// must be visible.
  glm::dvec3 sample_direction(const glm::dvec3& from, const PortalSizes& sizes, double choice,
                              double u, double v) const;

  /// Density of `sample_direction` per steradian.
  double density(const glm::dvec3& from, const glm::dvec3& direction,
                 const PortalSizes& sizes) const;

 private:
  std::vector<Rectangle> portals_;  ///< their normals point inwards
};

/// The projected area of the portals for a sun's disc or a patch of the sky, averaged over its
/// solid angle, square metres.
double area_facing(const Portals& portals, const DistantSampler& light);

}  // namespace photile::trace
