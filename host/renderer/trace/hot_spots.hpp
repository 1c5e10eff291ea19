// Hot spots: surface so close to a light without size that the lit area is too small and bright to
// be found by sampling the room.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "photile/ray_scene.hpp"
#include "trace/sampling.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

/// The hot spots of a scene, one for each light that has one: the surface that its light reaches
/// directly, or through panes and cutouts, within `reach` of it. This light is found by shadow rays
/// wherever it is requested, and neither photons nor nodes of light maps contain it; rays go there
/// by the distribution of that light (HotSpotAim).
class HotSpots {
 public:
  /// The reference is kept. Rays from each light without size measure how close surface is.
  explicit HotSpots(const RayScene::Impl& rays);

  bool empty() const { return spots_.empty(); }

  /// Whether light that comes directly from this light to a position is that of a hot spot.
  bool holds(std::uint32_t light, const glm::vec3& position) const {
    return !spots_.empty() && light != none &&
           glm::distance(scene_light(light).position, position) < reach_[light];
  }

  /// Metres from the light; 0 where it has no hot spot.
  double reach(std::uint32_t light) const { return reach_[light]; }

  /// Calls visit(light) for each light of which the position may be in the hot spot.
  template <class Visit>
  void for_each_at(const glm::vec3& position, const Visit& visit) const {
    for (const Spot& spot : spots_) {
      if (holds(spot.light, position)) visit(spot.light);
    }
  }

 private:
  friend class HotSpotAim;

  /// Directions of a light, in cells of equal width in the polar angle and the azimuth.
  struct Spot {
    std::uint32_t light;
    Frame axes;         ///< about the direction in which the light shines
    double cell_angle;  ///< of the polar angle, radians
    std::vector<double>
        up_to;  ///< light reflected by surface in the cells up to and including this one
    glm::dvec3 centre{0.0};  ///< of the reflected light
    double radius = 0;       ///< root mean square distance from there
    double share = 0;        ///< of the emission of all lights together

    double weight(std::size_t cell) const {
      return up_to[cell] - (cell == 0 ? 0.0 : up_to[cell - 1]);
    }
    double solid_angle(std::size_t row) const;
  };

  const Light& scene_light(std::uint32_t light) const;
  std::optional<Spot> spot_of(std::uint32_t light, double reach) const;
  double surroundings_of(std::uint32_t light) const;
  std::optional<SurfacePoint> first_surface(std::uint32_t light, const glm::vec3& direction,
                                            double reach) const;
  double density(const Spot& spot, const SurfacePoint& point) const;

  const RayScene::Impl* rays_;
  std::vector<Spot> spots_;
  std::vector<double> reach_;  ///< per light, metres; 0 where it has no hot spot
  double rays_to_spots_ = 0;
};

/// The hot spots of a scene.
const HotSpots& hot_spots_of(const RayScene::Impl& rays);
const HotSpots& hot_spots_of(const RayScene& rays);

/// Rays from a point to hot spots: a part of all rays; the others have another density. All rays
/// count by the density of both together (the balance heuristic, Veach and Guibas 1995).
class HotSpotAim {
 public:
  /// Aims no rays.
  HotSpotAim() = default;
  ///   normal   unit, of a surface that receives light on this side only; null: light from
  ///            all sides counts
  HotSpotAim(const HotSpots& spots, const glm::vec3& from, const glm::vec3* normal);

  /// The part of the rays; 0 where no hot spot can be seen.
  double fraction() const { return all_ > 0 ? spots_->rays_to_spots_ : 0; }

  struct Target {
    SurfacePoint point;
    glm::vec3 direction;  ///< unit, to there
    double density;       ///< of this direction, per steradian, as long as nothing is in the way
  };
  /// A point of a hot spot, on the side that faces. Nothing where the light hits something else.
  ///   u   in [0, 1)^2: points that fill it evenly give points that fill the spot evenly
  std::optional<Target> sample(glm::dvec2 u) const;

  /// The weight of the light of a target, relative to that if all rays had the density `other`.
  double weight(double other, const Target& target) const {
    return other / ((1 - fraction()) * other + fraction() * target.density);
  }
  /// The weight of rays that are not aimed for the light of surface that they hit directly or
  /// through panes; for all other light it is 1.
  ///   other   density of the direction
  double weight_beside(double other, const SurfacePoint& met) const {
    const double unaimed = (1 - fraction()) * other;
    return unaimed / (unaimed + fraction() * density(met));
  }

 private:
  double density(const SurfacePoint& met) const;
  double per_steradian(double per_steradian_of_light, const HotSpots::Spot& spot,
                       const SurfacePoint& point) const;

  const HotSpots* spots_ = nullptr;
  glm::dvec3 from_{0.0};
  std::vector<double> up_to_;  ///< weights of the spots up to and including this one
  double all_ = 0;
};

}  // namespace photile::trace
