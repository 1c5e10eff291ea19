// Queries of a RayScene, for folders that do not include Embree: ray hits, alpha cutouts and
// visibility. Thread-safe; the calling thread must hold a FlushDenormals.
#pragma once

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"
#include "trace/random_stream.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

/// Flushes denormal results and operands to zero while it lives; restores the thread's mode after.
class FlushDenormals {
 public:
#if defined(__SSE__)
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); }
  ~FlushDenormals() { _mm_setcsr(saved_); }
#else
  FlushDenormals() = default;
#endif
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
#if defined(__SSE__)
  unsigned saved_;
#endif
};

/// Nearest hit of the ray, or nothing. A ray with a NaN or infinity hits nothing.
std::optional<TriangleHit> intersect(const RayScene& rays, const RayOrigin& origin,
                                     const glm::vec3& direction);

/// Whether a surface of any material intersects the straight line between two points.
bool occluded(const RayScene& rays, const glm::vec3& from, const glm::vec3& to);

/// A straight line, for example from a surface to a light.
struct LineOfSight {
  glm::vec3 from, to;
};

/// Whether lines that begin close together are occluded: packets of sixteen, twice as fast. The
/// answer for a line may depend on the others within rounding.
///   hidden   of each line: set to 1, or 0
void occluded(const RayScene& rays, std::span<const LineOfSight> lines,
              std::span<std::uint8_t> hidden);

/// The transmittance of one surface without a change of direction, per channel.
///   direction   of the ray that meets it there, unit
glm::vec3 transmittance(const Scene& scene, const SurfacePoint& point, const glm::vec3& direction);

/// The transmittance of the straight line between two points, per channel: black behind a surface
/// that bends or stops light, the product of their transmittances behind panes of thin glass and
/// surfaces with cutouts.
glm::vec3 transmittance(const RayScene& rays, const RayOrigin& from, const glm::vec3& to);

/// Whether a ray passes the surface here as if it were not there: always in a cutout, never where
/// the surface is fully present, at random where it is partly present. Behind 4096 cutouts of a
/// path all surfaces count as whole.
///   cutouts   passed so far on the path; is increased
bool passes_cutout(const Scene& scene, const SurfacePoint& point, const RandomStream& random,
                   Purpose purpose, std::uint32_t& cutouts);

/// The hit of a ray on a surface that it does not pass, or nothing. `origin` moves behind the last
/// cutout.
std::optional<SurfacePoint> next_surface(const RayScene::Impl& rays, RayOrigin& origin,
                                         const glm::vec3& direction, const RandomStream& random,
                                         Purpose purpose, std::uint32_t& cutouts);
std::optional<SurfacePoint> next_surface(const RayScene& rays, RayOrigin& origin,
                                         const glm::vec3& direction, const RandomStream& random,
                                         Purpose purpose, std::uint32_t& cutouts);

struct SurfaceLocation {
  glm::vec3 position;  ///< metres
  glm::vec3 normal;    ///< unit, of the side
};

inline SurfaceLocation location_on(const Scene& scene, std::uint32_t oriented_face,
                                   const glm::vec3& position) {
  return {position, glm::vec3(face_normal(scene, oriented_face))};
}

/// The deviation of a shadow ray from the line between two points.
struct ShadowRayInset {
  float offset;    ///< its distance above them, metres
  float left_out;  ///< it ends short of the second by this fraction of its length
};

/// Whether nothing is between two points of one surface, just above it. Where the surface is
/// curved, a line that lies as deep in it as the chord of a circle is raised by twice that depth.
bool see_each_other(const RayScene& rays, const SurfaceLocation& from, const SurfaceLocation& to,
                    const ShadowRayInset& line);

}  // namespace photile::trace
