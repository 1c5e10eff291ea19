// Quick renderings of a view that tell its error and time apart by their causes.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "photile/layered_picture.hpp"
#include "photile/photon_tracer.hpp"
#include "photile/picture_error.hpp"
#include "photile/statistics.hpp"
#include "render/film.hpp"
#include "tools/trade/error_model.hpp"
#include "tools/trade/quality_target.hpp"
#include "trace/random_stream.hpp"

namespace photile {
namespace {

constexpr std::array pilot_neighbours{16, 64, 256};
constexpr std::size_t middle = 1;         ///< the k whose mean picture stands for the reference
constexpr double least_variance = 1e-12;  ///< of a picture without noise: below what floats hold

/// What the photons of one seed show.
struct SeedPictures {
  std::array<Image, pilot_neighbours.size()> pictures;             ///< per k
  std::array<double, pilot_neighbours.size()> estimate_seconds{};  ///< per k
  double fixed_seconds = 0, photon_seconds = 0, hit_seconds = 0, film_seconds = 0;
  std::uint64_t hits = 0;
};

class Pilot {
 public:
  Pilot(const Scene& scene, const Camera& camera, Device& device, const LightMix& mix,
        const RenderParameters& parameters)
      : scene_(scene), camera_(camera), device_(device), mix_(mix), parameters_(parameters) {
    PrimaryHitParameters& film = parameters_.film;
    const double shrink = std::min(1.0, static_cast<double>(defaults::pilot_height) / film.height);
    film.width = std::max(1, static_cast<int>(std::lround(shrink * film.width)));
    film.height = std::max(1, static_cast<int>(std::lround(shrink * film.height)));
    parameters_.photons.emitted_photons =
        std::min(parameters_.photons.emitted_photons, defaults::pilot_photons);
  }

  const PrimaryHitParameters& film() const { return parameters_.film; }
  double photons() const { return static_cast<double>(parameters_.photons.emitted_photons); }

  SeedPictures render(const RayScene& rays, std::uint64_t seed, const Progress& progress) {
    parameters_.photons.seed = parameters_.film.seed = seed;
    SeedPictures result;
    progress.throw_if_cancelled();
    const PhotonTracerResult traced = trace_photons(rays, parameters_.photons_used());
    result.photon_seconds += traced.seconds;
    const Photons& photons = traced.photons;

    const Stopwatch group_watch;
    const double radius = automatic_radius(photons, pilot_neighbours.back());
    const NeighbourGroups groups =
        find_map_groups(scene_, photons, parameters_.maps, {radius, parameters_.angle_degrees});
    result.fixed_seconds += group_watch.seconds();

    progress.throw_if_cancelled();
    const PhotonMaps maps(device_, scene_, photons, groups,
                          {.radius = radius, .photons_per_cell = parameters_.photons_per_cell});
    result.photon_seconds += maps.statistics().seconds;
    if (parameters_.area == AreaMode::clipped && surface_ == nullptr) {
      surface_ = std::make_shared<const SurfaceIndex>(
          index_surface(scene_, landed_on(scene_, photons), radius, parameters_.angle_degrees));
    }

    const Stopwatch hit_watch;
    const PrimaryHitBatch batch = trace_primary_hits(rays, camera_, parameters_.film, 0,
                                                     parameters_.film.height, maps.map_of());
    result.hit_seconds = hit_watch.seconds();
    result.hits = batch.hits.size();
    for (std::size_t i = 0; i < pilot_neighbours.size(); ++i) {
      progress.throw_if_cancelled();
      add_picture(i, photons, maps, batch, result);
    }
    return result;
  }

 private:
  void add_picture(std::size_t i, const Photons& photons, const PhotonMaps& maps,
                   const PrimaryHitBatch& batch, SeedPictures& result) {
    const int k = pilot_neighbours[i];
    const double radius = std::min(automatic_radius(photons, k), maps.parameters().radius);
    Estimator estimator(maps, scene_,
                        {.neighbours = k,
                         .radius = radius,
                         .area = parameters_.area,
                         .kernel = parameters_.kernel,
                         .surface = surface_});
    const Stopwatch estimate_watch;
    const Estimates estimates = estimator.estimate(batch.hits);
    result.estimate_seconds[i] = estimate_watch.seconds();
    const Stopwatch film_watch;
    LightLayers layers(film().width, film().height, scene_);
    add_to_film(layers, batch, estimates, 1.0f / static_cast<float>(film().samples_per_pixel));
    result.film_seconds = film_watch.seconds();
    result.pictures[i] = mixed_picture(layers, mix_)->root();
  }

