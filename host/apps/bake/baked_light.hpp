// Light maps as textures: the light of an atlas.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/light_atlas.hpp"
#include "cache/light_maps.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"

namespace photile::bake {

/// The light of an atlas: of each triangle the side on which more light falls, and the other where
/// it is open and lit, too. Texels under things that stand on a surface hold the light beside
/// these, for lookups there.
class BakedLight : public LightAtlas {
 public:
  /// Values the nodes that texels need. Errors: those of LightAtlas and of LightMaps::fill.
  ///   progress   reports a stage
  BakedLight(const Scene& scene, cache::LightMaps& maps, const BakeParameters& parameters,
             Progress& progress);

  /// Irradiance of a layer at power 1: width x height, row 0 at the top; 0 where no chart lies.
  /// Where nodes know how light depends on the normal it is that of the shading normal.
  std::vector<glm::vec3> layer(std::size_t layer) const;
  /// Standard error of the luminance of `layer`, in the same form, from that of nodes.
  ///   of_nodes   as GatheredNodes::errors
  std::vector<float> errors(std::size_t layer, const LightTable& of_nodes) const;
  /// Root mean square of the standard errors of all light together, relative to the mean light:
  /// texels without light have none.
  ///   powers   per layer
  double standard_error(std::span<const double> powers, const LightTable& of_nodes) const;
  /// Per layer whether its light is on any texel of these sides.
  ///   sides   per oriented face 1, else 0
  std::vector<bool> reaches(std::span<const std::uint8_t> sides, std::size_t layers) const;

 private:
  /// Returns the points of all texels; the side is none where there is none.
  PrimaryHits fill(Progress& progress);
  void spread(const PrimaryHits& points);

  cache::LightMaps& maps_;
  std::vector<cache::BilinearWeights> bilinear_;  ///< per texel
  std::vector<glm::vec3> normal_;                 ///< per texel, where light depends on it
};

}  // namespace photile::bake
