// Irradiance at points of surfaces by rays: to lights, and to the surfaces around, where photon
// estimates are looked up.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cache/light_maps.hpp"
#include "light/light_at_points.hpp"
#include "photile/defaults.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "trace/light_sampler.hpp"
#include "trace/targets.hpp"

namespace photile::cache {

/// Rays and light samples of a point.
struct NodeRays {
  int rays = 0, light_samples = 0;
  friend auto operator<=>(const NodeRays&, const NodeRays&) = default;
};

struct IrradianceGatherParameters {
  /// Rays from each point to the surfaces around; 0 = indirect light is left out.
  int rays = 144;
  /// Light samples from each point; 0 = direct light is left out.
  int light_samples = 96;
  /// The number of independent batches that rays and light samples are divided into, rounded up to
  /// a whole number in each: their scatter is the error.
  int batches = 8;
  /// At surface nearer than this, metres, one ray and one light sample gather again instead of
  /// reading photon estimates, which blur over such distances and miss what hides there; the same
  /// holds for slats narrower than half of it. Not where there are caustics, which only photons
  /// carry. 0 = all surface is read.
  double near = 0;
  /// Metres: the resolution of the light of hot spots (trace/hot_spots.hpp) at points. A light is
  /// taken to be no closer to the point than this, so that its hot spot is as wide, and as bright
  /// in total. 0 = its true distance; infinity = it is left out.
  double resolution = 0;
  /// Photons of an estimate of caustics, which give its error.
  int caustic_neighbours = defaults::neighbours;
  std::uint64_t seed = defaults::seed;
  int max_specular_depth = defaults::max_specular_depth;  ///< mirrors and glass that a ray follows
};

/// Light at points in two parts, whose noise differs.
struct GatheredParts {
  LightTable indirect;  ///< from other surfaces
  LightTable direct;    ///< of lights, and caustics
  /// Per point: harmonic mean of the distances to what its rays hit, metres; infinite for none.
  std::vector<float> distance;

  std::uint64_t bytes() const {
    return indirect.bytes() + direct.bytes() + distance.size() * sizeof(float);
  }
};

/// Gathers the light of each layer at points, in three parts that together are all light
/// (docs/method/gathering.md): directly from lights, by light samples and by the rays that hit
/// them; over mirrors or through glass that bends it and nothing else, by the photons that carry
/// it; all other light, by rays with the density of the cosine that read the photons of all light
/// where they end.
///
/// Ray hits read light maps whose nodes photon estimates fill: what a point gets depends on itself
/// and its number, and not on the points beside it. Hits on surfaces whose lobe reflects much have
/// separate estimates; weaker lobes count as if they reflected the same light diffusely.
class IrradianceGather {
 public:
  /// References are kept.
  ///   photons    of all light except that of hot spots (trace_photons_beside_hot_spots); k of
  ///              about 100 suffices
  ///   ends       light maps of one level for these photons, read where rays meet surface
  ///   caustics   by photons that came by mirrors and glass alone; null where there are none
  /// Errors: UsageError for parameters out of range; InputError for an area light without area.
  IrradianceGather(const RayScene& rays, light::LightAtPoints& photons,
                   const LightMapParameters& ends, light::LightAtPoints* caustics,
                   const IrradianceGatherParameters& parameters);

  /// Irradiance at points, in their order. What a point gets depends on itself and its number.
  ///   points   position, oriented_face, diffuse_albedo and, in glossy scenes, outgoing and lobe
  ///   number   of each point, below 2^48: the same number and point have the same rays
  ///   rays, light_samples   instead of those of the parameters
  ///   before   what the points have already: the new rays and samples continue those sequences
  /// Where several processes have the photon maps, all pass the same points; each gathers at a part
  /// of them, and all get all results. Errors: as estimate::PhotonEstimate; Interrupted, when
  /// `progress` says so.
  GatheredParts gather(const PrimaryHits& points, std::span<const std::uint64_t> number, int rays,
                       int light_samples, const Progress& progress = Progress::none(),
                       NodeRays before = {});

  /// All light together.
  LightTable gather(const PrimaryHits& points, std::span<const std::uint64_t> number,
                    const Progress& progress = Progress::none());

  const RayScene& rays() const { return rays_; }
  /// The light maps where rays end.
  LightMaps& ends() { return ends_; }

  /// The costs of all calls so far.
  struct Costs {
    std::uint64_t rays = 0;       ///< to surfaces; those along mirrors and glass included
    std::uint64_t hits = 0;       ///< that met a surface
    std::uint64_t estimated = 0;  ///< points at which photons were searched
  };
  const Costs& costs() const { return costs_; }

 private:
  /// Of no points.
  GatheredParts none_yet() const;
  /// Gathers at this process's points, in as many rounds as `most` points take.
  GatheredParts gather_own(const PrimaryHits& points, std::span<const std::uint64_t> number,
                           int rays, int light_samples, NodeRays before, std::size_t most,
                           const Progress& progress);

  const RayScene& rays_;
  light::LightAtPoints& photons_;
  light::LightAtPoints* caustics_;
  IrradianceGatherParameters parameters_;
  trace::LightSampler light_sampler_;
  std::vector<glm::vec3> emitted_;  ///< per light
  std::vector<double> layer_powers_;
  trace::Targets bright_;  ///< empty where light is spread
  ValuedBy of_ends_;
  LightMaps ends_;
  std::vector<std::uint8_t> slats_;  ///< per oriented face, see slats(); empty before it is asked
  Costs costs_;
};

}  // namespace photile::cache
