// One sample of a pixel: the ray from the eye, through mirrors and glass, to an opaque surface, and
// on in the direction of its lobe.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "photile/camera.hpp"
#include "photile/ray_scene.hpp"
#include "trace/direct_light.hpp"
#include "trace/distant_light.hpp"
#include "trace/hot_spots.hpp"
#include "trace/light_sampler.hpp"
#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"
#include "trace/ray_scene.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

/// The data of each hit for PrimaryHits.
struct EyeHit {
  glm::vec3 position;
  std::uint32_t oriented_face;
  std::uint32_t pixel;
  glm::vec3 throughput;
  glm::vec3 diffuse_albedo;
  float fraction;
};

/// The additional data of a hit in scenes with a glossy surface.
struct GlossyEyeHit {
  glm::vec3 outgoing;
  HitLobe lobe;
};

/// The hits of a run of samples, in the order pixel, sample.
struct EyeRecord {
  std::vector<EyeHit> hits;
  std::vector<GlossyEyeHit> glossy;       ///< one for each hit; empty unless the scene is glossy
  std::vector<VisibleEmission> emission;  ///< by light
  std::vector<VisibleEmission> direct;    ///< directly from lights at the hits, by layer
  std::vector<PixelLobes> lobes;          ///< that rays follow, by pixel
  std::uint64_t rays = 0;
};

/// How hits get direct light, where it is not left to the photons.
struct DirectRays {
  const RayScene& rays;
  const LightSampler& light_sampler;
  int count;  ///< light samples per hit
};

/// How the light that lobes reflect is found where it is not left to the photons.
struct LobeRays {
  const RayScene& rays;
  const LightSampler& light_sampler;
};

/// What all samples of a picture have in common.
struct EyeSetup {
  const RayScene::Impl* rays;
  const FilmDirections* film = nullptr;  ///< of the camera; null where rays do not start at one
  glm::vec3 eye{0.0f};                   ///< where they start
  const PrimaryHitParameters* parameters;
  /// Per light, of white texels, and the light that rays see which leave the scene. Both null where
  /// rays only search surfaces.
  const std::vector<glm::vec3>* emitted_radiance = nullptr;
  const DistantLights* distant = nullptr;
  const DirectRays* direct = nullptr;  ///< null where photons carry all light
  const LobeRays* lobes = nullptr;     ///< null where hits reflect with their lobes
  /// Finds the light of hot spots at hits; null where it is not requested there.
  const LightSampler* hot_spots = nullptr;
  /// Only what comes by a mirror, by glass that bends or reflects it, or by a glossy lobe.
  bool reflections_only = false;
};

/// The density of a ray's direction, where other rays from its start are aimed at hot spots.
struct BesideHotSpots {
  const HotSpotAim& aim;
  double density;  ///< per steradian, of rays that are not aimed
};

/// A ray on its way to the eye's first opaque surface.
struct EyeRay {
  RayOrigin origin;
  glm::vec3 direction;  ///< unit
  glm::vec3 throughput;
  std::uint32_t pixel;
  double radiance_factor = 1;  ///< of Scattered, so far; not in `throughput`
  int depth = 0;               ///< mirrors and glass so far
  bool unscattered = true;     ///< except by panes of thin glass, which light samples pass
  std::uint32_t cutouts = 0;   ///< tested so far
  float fraction = 1.0f;       ///< of its sample, where glass split it
  float sample_share = 1.0f;   ///< of its sample in a usual sample, of which its pixel has fewer
  const BesideHotSpots* beside = nullptr;  ///< null where no rays are aimed

  /// The fraction of a usual sample that it represents.
  float share() const { return fraction * sample_share; }
  /// The factor from the radiance where the ray ends to that at its start.
  glm::vec3 radiance_weight() const { return throughput * static_cast<float>(radiance_factor); }
};

/// Appends what a ray that hits an opaque surface sees there.
void append_hit(const RayScene::Impl& rays, const SurfacePoint& point, const EyeRay& ray,
                EyeRecord& record);

