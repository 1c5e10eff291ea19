// Rectangles towards which directions are sampled.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace photile::trace {

/// A rectangle that is visible only from the side of its normal.
struct Rectangle {
  /// Sides that are not at a right angle give a parallelogram, which has a normal and an area, too.
  Rectangle(const glm::dvec3& corner_at, const glm::dvec3& side_u, const glm::dvec3& side_v)
      : corner(corner_at),
        u(side_u),
        v(side_v),
        normal(glm::cross(u, v)),
        area(glm::length(normal)),
        uu(glm::dot(u, u)),
        vv(glm::dot(v, v)) {
    if (area > 0) normal /= area;
  }

  glm::dvec3 at(double along_u, double along_v) const { return corner + along_u * u + along_v * v; }

  /// How far a point is in front of its plane, metres.
  double height(const glm::dvec3& from) const { return glm::dot(from - corner, normal); }

  /// Whether a point of its plane lies on it.
  bool holds(const glm::dvec3& point) const {
    const glm::dvec3 offset = point - corner;
    const double along_u = glm::dot(offset, u), along_v = glm::dot(offset, v);
    return along_u >= 0 && along_u <= uu && along_v >= 0 && along_v <= vv;
  }

  /// The approximate solid angle of the rectangle; 0 only from behind.
  double solid_angle(const glm::dvec3& from) const {
    const double before = height(from);
    if (!(before > 0)) return 0;
    const glm::dvec3 middle = at(0.5, 0.5) - from;
    const double squared = glm::dot(middle, middle) + 0.25 * area;
    return area * before / (squared * std::sqrt(squared));
  }

  /// The density per steradian of unit directions to points that are spread evenly over it.
  double density(const glm::dvec3& from, const glm::dvec3& direction) const {
    const double cosine = -glm::dot(normal, direction);
    if (!(cosine > 0)) return 0;
    const double distance = height(from) / cosine;
    if (!(distance > 0) || !holds(from + distance * direction)) return 0;
    return distance * distance / (area * cosine);
  }

  glm::dvec3 corner, u, v;  ///< a corner and two sides, metres
  glm::dvec3 normal;        ///< unit, along u x v; 0 without area
  double area;              ///< m2
  double uu, vv;            ///< squared lengths of the sides
};

}  // namespace photile::trace
