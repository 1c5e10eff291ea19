// Which of the nodes around a point of the surface give the light that falls there.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "photile/defaults.hpp"
#include "photile/light_maps.hpp"
#include "photile/ray_scene.hpp"

namespace photile::trace {
struct SurfaceLocation;
}

namespace photile::cache {

/// Whether nothing stands between two points of one surface. The caller's thread must flush
/// denormals (ray_query.hpp).
bool sees(const RayScene& rays, const trace::SurfaceLocation& from,
          const trace::SurfaceLocation& to);

/// A chart goes on under things that stand on it, and behind what is let into it. Nodes there hold
/// the light of their own position, which does not reach the visible surface beside them.
class NodeVisibility {
 public:
  /// References are kept.
  ///   contrast   of nodes that are looked at, as LightMapParameters::contrast
  NodeVisibility(const RayScene& rays, const LightMaps& maps,
                 double contrast = defaults::light_map_contrast)
      : rays_(rays), maps_(maps), contrast_(contrast) {}

  /// Leaves out the nodes that something hides from the point, or covers and not the point, where
  /// the nodes differ so much that it matters: their weight becomes 0, and the others' weights are
  /// scaled to sum to 1. Returns false where none is left; then the weights are unchanged. Depends
  /// on the point and its nodes alone. Thread-safe; the caller's thread must flush denormals
  /// (ray_query.hpp).
  ///   position   of an opaque surface, metres
  ///   bilinear   of LightMaps::find, which found all nodes
  bool keep_visible(std::uint32_t oriented_face, const glm::vec3& position,
                    BilinearWeights& bilinear) const;

  /// Whether the middle of the cell sees all of its nodes.
  bool is_open(const BilinearWeights& cell) const;

  /// Whether nothing stands between two positions, metres, on the plane of a triangle's side.
  bool sees(std::uint32_t oriented_face, const glm::vec3& from, const glm::vec3& to) const;

  /// Whether something that lies on the surface covers `there`, closer than `reach`, but not
  /// `here`: the slit behind it sees the surface beside it, but no light.
  bool is_in_slit(const trace::SurfaceLocation& here, const trace::SurfaceLocation& there,
                  float reach) const;

 private:
  bool is_in_slit(const trace::SurfaceLocation& here, std::uint32_t node) const;

  const RayScene& rays_;
  const LightMaps& maps_;
  double contrast_;
};

}  // namespace photile::cache