  const Scene& scene_;
  const Camera& camera_;
  Device& device_;
  const LightMix& mix_;
  RenderParameters parameters_;
  std::shared_ptr<const SurfaceIndex> surface_;  ///< of the first photons, where areas are clipped
};

Image mean_of(const Image& a, const Image& b) {
  Image mean = a;
  for (std::size_t plane = 0; plane < mean.channels.size(); ++plane) {
    for (std::size_t i = 0; i < mean.channels[plane].size(); ++i) {
      mean.channels[plane][i] = 0.5f * (a.channels[plane][i] + b.channels[plane][i]);
    }
  }
  return mean;
}

trade::PilotErrors errors_of(const SeedPictures& a, const SeedPictures& b, const Pilot& pilot) {
  const RelativeErrorWeights weights(mean_of(a.pictures[middle], b.pictures[middle]));
  trade::PilotErrors errors;
  errors.photons = pilot.photons();
  errors.samples = pilot.film().samples_per_pixel;
  for (std::size_t i = 0; i < pilot_neighbours.size(); ++i) {
    errors.neighbours.push_back(pilot_neighbours[i]);
    const double difference =
        weights.mean_product(a.pictures[i], b.pictures[i], a.pictures[i], b.pictures[i]);
    errors.variance.push_back(std::max(least_variance, difference / 2));
    auto& row = errors.squared_bias_difference.emplace_back();
    for (std::size_t j = 0; j < pilot_neighbours.size(); ++j) {
      row.push_back(
          weights.mean_product(a.pictures[i], a.pictures[j], b.pictures[i], b.pictures[j]));
    }
  }
  return errors;
}

/// Times of the second seed, whose kernels were compiled and buffers made by the first.
TimeModel times_of(const SeedPictures& seed, const Pilot& pilot, double structure_seconds,
                   const PrimaryHitParameters& picture) {
  const PrimaryHitParameters& film = pilot.film();
  const double samples = static_cast<double>(film.width) * film.height * film.samples_per_pixel;
  TimeModel model;
  model.samples_per_picture = static_cast<double>(picture.width) * picture.height;
  model.fixed = structure_seconds + seed.fixed_seconds;
  model.per_photon = seed.photon_seconds / pilot.photons();
  const double least_k = pilot_neighbours.front(), most_k = pilot_neighbours.back();
  const double slope =
      (seed.estimate_seconds.back() - seed.estimate_seconds.front()) / (most_k - least_k);
  model.per_sample_neighbour = std::max(0.0, slope) / samples;
  const double at_no_neighbour =
      std::max(0.0, seed.estimate_seconds.front() - std::max(0.0, slope) * least_k);
  model.per_sample = (seed.hit_seconds + seed.film_seconds + at_no_neighbour) / samples;
  return model;
}

}  // namespace

QualityModels measure_models(const Scene& scene, const Camera& camera, Device& device,
                             const LightMix& mix, const RenderParameters& parameters,
                             Progress& progress) {
  progress.begin("measure quality", 2, "seeds");
  const Stopwatch stopwatch;
  const RayScene rays(scene);
  const double structure_seconds = stopwatch.seconds();
  Pilot pilot(scene, camera, device, mix, parameters);
  const auto seed_of = [&](std::uint32_t repeat) {
    return trace::seed_of_repeat(parameters.photons.seed, repeat);
  };
  const SeedPictures a = pilot.render(rays, seed_of(0), progress);
  progress.advance(1);
  const SeedPictures b = pilot.render(rays, seed_of(1), progress);
  progress.advance(1);
  progress.end();
  return {.error = trade::fit_error_model(errors_of(a, b, pilot)),
          .time = times_of(b, pilot, structure_seconds, parameters.film),
          .seconds = stopwatch.seconds()};
}

}  // namespace photile
