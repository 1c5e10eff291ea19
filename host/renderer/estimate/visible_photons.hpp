// Excludes the light of photons that something hides from a hit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "geometry/box_tree.hpp"
#include "photile/estimator.hpp"
#include "photile/photons.hpp"
#include "photile/ray_scene.hpp"
#include "trace/ray_query.hpp"

namespace photile::estimate {

/// The photons nearest to a hit may lie on the other side of a wall that stands on the same floor:
/// a dark room would get the light of the yard, and a floor outside a ring of metal that of the
/// caustic within it. Here visibility from the hit along the surface decides which photons count,
/// and on which part of the disc they lie.
class VisiblePhotons {
 public:
  /// Keeps a reference to `rays`, and copies of what it needs of the photons.
  ///   kernel   of the estimates
  ///   radius   metres, from which no neighbour is farther
  VisiblePhotons(const RayScene& rays, const Photons& photons, DensityKernel kernel, double radius);

  /// The hits whose estimate is not 0, and near which something stands on the surface: those whose
  /// neighbours need to be tested.
  ///   radius   metres, from which no neighbour is farther
  std::vector<std::uint32_t> beside_something(const PrimaryHits& hits, const LightTable& estimates,
                                              double radius) const;

  /// Replaces the estimate of a light by that of its visible photons over the visible area, where
  /// these give less than a quarter of the light, or where more than a tenth of the light lies
  /// behind the surface itself, as in the cavity above a ceiling. Otherwise the estimate stays: it
  /// has less noise, and its area is exact.
  ///   chosen   of the hits
  ///   near     of the chosen hits
  void leave_out_hidden(const PrimaryHits& hits, std::span<const std::uint32_t> chosen,
                        const NeighbourLists& near, LightTable& estimates) const;

 private:
  struct Disc;
  struct Layer;
  trace::SurfaceLocation location_of(std::uint32_t photon) const;
  std::size_t layer_of(std::uint32_t photon) const { return light_.empty() ? 0 : light_[photon]; }
  /// Whether nothing stands between two points of a disc, at a height above the surface, metres.
  bool sees(const trace::SurfaceLocation& here, const trace::SurfaceLocation& there,
            float height) const;
  /// Whether something lies above a point, between these heights, metres.
  bool covered(const trace::SurfaceLocation& point, float from, float to) const;
  /// Finds the faces on which photons lie close below another surface.
  void find_cavities(double radius, const PhotonsOfAll* of_all);
  /// Whether one of these lies behind a surface, within a radius.
  bool is_before_cavity(const trace::SurfaceLocation& here, float radius) const;
  /// Whether a photon lies behind the surface of a disc, with a surface in between.
  bool is_behind(const trace::SurfaceLocation& here, const trace::SurfaceLocation& photon) const;
  /// Tests a few photons of each light that has some, and all behind the surface. Returns whether
  /// any light is in doubt.
  bool probe(const Disc& disc, std::vector<Layer>& layers) const;
  /// Sums the photons of the lights that are in doubt: all of them, and the visible ones.
  ///   full   the farthest photon gives the radius
  void sum_seen(const Disc& disc, bool full, std::vector<Layer>& layers) const;
  /// The surface of about this normal, at most `within` metres above or below a point.
  std::optional<trace::SurfaceLocation> surface_at(const trace::SurfaceLocation& point,
                                                   float within) const;
  /// The integral of the kernel over the surface of a disc that is visible from its middle, m2.
  double visible_area(const Disc& disc) const;
  /// The weight of a photon, by the square of its distance over the radius.
  double weight(double relative_squared) const;

  const RayScene& rays_;
  float rounding_;  ///< metres: surfaces closer to each other than this count as one
  DensityKernel kernel_;
  std::vector<glm::vec3> position_;
  std::vector<std::uint32_t> oriented_face_;
  std::vector<float> flux_;           ///< luminance
  std::vector<std::uint16_t> light_;  ///< empty for a single light
  std::vector<std::uint32_t> cavity_faces_;
  geometry::BoxTree cavities_;  ///< of these faces
};

}  // namespace photile::estimate