/// Calls visit(sample, what arrives) for the light of each hot spot at a point: as LightSample, and
/// the part of its `received` that arrives.
template <class Visit>
void for_each_hot_light(const RayScene::Impl& rays, const LightSampler& light_sampler,
                        const SurfacePoint& point, const Visit& visit) {
  rays.hot_spots->for_each_at(point.position, [&](std::uint32_t light) {
    const auto sample = light_sampler.towards(light, point.position);
    if (!sample || !(glm::dot(sample->direction, point.normal) > 0.0f)) return;
    const glm::vec3 arrives =
        sample->received *
        transmittance(rays, point.origin_towards(sample->direction), sample->target);
    if (arrives != glm::vec3(0.0f)) visit(*sample, arrives);
  });
}

/// Appends what a ray that is known to hit an opaque surface sees there, and the light of hot spots
/// where that is requested. The surface reflects with its lobe.
void append_eye_hit(const EyeSetup& setup, const SurfacePoint& point, const EyeRay& ray,
                    EyeRecord& record);

/// An opaque surface, and the ray that arrived there.
struct EyeEnd {
  SurfacePoint point;
  EyeRay ray;
};

/// Sampling of lights as a second technique, which also finds the lights that a ray hits directly
/// or through panes.
struct LightTechnique {
  const LightSampler& light_sampler;
  float density;      ///< of the ray's direction, per steradian
  bool only = false;  ///< lights that it does not find get no weight
  const SelectionProbabilities& probabilities = by_power_alone;  ///< at the ray's start
  /// Lights within the scene that the ray hits directly, or through panes, do not count.
  bool distant_only = false;
};

/// Follows a ray through mirrors and glass to an opaque surface and appends what it sees to
/// `record`. Lights that `other` would find as well are weighted by the power heuristic. Returns
/// the surface if it has a lobe that rays are to follow, which is not in the hit then.
///   light_samples   of the hit, where EyeSetup::direct is set
///   split   where given, nothing is left to chance whose lesser part counts enough
///           (defaults::least_glass_fraction), neither between reflection and refraction by glass
///           nor whether a surface that is partly there is met: that part is appended here, to be
///           followed as well ("splitting": Arvo and Kirk, "Particle transport and image
///           synthesis", 1990)
std::optional<EyeEnd> follow_eye_ray(const EyeSetup& setup, EyeRay ray, const RandomStream& random,
                                     EyeRecord& record, const LightTechnique* other = nullptr,
                                     const LightSampleNumbers* light_samples = nullptr,
                                     std::vector<EyeRay>* split = nullptr);

/// Traces sample `sample` of pixel (x, y), which has `times` times as many samples as others, and
/// appends what it sees.
///   record      of the surface that the pixel sees
///   reflected   of the surfaces that lobes reflect
void trace_eye_path(const EyeSetup& setup, int x, int y, int sample, int times, EyeRecord& record,
                    EyeRecord& reflected);

/// Whether a pixel shows an edge, or a border of a texture: whether a few rays of their own, over
/// mirrors and through glass, hit more than one surface of about one colour. Adds them to `record`.
bool shows_edge(const EyeSetup& setup, int x, int y, EyeRecord& record);

/// The source of the random numbers of a pixel's sample.
struct PixelSample {
  const RandomStream& of_pixel;  ///< sequences that all samples of the pixel share
  std::uint32_t index;           ///< of the sample, into them
  std::uint64_t path;            ///< of the sample alone, as RandomStream numbers them
  std::uint32_t ray = 0;  ///< the ray's number among those that follow the sample's first lobe
};

/// Follows the lobe of `end`, and those of the surfaces met, and appends what each reflects beside
/// its lobe to `record`, and lights seen in lobes: at each surface a light is sampled, and one
/// direction of the lobe is followed; what both would find is weighted by the power heuristic
/// (Veach and Guibas 1995). Directions are those of visible normals (opaque_bsdf.hpp). Paths that
/// reflect little continue by Russian roulette.
void follow_lobes(const EyeSetup& setup, EyeEnd end, const PixelSample& sample, EyeRecord& record);

}  // namespace photile::trace
