// Where light is estimated: what a camera sees, or sensors in the scene. Both fill a film.
#pragma once

#include <cstdint>
#include <span>

#include "photile/path_tracer.hpp"
#include "photile/primary_hits.hpp"
#include "photile/renderer.hpp"
#include "photile/sensors.hpp"
#include "trace/light_sampler.hpp"

namespace photile {

class HitSource {
 public:
  virtual ~HitSource() = default;
  /// The hits of rows [first_row, last_row), as trace_primary_hits returns them.
  virtual PrimaryHitBatch trace(const RayScene& rays, const PrimaryHitParameters& film,
                                int first_row, int last_row,
                                std::span<const std::uint32_t> map_of) const = 0;
};

class CameraHits : public HitSource {
 public:
  explicit CameraHits(const Camera& camera) : camera_(camera) {}
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
RenderResult render_hits(const Scene& scene, const HitSource& hits, std::span<Device> devices,
                         const RenderParameters& parameters, Progress& progress);
PathTracerResult trace_paths_of_hits(const Scene& scene, const HitSource& hits,
                                     const PrimaryHitParameters& film, Progress& progress);

}  // namespace photile
