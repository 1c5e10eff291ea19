// The cache on surfaces: light interpolated between samples where these suffice, and requested
// where they do not; and which reflections need no light gathered at nodes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cache/light_maps.hpp"
#include "light/light_at_points.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/statistics.hpp"

namespace photile::cache {

class GatheredNodes;

/// How visible the noise of photon estimates is.
struct PhotonNoise {
  double width;  ///< metres, over which estimates have the same error
  double noise;  ///< relative
};

/// Whether the light that lobes reflect may be that of photon estimates: where they would add
/// little noise to the pixel, because errors are equal nearby and independent farther apart, and a
/// pixel sees many estimates in a rough or curved surface, or gives them little weight. Depends on
/// the hits of a pixel alone, so the same number of a pixel's samples must be present.
///   seen        hits of the pixels themselves
///   reflected   those that lobes reflect
///   runs        of the samples of a pixel, as in PrimaryHitParameters
/// Returns 1 or 0 for each of `reflected`.
std::vector<std::uint8_t> suits_photons(const PrimaryHits& seen, const PrimaryHits& reflected,
                                        int runs, const PhotonNoise& noise);

/// A sum of squared relative standard errors, each times its weight.
struct ErrorSum {
  double squares = 0, weight = 0;

  /// The root mean square; 0 where there are none.
  double mean() const;
};

/// Light at points, and its standard errors in the same form.
struct LightAndErrors {
  LightTable light, errors;
};

/// Light interpolated between nodes on the surface, where its direction does not matter.
class SurfaceCache : public light::LightAtPoints {
 public:
  /// References are kept.
  ///   elsewhere   the source for points that nodes cannot serve: those with a specular lobe, and
  ///               those with a normal map where photons fill nodes: the direction of light
  ///               matters. What a point gets from it does not depend on the points beside it.
  ///   source      fills nodes
  ///   ends        where rays fill nodes, the light maps that they read where they end; points
  ///               read them, too, where PrimaryHits::coarse says that they suffice; null where
  ///               photons fill nodes: the coarsest nodes are read there
  SurfaceCache(const RayScene& rays, const LightMapParameters& parameters,
               light::LightAtPoints& elsewhere, NodeSource& source, LightMaps* ends);

  /// The light at points in any order.
  LightTable at(const PrimaryHits& points, const Progress& progress) override;

  /// The same light, and its errors. Nodes around a point are assumed to have equal errors; where
  /// photons were used, the error is that of a density from k of them.
  ///   nodes   the source that fills the nodes
  LightAndErrors with_errors(const PrimaryHits& points, const GatheredNodes& nodes,
                             const Progress& progress);

  /// The noise of the light that photons alone give.
  PhotonNoise photon_noise() const;

  LightMaps& maps() { return maps_; }
  const LightMaps& maps() const { return maps_; }

  /// The number of hits so far whose light was not read from nodes.
  std::uint64_t hits_alone() const { return hits_alone_; }
  /// The errors of all light read at hits so far; zeros where photons fill nodes.
  const ErrorSum& errors_read() const { return errors_read_; }
  TimeTaken fill_time() const { return fill_time_; }

 private:
  /// Whether the light of a hit can be read: it has no specular lobe, which depends on the
  /// direction of light, nor a normal map, unless nodes store light by the normal.
  bool serves(const PrimaryHits& hits, std::size_t hit) const;

  struct Reading;
  Reading read(const PrimaryHits& points, const Progress& progress);
  LightTable light_of(const Reading& reading, const Progress& progress);
  enum class Coarse { between_nodes, found };
  LightTable rows(const Reading& reading, const LightTable& of_alone, const LightTable& of_nodes,
                  const LightTable& of_coarse, Coarse coarse_rows) const;
  /// Of some of the points, between these nodes; each counts as the part of a sample that it is.
  void count_errors(const PrimaryHits& points, std::span<const std::uint32_t> part,
                    std::span<const BilinearWeights> nodes);

  const Scene& scene_;
  const SceneNeeds needs_;
  const double neighbours_;  ///< of a photon estimate
  light::LightAtPoints& elsewhere_;
  LightMaps maps_;
  LightMaps* ends_;
  std::uint64_t hits_alone_ = 0;
  ErrorSum errors_read_;
  TimeTaken fill_time_;
};

}  // namespace photile::cache
