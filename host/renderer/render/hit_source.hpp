// Where light is estimated: at what a camera sees, or at sensors in the scene. Both fill a film.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "common/content_hash.hpp"
#include "photile/ray_scene.hpp"
#include "photile/renderer.hpp"
#include "photile/sensors.hpp"

namespace photile {

/// Traces the hits of rows [first_row, last_row), as trace_primary_hits returns them.
using TraceHits = std::function<PrimaryHitBatch(
    const RayScene& rays, const PrimaryHitParameters& film, int first_row, int last_row,
    std::span<const std::uint32_t> map_of)>;

struct HitSource {
  TraceHits trace;
  /// Adds what distinguishes these hits from others of the same scene and film.
  std::function<void(ContentHash& hash)> add_to;
  /// Whether automatic light maps are read: hits lie so close that many share nodes.
  bool dense = false;
  /// A film of standard errors, which is made, and filled beside the picture where nodes of light
  /// maps gather: their noise, by light. Null: none is requested.
  LightLayers* errors = nullptr;
};

// References are kept.

HitSource camera_hits(const Camera& camera, LightLayers* errors = nullptr);

/// What a camera sees by reflection alone (trace/hit_batch.hpp).
HitSource reflected_hits(const Camera& camera);

/// Whether hits find the light of hot spots (trace/hot_spots.hpp), which photons for points leave
/// out; paths from hits find it themselves.
enum class FindsHotSpots : bool { no, yes };

/// Sensor i is pixel i of a film that is one row high.
HitSource sensor_hits(std::span<const Sensor> sensors, FindsHotSpots finds_hot_spots);

/// What sensors in the air see. Sensor i is row i of a film that is one pixel wide.
HitSource gathered_hits(const Scene& scene, std::span<const Sensor> sensors,
                        SensorResponse response, FindsHotSpots finds_hot_spots);

/// `render` and `trace_paths` for any hits.
///   film   that they fill, instead of that of the parameters
RenderResult render_hits(const Scene& scene, const HitSource& hits, const Film& film,
                         std::span<Device> devices, const RenderParameters& parameters,
                         Progress& progress);
PathTracerResult trace_paths_of_hits(const Scene& scene, const HitSource& hits,
                                     const PrimaryHitParameters& film, Progress& progress);

}  // namespace photile
