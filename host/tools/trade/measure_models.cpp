// Quick renderings of a view that tell its error and time apart by their causes.
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <string_view>

#include "photile/layered_picture.hpp"
#include "photile/picture_error.hpp"
#include "photile/quiet_progress.hpp"
#include "render/rendering.hpp"
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
  /// Of the largest k: its groups serve the others, too.
  double fixed_seconds = 0, photon_seconds = 0, hit_seconds = 0, film_seconds = 0;
};

double seconds_of(const RenderResult& result, std::initializer_list<std::string_view> stages) {
  double seconds = 0;
  for (const StageStatistics& stage : result.statistics) {
    if (std::find(stages.begin(), stages.end(), stage.stage) != stages.end()) {
      seconds += stage.seconds;
    }
  }
  return seconds;
}

/// A small picture of few photons, with one k for all hits and the radius that belongs to it.
RenderParameters pilot_parameters(RenderParameters parameters) {
  Film& film = parameters.film;
  const double shrink = std::min(1.0, static_cast<double>(defaults::pilot_height) / film.height);
  film.width = std::max(1, static_cast<int>(std::lround(shrink * film.width)));
  film.height = std::max(1, static_cast<int>(std::lround(shrink * film.height)));
  parameters.photons.emitted_photons =
      std::min(parameters.photons.emitted_photons, defaults::pilot_photons);
  parameters.passes = 1;
  parameters.radius = 0;
  parameters.least_neighbours = 0;
  // The model is that of estimates at hits: light maps are quicker, and no worse.
  if (parameters.light_maps == LightMapMode::automatic) parameters.light_maps = LightMapMode::off;
  return parameters;
}

class Pilot {
 public:
  Pilot(const Scene& scene, const Camera& camera, Device& device, const LightMix& mix,
        const RenderParameters& parameters)
      : scene_(scene), camera_(camera), device_(device), mix_(mix), parameters_(parameters) {}

  const Film& film() const { return parameters_.film; }
  double photons() const { return static_cast<double>(parameters_.photons.emitted_photons); }
  double structure_seconds() const { return scene_.cost.time.seconds; }

  /// The photons are traced once: those of the largest k, whose groups are wide enough for all.
  SeedPictures render(std::uint64_t seed, Progress& progress) {
    parameters_.seed = seed;
    SeedPictures seen;
    PreparedPhotons kept;
    const KeepPhotons keep = [&](const PreparedPhotons& prepared) { kept = prepared; };
    for (std::size_t i = pilot_neighbours.size(); i-- > 0;) {
      const bool first = i + 1 == pilot_neighbours.size();
      parameters_.neighbours = pilot_neighbours[i];
      QuietProgress quiet(progress);
      Rendering rendering(scene_, {&device_, 1}, parameters_, quiet);
      rendering.start(film());
      if (first) {
        rendering.prepare(0, nullptr, &keep);
      } else {
        PreparedPhotons again = kept;
        again.radius = std::min(kept.radius, rendering.plan().radius(kept.photons, quiet));
        rendering.prepare(0, &again, nullptr);
      }
      rendering.add_pass(CameraHits(camera_));
      const RenderResult result = rendering.finish();
      seen.pictures[i] = mixed_picture(result.layers, mix_)->root();
      seen.estimate_seconds[i] = seconds_of(result, {"radiance estimate"});
      if (!first) continue;
      seen.fixed_seconds = seconds_of(result, {"neighbour groups", "surface index"});
      seen.photon_seconds = seconds_of(result, {"trace photons", "build photon maps"});
      seen.hit_seconds = seconds_of(result, {"primary hits"});
      seen.film_seconds = seconds_of(result, {"film"});
    }
    return seen;
  }

 private:
  const PreparedScene scene_;
  const Camera& camera_;
  Device& device_;
  const LightMix& mix_;
  RenderParameters parameters_;
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
TimeModel times_of(const SeedPictures& seed, const Pilot& pilot, const Film& picture) {
  const Film& film = pilot.film();
  const double samples = static_cast<double>(film.width) * film.height * film.samples_per_pixel;
  TimeModel model;
  model.samples_per_picture = static_cast<double>(picture.width) * picture.height;
  model.fixed = pilot.structure_seconds() + seed.fixed_seconds;
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
  Pilot pilot(scene, camera, device, mix, pilot_parameters(parameters));
  const auto seed_of = [&](std::uint32_t repeat) {
    return trace::seed_of_repeat(parameters.seed, repeat);
  };
  const SeedPictures a = pilot.render(seed_of(0), progress);
  progress.advance(1);
  const SeedPictures b = pilot.render(seed_of(1), progress);
  progress.advance(1);
  progress.end();
  return {.error = trade::fit_error_model(errors_of(a, b, pilot)),
          .time = times_of(b, pilot, parameters.film),
          .seconds = stopwatch.seconds()};
}

}  // namespace photile
