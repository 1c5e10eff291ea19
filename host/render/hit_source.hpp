// Where light is estimated: what a camera sees, or sensors in the scene. Both fill a film.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "photile/path_tracer.hpp"
#include "photile/primary_hits.hpp"
#include "photile/renderer.hpp"
#include "photile/sensors.hpp"
#include "trace/light_sampler.hpp"

namespace photile {

class LightMapFrames;

class HitSource {
 public:
  virtual ~HitSource() = default;
  /// The hits of rows [first_row, last_row), as trace_primary_hits returns them.
  virtual PrimaryHitBatch trace(const RayScene& rays, const PrimaryHitParameters& film,
                                int first_row, int last_row,
                                std::span<const std::uint32_t> map_of) const = 0;

  /// Whether automatic light maps are read: hits lie so close that many share nodes.
  virtual bool dense() const { return false; }

  /// A film of standard errors, for those who ask for them where nodes of light maps gather.
  virtual LightLayers* errors() const { return nullptr; }

  /// Whether somebody watches the film fill: renderers then finish fewer rows at a time.
  virtual bool watched() const { return false; }
  /// Whether a first, coarse picture is waited for (render/first_picture.hpp).
  virtual bool awaits_first() const { return false; }
  /// Draws it from these frames.
  virtual void draw_first(LightMapFrames&, const Film&, const Progress&) const {}
  /// Rows [first, last) of the film are as far as they will be for a while: `share` of their light
  /// is there, in (0, 1].
  virtual void show(const LightLayers&, int /*first*/, int /*last*/, double /*share*/) const {}
};

class CameraHits : public HitSource {
 public:
  ///   errors   made, and filled beside the picture: the noise of nodes, by light; may be null
  explicit CameraHits(const Camera& camera, LightLayers* errors = nullptr)
      : camera_(camera), errors_(errors) {}
  bool dense() const override { return true; }
  LightLayers* errors() const override { return errors_; }
  PrimaryHitBatch trace(const RayScene& rays, const PrimaryHitParameters& film, int first_row,
                        int last_row, std::span<const std::uint32_t> map_of) const override;

 protected:
  const Camera& camera() const { return camera_; }

 private:
  const Camera& camera_;
  LightLayers* errors_;
};

/// What a camera sees, for somebody who watches.
class WatchedHits : public CameraHits {
 public:
  using Watcher = std::function<void(const LightLayers&, int first, int last, double share)>;
  /// Who is shown a picture before there are rows.
  struct FirstWatcher {
    std::vector<glm::vec3> powers;  ///< per layer: power x tint
    /// Linear RGB radiance.
    std::function<void(int width, int height, std::span<const glm::vec3> picture)> watch;
  };
  ///   first   is shown the light on surfaces as soon as it is known at all, once
  WatchedHits(const Camera& camera, LightLayers* errors, Watcher watcher, FirstWatcher first = {})
      : CameraHits(camera, errors), watcher_(std::move(watcher)), first_(std::move(first)) {}
  bool watched() const override { return true; }
  bool awaits_first() const override { return first_.watch && !shown_; }
  void draw_first(LightMapFrames& frames, const Film& film,
                  const Progress& progress) const override;
  void show(const LightLayers& layers, int first, int last, double share) const override {
    shown_ = true;
    watcher_(layers, first, last, share);
  }

 private:
  Watcher watcher_;
  FirstWatcher first_;
  mutable bool shown_ = false;  ///< anything: what comes first is no better than that
};

/// What a camera sees by reflection alone (trace/reflected_hits.hpp).
class ReflectedHits : public HitSource {
 public:
  explicit ReflectedHits(const Camera& camera) : camera_(camera) {}
  bool dense() const override { return true; }
  PrimaryHitBatch trace(const RayScene& rays, const PrimaryHitParameters& film, int first_row,
                        int last_row, std::span<const std::uint32_t> map_of) const override;

 private:
  const Camera& camera_;
};

/// Sensor i is pixel i of a film that is one row high.
class SensorHits : public HitSource {
 public:
  explicit SensorHits(std::span<const Sensor> sensors) : sensors_(sensors) {}
  PrimaryHitBatch trace(const RayScene& rays, const PrimaryHitParameters& film, int first_row,
                        int last_row, std::span<const std::uint32_t> map_of) const override;

 private:
  std::span<const Sensor> sensors_;
};

/// What sensors in the air look at. Sensor i is row i of a film that is one pixel wide.
class GatherHits : public HitSource {
 public:
  GatherHits(const Scene& scene, std::span<const Sensor> sensors, SensorResponse response)
      : sensors_(sensors), response_(response), lamps_(scene) {}
  PrimaryHitBatch trace(const RayScene& rays, const PrimaryHitParameters& film, int first_row,
                        int last_row, std::span<const std::uint32_t> map_of) const override;

 private:
  std::span<const Sensor> sensors_;
  SensorResponse response_;
  trace::LightSampler lamps_;
};

/// `render` and `trace_paths` for any hits.
///   film   that they fill, in place of the parameters'
RenderResult render_hits(const Scene& scene, const HitSource& hits, const Film& film,
                         std::span<Device> devices, const RenderParameters& parameters,
                         Progress& progress);
PathTracerResult trace_paths_of_hits(const Scene& scene, const HitSource& hits,
                                     const PrimaryHitParameters& film, Progress& progress);

}  // namespace photile
