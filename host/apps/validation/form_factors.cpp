#include "validation/form_factors.hpp"

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace photile::validation {

double polygon_factor(const glm::dvec3& point, const glm::dvec3& normal,
                      std::span<const glm::dvec3> corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = glm::normalize(corners[i] - point);
    const glm::dvec3 b = glm::normalize(corners[(i + 1) % corners.size()] - point);
    const glm::dvec3 across = glm::cross(a, b);
    const double sine = glm::length(across);
    if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(across, normal) / sine;
  }
  return sum / glm::two_pi<double>();
}

double rectangle_factor(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& origin,
                        const glm::dvec3& u, const glm::dvec3& v) {
  const std::array corners{origin, origin + u, origin + u + v, origin + v};
  return std::abs(polygon_factor(point, normal, corners));
}

double opposed_rectangles_factor(double a, double b, double c) {
  const double x = a / c, y = b / c;
  const double root_x = std::sqrt(1 + x * x), root_y = std::sqrt(1 + y * y);
  return 2 / (glm::pi<double>() * x * y) *
         (0.5 * std::log((1 + x * x) * (1 + y * y) / (1 + x * x + y * y)) +
          x * root_y * std::atan(x / root_y) + y * root_x * std::atan(y / root_x) -
          x * std::atan(x) - y * std::atan(y));
}

double perpendicular_rectangles_factor(double width, double height, double length) {
  const double h = height / length, w = width / length;
  const double h2 = h * h, w2 = w * w, both = h2 + w2, root = std::sqrt(both);
  const double logarithm = std::log((1 + w2) * (1 + h2) / (1 + both)) +
                           w2 * std::log(w2 * (1 + both) / ((1 + w2) * both)) +
                           h2 * std::log(h2 * (1 + both) / ((1 + h2) * both));
  return (w * std::atan(1 / w) + h * std::atan(1 / h) - root * std::atan(1 / root) +
          0.25 * logarithm) /
         (glm::pi<double>() * w);
}

}  // namespace photile::validation
