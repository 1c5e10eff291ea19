// A scene prepared for ray tracing, and what the camera sees of it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "photile/camera.hpp"
#include "photile/defaults.hpp"
#include "photile/scene.hpp"

namespace photile {

/// The scene's triangles in an Embree BVH. Immutable and shared between threads once built.
class RayScene {
 public:
  /// Builds the BVH. `scene` must outlive this object.
  /// Errors: Error(failure) when Embree cannot allocate.
  explicit RayScene(const Scene& scene);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  const Scene& scene() const;
  const SceneNeeds& needs() const;  ///< of the scene, computed once
  std::uint64_t bytes() const;      ///< held by Embree

  struct Impl;

 private:
  friend const Impl& impl_of(const RayScene& scene);

  std::unique_ptr<Impl> impl_;
};

/// Specular lobe at a hit, for the estimate of glossy reflection (device/bsdf.h).
struct HitLobe {
  glm::vec3 specular;             ///< F0
  float roughness;                ///< GGX alpha
  glm::vec3 normal;               ///< unit shading normal, on the side of the ray
  float f90 = 1.0f;               ///< reflectance at grazing incidence
  glm::vec3 smooth_normal{0.0f};  ///< `normal` without a normal map; only in scenes that have one
};

/// Hits on opaque surfaces, after mirrors and glass were followed. A structure of arrays, pixel by
/// pixel; the hits of a pixel are ordered by photon map, then along a space-filling curve, and
/// their light is summed in this order.
struct PrimaryHits {
  std::vector<glm::vec3> position;  ///< metres
  std::vector<std::uint32_t> oriented_face;
  std::vector<std::uint32_t> pixel;       ///< y * width + x
  std::vector<glm::vec3> throughput;      ///< the weight of the hit's radiance in its pixel
  std::vector<glm::vec3> diffuse_albedo;  ///< textured Lambertian albedo at the hit
  std::vector<glm::vec3> outgoing;        ///< unit, towards the eye; empty unless glossy
  std::vector<HitLobe> lobe;              ///< empty unless glossy
  /// Per hit: its part of a sample, for its illuminance; empty where all are whole.
  std::vector<float> fraction;
  /// Whether a coarse estimate suffices, because its noise will not show
  /// (host/renderer/cache/reflection_noise.cpp); empty where it suffices for no hit.
  std::vector<std::uint8_t> coarse;

  std::size_t size() const { return position.size(); }
};

/// Light that needs no estimate: a light seen directly or through mirrors and glass, or the direct
/// light of one at a hit. It is added to the layer of its light.
struct VisibleEmission {
  std::uint32_t pixel;
  std::uint32_t light;    ///< layer, into LightGroups::groups
  glm::vec3 radiance;     ///< throughput x radiance where the layer's power is 1
  float illuminance = 0;  ///< of the surface seen, where the layer's power is 1, lux
};

struct PrimaryHitParameters {
  int width = defaults::image_width;
  int height = defaults::image_height;
  int samples_per_pixel = defaults::samples_per_pixel;
  /// Pixels that show an edge have this many times as many samples, each with a correspondingly
  /// smaller weight.
  int times_at_edges = 1;
  std::uint64_t seed = defaults::seed;
  int max_specular_depth = defaults::max_specular_depth;
  /// Only samples pass, pass + passes, pass + 2 passes ... of each pixel are traced.
  int pass = 0;
  int passes = 1;
  /// > 0: direct light at each hit is found by this many light samples and as many directions
  /// sampled from the surface, and photons have to carry only the rest
  /// (PhotonTracerParameters::store_direct).
  int direct_rays = 0;
  /// Lobes that are narrow, or reflect little, are left out of hits: a ray from each hit follows
  /// them to the surfaces that they reflect (PrimaryHitBatch::reflected).
  bool lobe_rays = false;
  /// Samples follow both the reflection and the refraction of glass, as long as both count
  /// (defaults::least_glass_fraction), and have a hit for each; else they follow one of them at
  /// random.
  bool split_at_glass = false;
  /// > 1: the samples of a pixel are divided into this many runs, and a hit's pixel is that of a
  /// film which is wider by this factor: y * width * runs + x * runs + run. Runs follow each other
  /// in the sequence of the pixel.
  int runs = 1;
};

/// The surfaces of a pixel whose lobes are followed by rays: sums over its samples, each with its
/// weight.
struct PixelLobes {
  std::uint32_t pixel = 0;
  float weight = 0;             ///< of the samples; 1 where all of them hit such a surface
  glm::vec3 position{0.0f};     ///< metres
  glm::vec3 normal{0.0f};       ///< unit shading normals
  glm::vec3 reflectance{0.0f};  ///< of the lobe, towards the eye
  float roughness = 0;          ///< GGX alpha

  void add(const PixelLobes& more);
};

struct PrimaryHitBatch {
  PrimaryHits hits;
  std::vector<VisibleEmission> emission;
  PrimaryHits reflected;  ///< on surfaces seen in lobes; their illuminance is not the pixel's
  std::vector<VisibleEmission> reflected_emission;  ///< seen in lobes
  std::vector<PixelLobes> lobes;                    ///< of pixels that have any, row by row
  std::uint64_t rays = 0;
};

/// Traces the samples of the rows [first_row, last_row) that belong to the pass. Each sample
/// carries weight 1 / samples_per_pixel in `throughput` and `radiance`, so that summing gives pixel
/// means. Depends on the scene, camera, parameters and seed only, not on how rows are split or on
/// threads.
///   map_of   map of each oriented face (PhotonMaps::map_of), for the order of a pixel's hits;
///            empty where an oriented face is the map itself
PrimaryHitBatch trace_primary_hits(const RayScene& scene, const Camera& camera,
                                   const PrimaryHitParameters& parameters, int first_row,
                                   int last_row, std::span<const std::uint32_t> map_of = {});

/// Radiance that each light emits towards the front of its triangles where its layer's power is 1:
/// its fraction of the layer / (pi A) x colour, A counting both sides of two-sided lights; of
/// textured lights that of a white texel. Zero for lights without area.
std::vector<glm::vec3> emitted_radiance_at_unit_power(const Scene& scene);

}  // namespace photile
