// Maps from uniform numbers in [0, 1) to directions and points. Each names its density.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace photile::trace {

/// Orthonormal tangents of unit `n` (Duff et al., "Building an orthonormal basis, revisited",
/// 2017).
struct Frame {
  explicit Frame(const glm::vec3& normal) : n(normal) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    s = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
  }
  glm::vec3 to_world(const glm::vec3& v) const { return s * v.x + t * v.y + n * v.z; }
  glm::vec3 to_local(const glm::vec3& v) const {
    return {glm::dot(v, s), glm::dot(v, t), glm::dot(v, n)};
  }
  glm::vec3 s, t, n;
};

inline constexpr float two_pi = 6.28318530717958647692f;

/// Uniform on the unit disc, density 1 / pi.
inline glm::vec2 sample_disc(float u1, float u2) {
  const float r = std::sqrt(u1);
  const float phi = two_pi * u2;
  return {r * std::cos(phi), r * std::sin(phi)};
}

/// Upper hemisphere about z, density cos(theta) / pi.
inline glm::vec3 sample_cosine_hemisphere(float u1, float u2) {
  return {sample_disc(u1, u2), std::sqrt(1.0f - u1)};
}

/// Direction at `cos_theta` from z, azimuth uniform.
inline glm::vec3 direction_at(float cos_theta, float u) {
  const float sin_theta = std::sqrt(std::max(0.0f, 1.0f - cos_theta * cos_theta));
  const float phi = two_pi * u;
  return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta};
}

/// Unit sphere, density 1 / (4 pi).
inline glm::vec3 sample_sphere(float u1, float u2) { return direction_at(1.0f - 2.0f * u1, u2); }

/// Barycentric weights of the second and third corner, uniform over the triangle's area.
inline glm::vec2 sample_triangle(float u1, float u2) {
  const float root = std::sqrt(u1);
  return {root * (1.0f - u2), root * u2};
}

/// Weight of a sample that was found with `density`, and that another technique finds with the
/// density `other`, 0 where it cannot (Veach and Guibas, "Optimally combining sampling techniques
/// for Monte Carlo rendering", 1995).
inline float power_heuristic(float density, float other) {
  const float ratio = other / density;
  return 1.0f / (1.0f + ratio * ratio);
}

inline float largest(const glm::vec3& v) { return std::max({v.x, v.y, v.z}); }
inline double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

}  // namespace photile::trace
