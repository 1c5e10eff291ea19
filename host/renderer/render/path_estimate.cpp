#include "render/path_estimate.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "light/light_at_points.hpp"
#include "light/row_sum.hpp"
#include "photile/renderer.hpp"
#include "render/film.hpp"
#include "render/hit_source.hpp"
#include "render/pass_count.hpp"
#include "render/render_costs.hpp"
#include "render/render_session.hpp"
#include "trace/ray_query.hpp"
#include "trace/shading_point.hpp"

namespace photile {

std::vector<std::uint64_t> path_numbers(const PrimaryHits& hits, const PrimaryHitParameters& film,
                                        int first_row, int last_row) {
  const std::uint32_t first_pixel = static_cast<std::uint32_t>(first_row * film.width);
  std::vector<std::uint32_t> sample(
      static_cast<std::size_t>(last_row - first_row) * static_cast<std::size_t>(film.width),
      static_cast<std::uint32_t>(film.pass));
  std::vector<std::uint64_t> number;
  number.reserve(hits.size());
  for (const std::uint32_t pixel : hits.pixel) {
    std::uint32_t& next = sample[pixel - first_pixel];
    number.push_back(std::uint64_t{pixel} * static_cast<std::uint64_t>(film.samples_per_pixel) +
                     next);
    next += static_cast<std::uint32_t>(film.passes);
  }
  return number;
}

namespace {

/// Large enough to make a task's cost vanish, small enough to share work and to stop soon.
constexpr std::size_t hits_per_path_task = 1024;

}  // namespace

PathEstimator::PathEstimator(const RayScene& rays, std::uint64_t seed)
    : rays_(rays), seed_(seed), needs_(rays.needs()), lights_(rays.scene()) {}

LightTable PathEstimator::estimate(const PrimaryHits& hits, std::span<const std::uint64_t> number,
                                   const Progress& progress) const {
  const auto write = [&](std::size_t first, std::size_t last, LightTable& rows) {
    progress.throw_if_cancelled();
    const trace::FlushDenormals flush_denormals;
    light::RowSum<light::Reflection> sums(needs_.light_count);
    std::vector<PathLight> found;
    for (std::size_t hit = first; hit < last; ++hit) {
      const trace::SurfacePoint start = trace::point_of(rays_.scene(), hits, hit);
      const trace::RandomStream random(seed_, number[hit], 0);
      found.clear();
      const trace::OpaqueBsdf bsdf = trace::bsdf_of(rays_.scene(), hits, hit, start);
      trace_surface_path(rays_, lights_, start, bsdf, random, found);
      for (const PathLight& light : found) {
        sums.of(light.layer).add(light.irradiance, light.radiance);
      }
      light::end_row(sums, rows, needs_.tells_radiance());
    }
  };
  return light::rows_by_tasks(hits.size(), hits_per_path_task, LightTable(needs_), write);
}

namespace {

/// Paths traced at a time: little enough to stay in memory and to show progress.
constexpr std::int64_t paths_per_batch = std::int64_t{1} << 18;

}  // namespace

PathTracerResult trace_paths_of_hits(const Scene& scene, const HitSource& source,
                                     const PrimaryHitParameters& parameters, Progress& progress) {
  check_picture_memory(parameters.width, parameters.height, scene, progress);
  StageCost hits, paths, film_cost;
  const PreparedScene prepared(scene);
  const RayScene& rays = prepared.rays;
  const PathEstimator estimator(rays, parameters.seed);

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
      const LightTable estimates =
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
  return trace_paths_of_hits(scene, camera_hits(camera), film, progress);
}

bool has_hidden_caustics(const Scene& scene) {
  return needs_of(scene).specular_paths &&
         std::any_of(scene.lights.begin(), scene.lights.end(),
                     [](const Light& light) { return !light.has_size(); });
}

}  // namespace photile
