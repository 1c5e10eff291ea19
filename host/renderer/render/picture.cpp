#include "render/picture.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <utility>

#include "light/light_at_points.hpp"
#include "render/exchange.hpp"
#include "render/film.hpp"
#include "render/pass_count.hpp"

namespace photile {
namespace {

/// Rows of a batch. Its hits are enough to fill a device and for all cores to share what new nodes
/// of light maps ask, and few enough to stay in memory with all lights of each and to tell how far
/// a picture is. Of estimates, so few that the allocator keeps their memory for the next ones, and
/// fewer where each takes longer: a request to stop takes effect soon.
int rows_per_batch(const RenderPlan& plan, std::size_t lights, const PrimaryHitParameters& film) {
  constexpr std::int64_t most = 1 << 20, most_estimates = 1 << 18, most_entries = 1 << 24;
  constexpr std::int64_t batches = 8, least_of_a_core = 1 << 16;
  const std::int64_t hits_per_row =
      std::int64_t{film.width} * (film.samples_per_pixel / film.passes);
  // Processes take batches together, and may differ in their cores.
  const int cores = plan.used().processes ? 2 : tbb::this_task_arena::max_concurrency();
  const std::int64_t hits = plan.reads_light_maps()
                                ? std::clamp(film.height * hits_per_row / batches,
                                             std::min(most, least_of_a_core * cores), most)
                                : most_estimates * defaults::neighbours /
                                      std::max(defaults::neighbours, plan.used().neighbours);
  const auto layers = static_cast<std::int64_t>(std::max<std::size_t>(1, lights));
  return static_cast<int>(std::clamp<std::int64_t>(
      std::min(hits, most_entries / layers) / hits_per_row, 1, film.height));
}

/// What `runs` runs of a pixel's samples see becomes that of `less` runs.
void join_runs(PrimaryHitBatch& batch, int runs, int less) {
  if (runs == less) return;
  const auto from = static_cast<std::uint32_t>(runs), to = static_cast<std::uint32_t>(less);
  const auto join = [&](std::uint32_t& pixel) {
    pixel = pixel / from * to + pixel % from * to / from;
  };
  for (std::uint32_t& pixel : batch.hits.pixel) join(pixel);
  for (VisibleEmission& seen : batch.emission) join(seen.pixel);
}

}  // namespace

Picture::Picture(const RayScene& rays, const RenderPlan& plan, std::span<Device> devices,
                 const Film& film, int passes, const LayerMixdown* mixdown, RenderCosts& costs)
    : rays_(rays),
      scene_(rays.scene()),
      plan_(plan),
      devices_(devices),
      film_(plan.hits(film, passes)),
      mixdown_(mixdown),
      costs_(costs),
      layers_(black_layers(1)),
      fractions_(devices.size(), 0.0) {}

void Picture::add(const HitSource& source, PassLight& light, Progress& progress) {
  LightLayers* const errors = source.errors;
  if (auto* const processes = plan_.used().processes; processes && film_.pass == 0) {
    ContentHash hash;
    source.add_to(hash);
    hash.add(film_.width);
    hash.add(film_.height);
    require_same(*processes, hash, "camera, size or points");
  }
  if (film_.pass == 0) begin_film(source);
  const auto height = static_cast<std::uint64_t>(film_.height);
  const auto* const all = plan_.used().processes;
  const Shard own = all ? Shard{all->rank(), all->size()} : Shard{};
  const int begin = static_cast<int>(own.begin(height)), end = static_cast<int>(own.end(height));
  // All processes make as many batches: each may have to estimate for the others.
  const int most = static_cast<int>((height - 1) / own.count + 1);
  const int rows = rows_per_batch(plan_, rays_.needs().light_count, film_);
  const LightTotals before = totals(light);
  progress.begin("estimate radiance", static_cast<std::uint64_t>(end - begin), "rows");
  for (int done = 0; done < most; done += rows) {
    progress.throw_if_cancelled();
    const int first = std::min(begin + done, end), last = std::min(first + rows, end);
    PrimaryHitBatch batch = trace_rows(source, light, first, last), reflected;
    if (batch.reflected.size() > 0 && light.cache()) {
      batch.reflected.coarse = cache::suits_photons(batch.hits, batch.reflected, film_.runs,
                                                    light.cache()->photon_noise());
    }
    reflected.hits = std::move(batch.reflected);
    reflected.emission = std::move(batch.reflected_emission);
    if (filters()) {
      for (const PixelLobes& seen : batch.lobes) lobes_.lobes[seen.pixel / film_.runs].add(seen);
    }
    add_hits(source, light, batch, false, progress);
    if (reflected.hits.size() > 0 || !reflected.emission.empty() ||
        (plan_.used().processes && film_.lobe_rays)) {
      add_hits(source, light, reflected, true, progress);
    }
    // Which lights reach a pixel is known now: the rows so far forecast the memory of all.
    if (layers_.sparse() && last > begin) {
      QuietProgress without_notes(progress);
      check_picture_memory(film_.width, film_.height, layers_.layers.size(),
                           static_cast<double>(layers_.bytes()) * film_.height / (last - begin),
                           done == 0 ? progress : without_notes);
    }
    progress.advance(static_cast<std::uint64_t>(last - first));
  }
  progress.end();
  costs_.add(before, totals(light));
  ++film_.pass;
  if (errors && film_.pass == film_.passes) {
    add_sample_errors(*errors, runs_);
    runs_ = {};
    if (auto* const processes = plan_.used().processes) bring_rows(*processes, *errors);
  }
  const std::vector<double> fractions = light.fractions();
  for (std::size_t i = 0; i < fractions.size(); ++i) fractions_[i] += fractions[i] / film_.passes;
}

std::vector<double> Picture::powers() const {
  // Layers of a mixdown are at the powers at which they are to be seen.
  return mixdown_ ? std::vector<double>(layers_.layers.size(), 1.0) : light::layer_powers(scene_);
}

LightLayers Picture::black_layers(int columns_per_pixel) const {
  const int width = columns_per_pixel * film_.width;
  return mixdown_ ? LightLayers(width, film_.height, mixdown_->layers)
                  : LightLayers(width, film_.height, scene_);
}

void Picture::begin_film(const HitSource& source) {
  const bool filters = plan_.used().gloss == GlossMode::filtered && rays_.needs().glossy &&
                       source.dense && film_.samples_per_pixel >= LobeFilm::runs;
  if (!filters && !source.errors) return;
  film_.runs = std::min(defaults::runs_of_samples, film_.samples_per_pixel);
  if (source.errors) {
    *source.errors = black_layers(1);
    runs_ = black_layers(film_.runs);
  }
  if (filters) {
    lobes_ = {
        black_layers(2),
        LightLayers(LobeFilm::runs * film_.width, film_.height, std::vector<std::string>{"all"}),
        std::vector<PixelLobes>(static_cast<std::size_t>(film_.width) *
                                static_cast<std::size_t>(film_.height))};
  }
}

void Picture::add_lobes() {
  if (!filters()) return;
  if (auto* const processes = plan_.used().processes) {
    bring_rows(*processes, lobes_);
    if (processes->rank() > 0) return;
  }
  const Stopwatch film_watch;
  std::array<int, LobeFilm::runs> samples{};
  for (int sample = 0; sample < film_.samples_per_pixel; ++sample) {
    ++samples[static_cast<std::size_t>(sample * LobeFilm::runs / film_.samples_per_pixel)];
  }
  add_filtered(layers_, lobes_, powers(), samples);
  costs_.film.add(film_watch.taken());
}

RenderResult Picture::finish(double radius) {
  if (auto* const processes = plan_.used().processes) bring_rows(*processes, layers_);
  add_lobes();
  // Light samples may take more off a surface than light maps, which blur, hold there.
  if (film_.lobe_rays) raise_to_zero(layers_);
  RenderCosts costs = costs_;
  costs.film.host_bytes = layers_.bytes() + lobes_.halves.bytes() + lobes_.mixed.bytes();
  costs.fractions.clear();
  costs.compile_seconds = compile_seconds();
  for (std::size_t i = 0; i < devices_.size() && devices_.size() > 1; ++i) {
    const DeviceInfo& device = devices_[i].info();
    costs.fractions.emplace_back("share of " + device.id + " " + device.name, fractions_[i]);
  }
  RenderParameters used = plan_.used();
  used.film = {film_.width, film_.height, film_.samples_per_pixel};
  used.radius = radius;
  if (used.processes) add_processes(*used.processes, costs);
  return {.layers = std::move(layers_),
          .statistics = costs.statistics(),
          .used = used,
          .standard_error = costs.light_map_errors.mean(),
          .stored_photons = costs.stored_photons,
          .device_fractions = fractions_};
}

/// Devices compile at the same time.
double Picture::compile_seconds() const {
  double most = 0;
  for (const Device& device : devices_) most = std::max(most, device.compile_seconds());
  return most;
}

PrimaryHitBatch Picture::trace_rows(const HitSource& source, const PassLight& light, int first,
                                    int last) {
  if (first >= last) return {};
  const Stopwatch hit_watch;
  PrimaryHitBatch batch = source.trace(rays_, film_, first, last, light.map_of());
  costs_.hits.add(hit_watch.taken());
  costs_.rays += batch.rays;
  return batch;
}

void Picture::add_hits(const HitSource& source, PassLight& light, PrimaryHitBatch& seen,
                       bool by_lobes, const Progress& progress) {
  const Stopwatch light_watch;
  const bool has_errors = source.errors && light.gathered();
  auto [estimates, errors] = light.at(seen.hits, has_errors, progress);
  asked_ += light_watch.taken();
  hits_ += seen.hits.size();
  const Stopwatch film_watch;
  if (mixdown_) {
    estimates = pooled(*mixdown_, estimates);
    pool_emission(*mixdown_, seen);
  }
  // The illuminance of what lobes show is not the pixel's.
  const float illuminance_weight =
      by_lobes ? 0.0f : 1.0f / static_cast<float>(film_.samples_per_pixel);
  if (source.errors) add_to_film(runs_, seen, estimates, illuminance_weight);
  if (by_lobes && filters()) {
    add_to_lobes(seen, estimates);
  } else {
    join_runs(seen, film_.runs, 1);
    add_to_film(layers_, seen, estimates, illuminance_weight);
  }
  costs_.film.add(film_watch.taken());
  if (!has_errors) return;
  seen.emission.clear();  // only its samples have errors
  add_to_film(*source.errors, seen, errors, illuminance_weight);
}

void Picture::add_to_lobes(PrimaryHitBatch& seen, const LightTable& estimates) {
  const std::vector<double> of_layers = powers();
  const LayerMixdown all{{"all"},
                         std::vector<std::uint32_t>(of_layers.size(), 0),
                         {of_layers.begin(), of_layers.end()}};
  const std::vector<VisibleEmission> emission = seen.emission;
  pool_emission(all, seen);
  add_to_film(lobes_.mixed, seen, pooled(all, estimates), 0.0f);
  seen.emission = emission;
  join_runs(seen, film_.runs, 2);
  add_to_film(lobes_.halves, seen, estimates, 0.0f);
  join_runs(seen, 2, 1);
}

LightTotals Picture::totals(const PassLight& light) const {
  const TimeTaken& building = costs_.build.time;
  const cache::SurfaceCache* const cache = light.cache();
  if (!cache) {
    return {.asked = asked_,
            .filling = building,
            .building = building,
            .compile_seconds = compile_seconds(),
            .hits = hits_,
            .errors = {}};
  }
  return {.asked = asked_,
          .filling = cache->fill_time(),
          .building = building,
          .hits = cache->hits_alone(),
          .nodes = cache->maps().statistics().nodes,
          .node_bytes = cache->maps().bytes(),
          .errors = cache->errors_read()};
}

}  // namespace photile
