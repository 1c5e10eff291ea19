#include <algorithm>
#include <vector>

#include "photile/renderer.hpp"
#include "render/film.hpp"
#include "render/hit_source.hpp"
#include "render/path_estimate.hpp"
#include "render/path_numbers.hpp"
#include "render/render_costs.hpp"
#include "render/render_session.hpp"

namespace photile {
namespace {

/// Paths traced at a time: little enough to stay in memory and to show progress.
constexpr std::int64_t paths_per_batch = std::int64_t{1} << 18;

}  // namespace

PathTracerResult trace_paths_of_hits(const Scene& scene, const HitSource& source,
                                     const PrimaryHitParameters& parameters, Progress& progress) {
  StageCost hits, paths, film_cost;
  const PreparedScene prepared(scene);
  const RayScene& rays = prepared.rays;
  const reference::PathEstimator estimator(rays, parameters.seed);

  PrimaryHitParameters film = parameters;
  film.direct_rays = 0;  // paths find that light themselves
  const std::int64_t row_samples = std::int64_t{film.width} * film.samples_per_pixel;
  film.passes = static_cast<int>(
      std::clamp<std::int64_t>(row_samples / paths_per_batch, 1, film.samples_per_pixel));
  const int rows = static_cast<int>(std::clamp<std::int64_t>(
      paths_per_batch / std::max<std::int64_t>(1, row_samples), 1, std::max(1, film.height)));
  LightLayers layers(film.width, film.height, scene);
  double rays_seen = 0, path_count = 0;
  progress.begin("trace paths", static_cast<std::uint64_t>(film.height) * film.passes, "rows");
  for (int first = 0; first < film.height; first += rows) {
    const int last = std::min(first + rows, film.height);
    for (film.pass = 0; film.pass < film.passes; ++film.pass) {
      progress.throw_if_cancelled();
      const Stopwatch hit_watch;
      const PrimaryHitBatch batch = source.trace(rays, film, first, last, {});
      hits.add(hit_watch.taken());
      const Stopwatch path_watch;
      const Estimates estimates =
          estimator.estimate(batch.hits, path_numbers(batch.hits, film, first, last), progress);
      paths.add(path_watch.taken());
      const Stopwatch film_watch;
      add_to_film(layers, batch, estimates, 1.0f / static_cast<float>(film.samples_per_pixel));
      film_cost.add(film_watch.taken());
      rays_seen += static_cast<double>(batch.rays);
      path_count += static_cast<double>(batch.hits.size());
      progress.advance(static_cast<std::uint64_t>(last - first));
    }
  }
  progress.end();
  film_cost.host_bytes = layers.bytes();
  return {
      .layers = std::move(layers),
      .statistics = {stage("ray tracing structure", prepared.cost),
                     stage("primary hits", hits, {{"rays", rays_seen}}),
                     stage("trace paths", paths,
                           {{"paths", path_count},
                            {"paths per second", path_count / std::max(1e-9, paths.time.seconds)}}),
                     stage("film", film_cost)}};
}

PathTracerResult trace_paths(const Scene& scene, const Camera& camera,
                             const PrimaryHitParameters& film, Progress& progress) {
  return trace_paths_of_hits(scene, CameraHits(camera), film, progress);
}

bool has_unseen_caustics(const Scene& scene) {
  return needs_of(scene).specular_paths &&
         std::any_of(scene.lights.begin(), scene.lights.end(),
                     [](const Light& light) { return !light.has_size(); });
}

}  // namespace photile
