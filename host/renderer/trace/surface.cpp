#include "trace/surface.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <optional>

#include "photile/device/bsdf.h"
#include "trace/emission_sampling.hpp"
#include "trace/sampling.hpp"

namespace photile::trace {

namespace {

struct Interpolated {
  glm::dvec3 position;
  glm::dvec3 normal;  ///< unit, of side 0
  double ray_offset;
};

Interpolated interpolate(const Scene& scene, const TriangleHit& where) {
  const glm::uvec3& t = scene.triangles[where.triangle];
  const glm::dvec3 a(scene.vertices[t.x]), b(scene.vertices[t.y]), c(scene.vertices[t.z]);
  const glm::dvec3 cross = glm::cross(b - a, c - a);
  // Robust intersection may report weights a rounding outside the triangle.
  const double u = std::clamp(static_cast<double>(where.u), 0.0, 1.0);
  const double v = std::clamp(static_cast<double>(where.v), 0.0, 1.0 - u);
  return {a + u * (b - a) + v * (c - a), cross / glm::length(cross),
          ray_offset_per_coordinate *
              std::max({largest(glm::abs(a)), largest(glm::abs(b)), largest(glm::abs(c))})};
}

glm::vec2 interpolate(const std::array<glm::vec2, 3>& uv, const TriangleHit& where) {
  return (1.0f - where.u - where.v) * uv[0] + where.u * uv[1] + where.v * uv[2];
}

/// A lookup in a texture of the point's material.
glm::vec2 texture_coordinates(const Scene& scene, const SurfacePoint& point) {
  return interpolate(scene.corner_uv[point.where.triangle], point.where);
}

/// The model with its textures' factors at these coordinates.
MetallicRoughness textured(const Scene& scene, MetallicRoughness model, std::uint32_t base_color,
                           const glm::vec2& uv) {
  if (base_color != none) model.base_color *= glm::dvec3(scene.textures[base_color].sample(uv));
  if (model.texture != none) {
    const glm::vec4 factors = scene.textures[model.texture].sample_data(uv);
    model.roughness *= double{factors.g};
    model.metallic *= double{factors.b};
  }
  if (model.specular_texture != none) {
    model.specular_factor *= double{scene.textures[model.specular_texture].sample_data(uv).a};
  }
  if (model.specular_color_texture != none) {
    model.specular_color *= glm::dvec3(scene.textures[model.specular_color_texture].sample(uv));
  }
  return model;
}

SurfacePoint on_side(const TriangleHit& where, const Interpolated& at, std::uint32_t side) {
  SurfacePoint point;
  point.where = where;
  point.side = side;
  point.position = glm::vec3(at.position);
  point.normal = glm::vec3(side == 0 ? at.normal : -at.normal);
  point.ray_offset = static_cast<float>(at.ray_offset);
  return point;
}

/// The normal of the corners, on the side of the point; the geometric one where the file has none.
glm::vec3 interpolated_normal(const Scene& scene, const SurfacePoint& point) {
  if (scene.corner_normal.empty()) return point.normal;
  const auto& corner = scene.corner_normal[point.where.triangle];
  if (corner[0] == glm::vec3(0.0f) || corner[1] == glm::vec3(0.0f) || corner[2] == glm::vec3(0.0f))
    return point.normal;
  const float u = point.where.u, v = point.where.v;
  glm::vec3 normal = (1.0f - u - v) * corner[0] + u * corner[1] + v * corner[2];
  if (!on_front(scene, point)) normal = -normal;
  const float length = glm::length(normal);
  return length > 0.0f ? normal / length : point.normal;
}

glm::vec3 smooth_normal(const Scene& scene, const SurfacePoint& point, const glm::vec3& direction) {
  const glm::vec3 normal = interpolated_normal(scene, point);
  return glm::dot(normal, direction) < 0.0f ? normal : point.normal;
}

}  // namespace

TriangleHit nearest_on_triangle(const Scene& scene, std::uint32_t triangle,
                                const glm::dvec3& position) {
  const auto [a, b, c] = scene.corners(triangle);
  const glm::dvec3 along_u = glm::dvec3(b) - glm::dvec3(a), along_v = glm::dvec3(c) - glm::dvec3(a);
  const glm::dvec3 offset = position - glm::dvec3(a);
  const double uu = glm::dot(along_u, along_u), uv = glm::dot(along_u, along_v),
               vv = glm::dot(along_v, along_v);
  const double pu = glm::dot(offset, along_u), pv = glm::dot(offset, along_v);
  const double determinant = uu * vv - uv * uv;
  const double u = std::clamp((vv * pu - uv * pv) / determinant, 0.0, 1.0);
  const double v = std::clamp((uu * pv - uv * pu) / determinant, 0.0, 1.0 - u);
  return {triangle, static_cast<float>(u), static_cast<float>(v)};
}

SurfacePoint surface_point(const Scene& scene, const TriangleHit& where, std::uint32_t side) {
  return on_side(where, interpolate(scene, where), side);
}

SurfacePoint surface_hit(const Scene& scene, const TriangleHit& where, const glm::vec3& direction) {
  const Interpolated at = interpolate(scene, where);
  return on_side(where, at, glm::dot(at.normal, glm::dvec3(direction)) > 0.0 ? 1 : 0);
}

std::uint32_t face_of_photons(const Scene& scene, const SurfacePoint& point) {
  if (!behind_cutout(scene, point)) return point.oriented_face();
  const std::uint32_t before = point.where.other;
  const bool alike =
      glm::dot(face_normal(scene, oriented(before, 0)), glm::dvec3(point.normal)) > 0;
  return oriented(before, alike ? 0 : 1);
}

glm::vec3 emission_texel(const Scene& scene, const SurfacePoint& point) {
  const std::uint32_t light = scene.triangle_light[point.where.triangle];
  if (light == none || scene.lights[light].emission_texture == none) return glm::vec3(1.0f);
  return scene.textures[scene.lights[light].emission_texture].sample(
      interpolate(scene.corner_emission_uv[point.where.triangle], point.where));
}

glm::vec3 emission_towards(const Scene& scene, const SurfacePoint& point,
                           const glm::vec3& direction) {
  const glm::vec3 texel = emission_texel(scene, point);
  const std::uint32_t number = scene.triangle_light[point.where.triangle];
  if (number == none || scene.lights[number].distribution == none) return texel;
  constexpr double grazing = 1e-3;  // nearer to the surface an intensity has no radiance
  const Light& light = scene.lights[number];
  const IntensityDistribution& distribution = scene.distributions[light.distribution];
  const double cosine =
      std::max(grazing, std::abs(glm::dot(glm::dvec3(point.normal), glm::dvec3(direction))));
  const double sides = light.two_sided ? 2 : 1;
  const double intensity =
      distribution.intensity(LightAxes(light).to_light(glm::dvec3(direction))) /
      distribution.flux();
  return texel * static_cast<float>(glm::pi<double>() * sides * intensity / cosine);
}

scene::Reflectance reflectance(const Scene& scene, const SurfacePoint& point) {
  const Material& material = material_of(scene, point);
  const bool textured_here = material.textured() && !scene.corner_uv.empty();
  if (textured_here && material.metallic_roughness != none) {
    return scene::reflectance_of(
        textured(scene, scene.metallic_roughness[material.metallic_roughness],
                 material.diffuse_texture, texture_coordinates(scene, point)));
  }
  glm::vec3 albedo = material.diffuse;
  if (textured_here && material.diffuse_texture != none) {
    albedo *= scene.textures[material.diffuse_texture].sample(texture_coordinates(scene, point));
  }
  if (!material.glossy()) return {albedo, glm::vec3(0.0f), 0.0f, 1.0f};
  return {albedo, material.specular, material.f90,
          std::clamp(material.roughness, PHOTILE_MIN_GGX_ALPHA, 1.0f)};
}

float opacity(const Scene& scene, const SurfacePoint& point) {
  const Material& material = material_of(scene, point);
  float fraction = material.opacity;
  if (material.opacity_texture != none && !scene.corner_uv.empty()) {
    fraction *=
        scene.textures[material.opacity_texture].sample_data(texture_coordinates(scene, point)).a;
  }
  if (material.opacity_cutoff > 0.0f) return fraction >= material.opacity_cutoff ? 1.0f : 0.0f;
  return std::clamp(fraction, 0.0f, 1.0f);
}

glm::vec3 shading_normal(const Scene& scene, const SurfacePoint& point) {
  const glm::vec3 normal = interpolated_normal(scene, point);
  return glm::dot(normal, point.normal) > 0.0f ? normal : point.normal;
}

glm::vec3 shading_normal(const Scene& scene, std::uint32_t oriented_face,
                         const glm::vec3& position) {
  return shading_normal(scene, surface_point(scene, oriented_face, position));
}

ShadingNormals shading_normals(const Scene& scene, const SurfacePoint& point,
                               const glm::vec3& direction) {
  const glm::vec3 smooth = smooth_normal(scene, point, direction);
  if (material_of(scene, point).normal_texture == none || scene.corner_uv.empty()) {
    return {smooth, smooth, smooth};
  }
  const glm::vec3 mapped = mapped_normal(scene, point, smooth);
  return {smooth, mapped, glm::dot(mapped, direction) < 0.0f ? mapped : smooth};
}

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
