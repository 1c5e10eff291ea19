// Where light is estimated: what a camera sees, or sensors in the scene. Both fill a film.
#pragma once

#include <cstdint>
#include <span>

#include "common/content_hash.hpp"
#include "photile/ray_scene.hpp"
#include "photile/renderer.hpp"
#include "photile/sensors.hpp"
#include "trace/light_sampler.hpp"

namespace photile {

class HitSource {
 public:
  virtual ~HitSource() = default;
  /// Adds what tells these hits from others of the same scene and film.
  virtual void add_to(ContentHash& hash) const = 0;
  /// The hits of rows [first_row, last_row), as trace_primary_hits returns them.
  virtual PrimaryHitBatch trace(const RayScene& rays, const PrimaryHitParameters& film,
                                int first_row, int last_row,
                                std::span<const std::uint32_t> map_of) const = 0;

  /// Whether automatic light maps are read: hits lie so close that many share nodes.
  virtual bool dense() const { return false; }

  /// A film of standard errors, where they are requested and nodes of light maps gather.
  virtual LightLayers* errors() const { return nullptr; }
};

class CameraHits : public HitSource {
 public:
  ///   errors   made, and filled beside the picture: the noise of nodes, by light; may be null
  explicit CameraHits(const Camera& camera, LightLayers* errors = nullptr)
      : camera_(camera), errors_(errors) {}
  void add_to(ContentHash& hash) const override;
  bool dense() const override { return true; }
  LightLayers* errors() const override { return errors_; }
  PrimaryHitBatch trace(const RayScene& rays, const PrimaryHitParameters& film, int first_row,
                        int last_row, std::span<const std::uint32_t> map_of) const override;

 private:
  const Camera& camera_;
  LightLayers* errors_;
};

/// What a camera sees by reflection alone (trace/hit_batch.hpp).
class ReflectedHits : public HitSource {
 public:
  explicit ReflectedHits(const Camera& camera) : camera_(camera) {}
  void add_to(ContentHash& hash) const override;
  bool dense() const override { return true; }
  PrimaryHitBatch trace(const RayScene& rays, const PrimaryHitParameters& film, int first_row,
                        int last_row, std::span<const std::uint32_t> map_of) const override;

 private:
  const Camera& camera_;
};

/// Whether hits find the light of hot spots (trace/hot_spots.hpp), which photons for points leave
/// out; paths from hits find it themselves.
enum class FindsHotSpots : bool { no, yes };

/// Sensor i is pixel i of a film that is one row high.
class SensorHits : public HitSource {
 public:
  SensorHits(std::span<const Sensor> sensors, FindsHotSpots finds_hot_spots)
      : sensors_(sensors), finds_hot_spots_(finds_hot_spots) {}
  void add_to(ContentHash& hash) const override;
  PrimaryHitBatch trace(const RayScene& rays, const PrimaryHitParameters& film, int first_row,
                        int last_row, std::span<const std::uint32_t> map_of) const override;

 private:
  std::span<const Sensor> sensors_;
  FindsHotSpots finds_hot_spots_;
};

/// What sensors in the air look at. Sensor i is row i of a film that is one pixel wide.
class GatherHits : public HitSource {
 public:
  GatherHits(const Scene& scene, std::span<const Sensor> sensors, SensorResponse response,
             FindsHotSpots finds_hot_spots)
      : sensors_(sensors),
        response_(response),
        light_sampler_(scene),
        finds_hot_spots_(finds_hot_spots) {}
  void add_to(ContentHash& hash) const override;
  PrimaryHitBatch trace(const RayScene& rays, const PrimaryHitParameters& film, int first_row,
                        int last_row, std::span<const std::uint32_t> map_of) const override;

 private:
  std::span<const Sensor> sensors_;
  SensorResponse response_;
  trace::LightSampler light_sampler_;
  FindsHotSpots finds_hot_spots_;
};

/// `render` and `trace_paths` for any hits.
///   film   that they fill, in place of the parameters'
RenderResult render_hits(const Scene& scene, const HitSource& hits, const Film& film,
                         std::span<Device> devices, const RenderParameters& parameters,
                         Progress& progress);
PathTracerResult trace_paths_of_hits(const Scene& scene, const HitSource& hits,
                                     const PrimaryHitParameters& film, Progress& progress);

}  // namespace photile
