#include "trace/ggx.hpp"

#include <algorithm>
#include <cmath>

#include "photile/device/bsdf.h"
#include "trace/sampling.hpp"

namespace photile::trace {

glm::vec3 sample_ggx_visible_normal(const glm::vec3& view, float alpha, float u1, float u2) {
  // Stretch the view so that the lobe becomes a hemisphere.
  const glm::vec3 v = glm::normalize(glm::vec3(alpha * view.x, alpha * view.y, view.z));
  const float length2 = v.x * v.x + v.y * v.y;
  const glm::vec3 t1 =
      length2 > 0.0f ? glm::vec3(-v.y, v.x, 0.0f) / std::sqrt(length2) : glm::vec3(1, 0, 0);
  const glm::vec3 t2 = glm::cross(v, t1);
  // A point on the part of the disc that the hemisphere shows to the view.
  glm::vec2 p = sample_disc(u1, u2);
  const float s = 0.5f * (1.0f + v.z);
  p.y = (1.0f - s) * std::sqrt(std::max(0.0f, 1.0f - p.x * p.x)) + s * p.y;
  const glm::vec3 n =
      p.x * t1 + p.y * t2 + std::sqrt(std::max(0.0f, 1.0f - p.x * p.x - p.y * p.y)) * v;
  return glm::normalize(glm::vec3(alpha * n.x, alpha * n.y, std::max(0.0f, n.z)));
}

float ggx_reflection_density(float n_dot_view, float n_dot_half, float alpha) {
  if (!(n_dot_half > 0.0f)) return 0.0f;
  return 0.5f * photile_ggx_masking(n_dot_view, alpha) *
         photile_ggx_distribution(n_dot_half, alpha);
}

}  // namespace photile::trace
