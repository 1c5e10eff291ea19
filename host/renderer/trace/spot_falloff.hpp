// The cone of a spot light (KHR_lights_punctual): over t = cosine - outer its intensity is
// (t / edge)^2 up to the edge of the inner cone, then 1.
#pragma once

#include <algorithm>
#include <cmath>

#include "photile/scene.hpp"

namespace photile::trace {

struct SpotFalloff {
  explicit SpotFalloff(const Light& light)
      : outer(std::cos(static_cast<double>(light.outer_cone_angle))),
        edge(std::cos(static_cast<double>(light.inner_cone_angle)) - outer) {}

  /// Intensity, 1 in the inner cone, in a direction at `cosine` to the axis.
  double at(double cosine) const {
    const double t = cosine - outer;
    if (t <= 0) return 0;
    return t < edge ? (t / edge) * (t / edge) : 1;
  }
  /// Of the intensity over the cosine; times 2 pi it is the flux.
  double integral() const { return edge / 3.0 + 1.0 - (outer + edge); }

  double outer;  ///< cosine
  double edge;   ///< cosine of the inner cone less that of the outer one
};

}  // namespace photile::trace
