// The one question that rendering asks: what light arrives at points of surfaces. With it, what an
// estimate says about the light that leaves a point, and estimates put together on the host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "photile/estimator.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"

namespace photile::estimate {

/// Tells the irradiance and the reflected radiance of every light at points of opaque surfaces.
/// The photon estimate answers by photons, rays that gather by asking another where they end, a
/// cache by samples that another valued, and an exchange by asking the process that has the
/// photons. RenderPlan::light says which of them a rendering is made of.
class LightAtPoints {
 public:
  virtual ~LightAtPoints() = default;

  /// Each light at power 1, a row for each point, in the order of the points.
  /// Errors: DeviceError and what follows from it; Interrupted, when `progress` says so.
  virtual Estimates at(const PrimaryHits& points, const Progress& progress) = 0;
};

/// Radiance that a hit sends against the ray that arrived, of the light of estimate `index`.
inline glm::vec3 reflected_radiance(const PrimaryHits& hits, std::size_t hit,
                                    const Estimates& estimates, std::size_t index) {
  return estimates.radiance.empty()
             ? hits.diffuse_albedo[hit] * glm::one_over_pi<float>() * estimates.irradiance[index]
             : estimates.radiance[index];
}

/// Calls visit(layer, index) for each estimate of a hit.
///   lights   layers of the scene
template <class Visit>
void for_each_estimate(const Estimates& estimates, std::size_t hit, std::size_t lights,
                       const Visit& visit) {
  if (estimates.first.empty()) {
    for (std::size_t layer = 0; layer < lights; ++layer) visit(layer, hit * lights + layer);
    return;
  }
  for (std::size_t i = estimates.first[hit]; i < estimates.first[hit + 1]; ++i) {
    visit(std::size_t{estimates.light[i]}, i);
  }
}

/// Writes the estimates of hits one after another, in the form that the scene asks for.
class EstimateWriter {
 public:
  /// References are kept. `estimates` is empty.
  EstimateWriter(const SceneNeeds& needs, Estimates& estimates);

  /// Adds what a layer gives to the hit. Sums run in the order of the calls.
  ///   irradiance   W/m2 or lm/m2
  ///   radiance     reflected, W/(m2 sr) or cd/m2
  void add(std::uint32_t layer, const glm::vec3& irradiance, const glm::vec3& radiance);

  /// Writes the hit; the next one begins.
  void end_hit();

 private:
  void append(std::uint32_t layer);

  bool sparse_, has_radiance_;
  Estimates& estimates_;
  std::vector<glm::vec3> irradiance_, radiance_;  ///< per layer, of the hit
  std::vector<std::uint8_t> is_lit_;              ///< per layer
  std::vector<std::uint16_t> lit_;                ///< layers, in the order in which they came
};

}  // namespace photile::estimate
