// Light from beyond the scene that rays can hit (surroundings, the disc of a sun), and directions
// towards it in proportion to its luminance.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "photile/scene.hpp"
#include "trace/random_stream.hpp"

namespace photile::trace {

/// Chooses a row of the map by its luminance, then a texel of the row, then a direction uniformly
/// over the texel's solid angle (Pharr, Jakob and Humphreys, "Physically Based Rendering", 12.5).
class EnvironmentSampler {
 public:
  /// A reference is kept. `map` is not black.
  explicit EnvironmentSampler(const EnvironmentMap& map);

  /// In proportion to luminance times a factor, given for the middle of each texel, >= 0.
  EnvironmentSampler(const EnvironmentMap& map,
                     const std::function<double(const glm::dvec3& direction)>& factor);
  /// Whether there is a direction to choose.
  bool empty() const { return !(row_up_to_.back() > 0); }

  struct Sample {
    glm::vec3 direction;  ///< unit, towards the surroundings
    glm::vec3 color;      ///< radiance / luminance of the texel
    float density;        ///< per steradian: luminance x factor / its integral over the sphere
  };
  Sample sample(const RandomBlock& random) const;
  float density(const glm::vec3& direction) const;

 private:
  /// The weight of a texel: luminance x factor.
  double weight(int column, int row) const;

  const EnvironmentMap* map_;
  std::vector<double>
      row_up_to_;  ///< luminance x solid angle of the rows up to and including this one
  std::vector<double>
      texel_up_to_;  ///< luminance of the texels of a row up to and including this one
};

/// A light beyond the scene as rays see it.
class DistantLight {
 public:
  /// References are kept.
  ///   fraction   of the light in its layer
  ///   radius  of the scene's bounding sphere, metres
  DistantLight(const Scene& scene, std::uint32_t light, double fraction, double radius);

  std::uint32_t light() const { return light_; }
  const Light& source() const { return *source_; }
  /// Radiance that arrives from a unit direction where the layer's power is 1.
  glm::vec3 radiance(const glm::vec3& direction) const;

 private:
  const Light* source_;
  const EnvironmentMap* map_ = nullptr;
  std::uint32_t light_;
  glm::vec3 factor_;  ///< radiance of the disc, or the factor of the map's radiance
};

/// All distant lights of a scene. Where there are many, most are patches of a sky and discs of
/// suns: those that a direction can hit are found by cells of the sphere.
class DistantLights {
 public:
  explicit DistantLights(const Scene& scene);

  bool empty() const { return lights_.empty(); }
  auto begin() const { return lights_.begin(); }
  auto end() const { return lights_.end(); }
  const DistantLight& operator[](std::size_t index) const { return lights_[index]; }

  /// The lights that may shine from a unit direction, as indices; the list contains all that do.
  std::span<const std::uint32_t> towards(const glm::vec3& direction) const {
    return cells_.size() == 1 ? cells_.front() : cells_[cell_towards(direction)];
  }

  /// Calls visit(light, radiance) for those that shine from a unit direction.
  template <class Visit>
  void for_each_shining(const glm::vec3& direction, const Visit& visit) const {
    for (const std::uint32_t index : towards(direction)) {
      const glm::vec3 radiance = lights_[index].radiance(direction);
      if (radiance != glm::vec3(0.0f)) visit(lights_[index], radiance);
    }
  }

 private:
  static std::size_t cell_towards(const glm::vec3& direction);

  std::vector<DistantLight> lights_;
  std::vector<std::vector<std::uint32_t>> cells_;
};

/// Whether a unit direction points into the disc of a directional light, or into its patch.
bool sees_disc(const Light& sun, const glm::vec3& direction);
/// Solid angle of the disc, or of the patch, of a directional light, steradian.
double disc_solid_angle(const Light& sun);

/// Chooses directions towards a light beyond the scene, in proportion to its luminance.
class DistantSampler {
 public:
  /// References are kept. Surroundings are not black.
  DistantSampler(const Scene& scene, const Light& light);

  using Sample = EnvironmentSampler::Sample;
  Sample sample(const RandomBlock& random) const;
  /// The middle of a disc or of a patch, unit.
  glm::dvec3 middle() const;
  /// Per steradian, of a unit direction.
  float density(const glm::vec3& direction) const;

 private:
  const Light* light_;
  std::optional<EnvironmentSampler> map_;
};

}  // namespace photile::trace
