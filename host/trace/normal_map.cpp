#include "trace/normal_map.hpp"

#include <cmath>

namespace photile::trace {

glm::vec3 mapped_normal(const Scene& scene, const SurfacePoint& point, const glm::vec3& smooth) {
  const Material& material = material_of(scene, point);
  const auto& uv = scene.corner_uv[point.where.triangle];
  const auto [a, b, c] = scene.corners(point.where.triangle);
  const glm::vec2 du = uv[1] - uv[0], dv = uv[2] - uv[0];
  const float determinant = du.x * dv.y - du.y * dv.x;
  if (determinant == 0.0f || !std::isfinite(determinant)) return smooth;
  const float sign = std::copysign(1.0f, determinant);  // lengths do not count
  const glm::vec3 along_u = sign * (dv.y * (b - a) - du.y * (c - a));
  const glm::vec3 front = on_front(scene, point) ? smooth : -smooth;
  const glm::vec3 tangent = along_u - glm::dot(front, along_u) * front;
  const float length = glm::length(tangent);
  if (!(length > 0.0f)) return smooth;
  // The winding of (b - a, c - a) is that of side 0, which need not be the front.
  const float v_grows = scene.front_side[point.where.triangle] == 0 ? -sign : sign;
  const glm::vec3 bitangent = v_grows * glm::cross(front, tangent / length);

  const glm::vec2 where = (1.0f - point.where.u - point.where.v) * uv[0] + point.where.u * uv[1] +
                          point.where.v * uv[2];
  const glm::vec3 texel =
      glm::vec3(2.0f * scene.textures[material.normal_texture].sample_data(where) - 1.0f);
  glm::vec3 normal =
      material.normal_scale * (texel.x / length * tangent + texel.y * bitangent) + texel.z * front;
  if (!on_front(scene, point)) {
    // Seen from behind, a bump is a dent of the same slope: the normal turns round as a whole.
    normal = -normal;
  }
  const float size = glm::length(normal);
  return size > 0.0f ? normal / size : smooth;
}

}  // namespace photile::trace
