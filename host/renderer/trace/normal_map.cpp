#include "trace/normal_map.hpp"

#include <cmath>
#include <optional>

namespace photile::trace {
namespace {

/// Where the red and green of a normal map point to.
struct TangentFrame {
  glm::vec3 tangent;  ///< any length, not perpendicular to the normal yet
  float handedness;   ///< 1 or -1: the bitangent lies along this times front normal x tangent
};

/// The frame that the file gives.
std::optional<TangentFrame> frame_of_corners(const Scene& scene, const TriangleHit& where) {
  if (scene.corner_tangent.empty()) return std::nullopt;
  const auto& [a, b, c] = scene.corner_tangent[where.triangle];
  if (a.w == 0.0f) return std::nullopt;
  const glm::vec4 tangent = (1.0f - where.u - where.v) * a + where.u * b + where.v * c;
  return TangentFrame{glm::vec3(tangent), a.w};
}

/// The frame of a triangle in which the texture's u grows and its v falls.
std::optional<TangentFrame> frame_of_coordinates(const Scene& scene, std::uint32_t triangle) {
  const auto& uv = scene.corner_uv[triangle];
  const auto [a, b, c] = scene.corners(triangle);
  const glm::vec2 du = uv[1] - uv[0], dv = uv[2] - uv[0];
  const float determinant = du.x * dv.y - du.y * dv.x;
  if (determinant == 0.0f || !std::isfinite(determinant)) return std::nullopt;
  const float sign = std::copysign(1.0f, determinant);  // lengths do not count
  // The winding of (b - a, c - a) is that of side 0, which need not be the front.
  return TangentFrame{sign * (dv.y * (b - a) - du.y * (c - a)),
                      scene.front_side[triangle] == 0 ? -sign : sign};
}

}  // namespace

glm::vec3 mapped_normal(const Scene& scene, const SurfacePoint& point, const glm::vec3& smooth) {
  const Material& material = material_of(scene, point);
  std::optional<TangentFrame> frame = frame_of_corners(scene, point.where);
  if (!frame) frame = frame_of_coordinates(scene, point.where.triangle);
  if (!frame) return smooth;
  const glm::vec3 front = on_front(scene, point) ? smooth : -smooth;
  const glm::vec3 tangent = frame->tangent - glm::dot(front, frame->tangent) * front;
  const float length = glm::length(tangent);
  if (!(length > 0.0f)) return smooth;
  const glm::vec3 bitangent = frame->handedness * glm::cross(front, tangent / length);

  const auto& uv = scene.corner_uv[point.where.triangle];
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
