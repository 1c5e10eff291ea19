// A point on a triangle, with all that scattering needs.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "photile/scene.hpp"
#include "scene/surface_models.hpp"

namespace photile::trace {

/// A point of a triangle of the scene.
struct TriangleHit {
  std::uint32_t triangle;
  float u, v;  ///< barycentric weights of the second and third corner
  /// Where light passes a triangle with a coincident one that faces the other way: that one. It
  /// lies behind the hit, or before it if the ray came from there.
  std::uint32_t other = none;
  bool other_before = false;
};

/// Where a ray begins.
struct RayOrigin {
  RayOrigin() = default;
  RayOrigin(const glm::vec3& at) : position(at) {}  // NOLINT: a position is an origin
  operator const glm::vec3&() const { return position; }

  glm::vec3 position{0.0f};   ///< metres
  std::uint32_t next = none;  ///< the coincident triangle that the ray hits first
  std::uint32_t from = none;  ///< the triangle that it left, where `next` is set
};

/// The offset of rays over the largest coordinate of the triangle's corners. The position is
/// interpolated in double precision and rounded once (2^-24 of a coordinate), and Embree's plane
/// distance is wrong by a few roundings of the corners' distances, so 2^-19 leaves a margin of an
/// order of magnitude. The idea of an offset in units of rounding is Waechter and Binder's ("A fast
/// and robust method for avoiding self-intersection", Ray Tracing Gems, 2019); theirs scales with
/// the point, which is too little at the origin of a large triangle and too much on a small scene.
inline constexpr double ray_offset_per_coordinate = 0x1p-19;

/// A point on one side of a triangle.
struct SurfacePoint {
  TriangleHit where;
  std::uint32_t side = 0;
  glm::vec3 position{0.0f};  ///< metres
  glm::vec3 normal{0.0f};    ///< unit geometric normal on this side
  /// The offset at which a ray has to start so that it cannot hit its own triangle, metres.
  float ray_offset = 0;

  std::uint32_t oriented_face() const { return oriented(where.triangle, side); }
  /// Origin of a ray that leaves in `direction`, to this side or the other.
  RayOrigin origin_towards(const glm::vec3& direction) const {
    const bool through = glm::dot(direction, normal) < 0.0f;
    RayOrigin origin(position + (through ? -ray_offset : ray_offset) * normal);
    if (where.other != none && through != where.other_before) {
      origin.next = where.other;
      origin.from = where.triangle;
    }
    return origin;
  }
};

/// The point of a triangle nearest to `position` (metres), which lies on it within rounding.
TriangleHit nearest_on_triangle(const Scene& scene, std::uint32_t triangle,
                                const glm::dvec3& position);

/// The position at which a triangle is hit, metres.
inline glm::dvec3 position_of(const Scene& scene, const TriangleHit& hit) {
  const auto corners = scene.corners(hit.triangle);
  const double u = static_cast<double>(hit.u), v = static_cast<double>(hit.v);
  return (1 - u - v) * glm::dvec3(corners[0]) + u * glm::dvec3(corners[1]) +
         v * glm::dvec3(corners[2]);
}

/// The point `where` on the given side of its triangle.
SurfacePoint surface_point(const Scene& scene, const TriangleHit& where, std::uint32_t side);

/// The point of an oriented face nearest to `position` (metres), which lies on it within rounding.
inline SurfacePoint surface_point(const Scene& scene, std::uint32_t oriented_face,
                                  const glm::vec3& position) {
  return surface_point(scene,
                       nearest_on_triangle(scene, triangle_of(oriented_face), glm::dvec3(position)),
                       side_of(oriented_face));
}

/// The point `where` on the side that a ray of this direction arrives at.
SurfacePoint surface_hit(const Scene& scene, const TriangleHit& where, const glm::vec3& direction);

/// Material of the point's triangle.
inline const Material& material_of(const Scene& scene, const SurfacePoint& point) {
  return scene.materials[scene.triangle_material[point.where.triangle]];
}

/// Whether the point lies behind a cutout of a coincident surface.
inline bool behind_cutout(const Scene& scene, const SurfacePoint& point) {
  return point.where.other_before &&
         scene.materials[scene.triangle_material[point.where.other]].interaction ==
             Interaction::opaque;
}

/// The oriented face that stores the photons arriving at the point: behind a cutout, they were
/// stored where they passed it.
std::uint32_t face_of_photons(const Scene& scene, const SurfacePoint& point);

/// Whether the point lies on the side that the file calls the front.
inline bool on_front(const Scene& scene, const SurfacePoint& point) {
  return scene.front_side[point.where.triangle] == point.side;
}

/// Whether the light of the point's triangle, if any, shines from this side.
inline bool emits(const Scene& scene, const SurfacePoint& point) {
  const std::uint32_t light = scene.triangle_light[point.where.triangle];
  return light != none && (on_front(scene, point) || scene.lights[light].two_sided);
}

/// Texel of the emission of the point's light; white where it has no texture.
glm::vec3 emission_texel(const Scene& scene, const SurfacePoint& point);

/// The radiance of the point's light in a unit direction away from it, over its mean radiance: its
/// texel times, where the light has a distribution, the intensity there over that of an even
/// surface.
glm::vec3 emission_towards(const Scene& scene, const SurfacePoint& point,
                           const glm::vec3& direction);

/// The reflectance parameters of an opaque surface there, textured. Without a specular lobe F0 and
/// F90 are 0.
scene::Reflectance reflectance(const Scene& scene, const SurfacePoint& point);

/// Fraction of the surface that is present, in [0, 1]; 1 where its material has no cutouts.
float opacity(const Scene& scene, const SurfacePoint& point);

/// The unit interpolated normal of a point's corners, on its side: the same from all directions.
/// The geometric one where the file has none, or where the two are more than a right angle apart.
glm::vec3 shading_normal(const Scene& scene, const SurfacePoint& point);
/// The shading normal at a position, metres, on a side of a triangle.
glm::vec3 shading_normal(const Scene& scene, std::uint32_t oriented_face,
                         const glm::vec3& position);

/// Unit shading normals at a point where a ray arrives, on its side.
struct ShadingNormals {
  /// The normal interpolated from the corners; the geometric one where the file has none, or where
  /// the ray would arrive at the shading normal's back.
  glm::vec3 smooth;
  glm::vec3 mapped;  ///< `smooth` as the material's normal map turns it; the same without one
  glm::vec3 seen;    ///< `mapped`, or `smooth` where the ray would arrive at the mapped one's back
};
ShadingNormals shading_normals(const Scene& scene, const SurfacePoint& point,
                               const glm::vec3& direction);

/// The unit normal that the material's normal texture gives in place of `smooth`, a unit normal on
/// the side of the point. Tangent and bitangent are those of the corners where the file has them,
/// interpolated; else the directions in which the texture's u grows and its v falls on the
/// triangle. They are made perpendicular to `smooth` on the front; on the back the same bump is
/// seen from behind. `smooth` itself where the corners have no tangents and the coordinates span no
/// area.
glm::vec3 mapped_normal(const Scene& scene, const SurfacePoint& point, const glm::vec3& smooth);

}  // namespace photile::trace
