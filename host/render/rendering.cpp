#include "render/rendering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "photile/errors.hpp"
#include "render/film.hpp"
#include "render/neighbour_choice.hpp"
#include "render/pooled_estimates.hpp"
#include "render/row_exchange.hpp"
#include "render/sample_errors.hpp"
#include "render/setting.hpp"

namespace photile {
namespace {

/// Hits estimated at a time: enough to fill a device, little enough to stay in memory, and fewer
/// where each takes longer, so that progress is seen and a wish to stop is heard.
std::int64_t hits_per_batch(int neighbours) {
  return (std::int64_t{1} << 20) * defaults::neighbours /
         std::max(defaults::neighbours, neighbours);
}

/// What nodes depend on beside the scene and the photons: the settings of estimates and of rays
/// that gather, and the kind of device, whose sums may have another order.
std::string light_map_settings(const RenderParameters& used, std::span<Device> devices) {
  std::string words = devices.front().info().name;
  for (const Setting& setting : settings()) {
    if (setting.group == "Estimate" || setting.name == "max_specular_depth") {
      words += fmt::format(", {} {}", setting.name, text_with_unit(setting, used));
    }
  }
  return words;
}

/// What runs of samples see becomes that of their pixels.
void join_runs(PrimaryHitBatch& batch, int runs) {
  const auto count = static_cast<std::uint32_t>(runs);
  for (std::uint32_t& pixel : batch.hits.pixel) pixel /= count;
  for (SeenEmission& seen : batch.emission) seen.pixel /= count;
}

/// Least number of batches of a pooled picture: estimates of many lights wait for their pooling.
constexpr int pooled_batches = 16;

}  // namespace

PreparedScene::PreparedScene(const Scene& scene) : rays(scene) {
  cost.add(stopwatch.taken(), rays.bytes());
}

Rendering::Rendering(const PreparedScene& scene, std::span<Device> devices,
                     const RenderParameters& parameters, Progress& progress)
    : rays_(scene.rays),
      scene_(scene.rays.scene()),
      devices_(devices),
      progress_(&progress),
      plan_(parameters, rays_, progress),
      paths_before_(scene_.lights.size()),
      layer_powers_(layer_powers(scene_)) {
  if (devices.empty()) throw UsageError("rendering needs a device; give at least one");
  costs_.structure = scene.cost;
}

void Rendering::start(const Film& film, int passes, const LightPooling* pooling) {
  film_ = plan_.hits(film, passes > 0 ? passes : plan_.passes());
  pooling_ = pooling;
  layers_ = pooling ? LightLayers(film_.width, film_.height, pooling->layers)
                    : LightLayers(film_.width, film_.height, scene_);
  shares_.assign(devices_.size(), 0.0);
  costs_.start_picture();
}

void Rendering::drop_maps() {
  frames_.reset();
  light_maps_.reset();
  gathered_nodes_.reset();
  node_gather_.reset();
  photons_.reset();
  caustics_.reset();
  late_maps_.reset();
  seen_ = {};
}

void Rendering::prepare(int pass, PreparedPhotons* prepared, const KeepPhotons* keep) {
  drop_maps();
  further_.clear();
  pass_ = pass;
  if (prepared && reads_light_maps_of(*prepared)) {
    wait_with(*prepared, keep);
    return;
  }
  if (!prepared && !keep && makes_maps_in_sight()) {
    seen_ = trace(pass, nullptr, nullptr).photons;
    costs_.maps = costs_.mixed_maps = 0;
    costs_.map_sizes.clear();
    photons_.emplace(
        devices_, scene_, groups_.patches,
        [this](std::span<const std::uint8_t> wanted) { return build_some(wanted); }, layer_powers_);
    return;
  }
  Maps maps = trace_and_build(pass, prepared, keep);
  const Stopwatch stopwatch;
  const auto estimators_of = [&](MapEstimators::Parts parts) {
    MapEstimators made(devices_, scene_, std::move(parts), layer_powers_);
    if (Communicator* const processes = plan_.used().processes) {
      made.share({*processes, owners_, layer_powers_.size(), rays_.needs().many_lights()});
    }
    return made;
  };
  photons_.emplace(estimators_of(parts_of(std::move(maps.photons))));
  if (!maps.caustics.empty()) {
    caustics_.emplace(
        estimators_of(parts_of(std::move(maps.caustics), std::move(maps.seen_caustics))));
  }
  costs_.estimators.add(stopwatch.taken());
}

void Rendering::follow(const Rendering& first, int pass) {
  radius_ = first.radius_;
  groups_ = first.groups_;
  surface_ = first.surface_;
  paths_before_.assign(paths_before_.size(), 0);
  for (int before = 0; before < pass; ++before) {
    const PhotonTracerParameters traced = plan_.tracing(before, {});
    const auto paths = photons_per_light(scene_, traced.emitted_photons, traced.quota);
    for (std::size_t light = 0; light < paths.size(); ++light) paths_before_[light] += paths[light];
  }
  prepare(pass, nullptr, nullptr);
  groups_ = {};
}

void Rendering::add(Rendering& further) {
  further_.push_back(&further);
  costs_.add_pass(further.costs_);
  if (light_maps_) light_maps_->add_pass(*further.photons_, further.gathering());
}

bool Rendering::reads_light_maps_of(const PreparedPhotons& prepared) {
  if (!prepared.light_maps || !plan_.reads_light_maps()) return false;
  if (prepared.light_maps->settings == light_map_settings(plan_.used(), devices_)) return true;
  progress_->note("light maps of the saved photons are of other settings: they are made anew");
  return false;
}

void Rendering::wait_with(PreparedPhotons& prepared, const KeepPhotons* keep) {
  radius_ = prepared.radius;
  choose_light_maps(0, prepared.photons);
  const auto maker = [this](const auto& parts_in) {
    return [this, parts_in] {
      if (!late_maps_) {
        report_to(Progress::none());  // photons that are given up on the way would be lost
        late_maps_ = trace_and_build(0, &waiting_, nullptr);
      }
      return parts_in(*late_maps_);
    };
  };
  photons_.emplace(devices_, scene_,
                   maker([this](Maps& maps) { return parts_of(std::move(maps.photons)); }),
                   layer_powers_);
  if (plan_.keeps_caustics() && prepared.caustics->size() > 0) {
    caustics_.emplace(devices_, scene_, maker([this](Maps& maps) {
                        return parts_of(std::move(maps.caustics), std::move(maps.seen_caustics));
                      }),
                      layer_powers_);
  }
  light_maps().maps().restore(std::move(*prepared.light_maps));
  prepared.light_maps.reset();
  if (keep) (*keep)(prepared);
  waiting_ = std::move(prepared);
}

void Rendering::choose_light_maps(int pass, const Photons& photons) {
  light_map_parameters_ = plan_.light_maps(pass, radius_, scene_, photons, layer_powers_);
  end_parameters_ = plan_.ends(pass, radius_, scene_, photons, layer_powers_);
}

std::optional<LightMapContents> Rendering::light_map_contents() const {
  if (!light_maps_ || !further_.empty()) return std::nullopt;
  LightMapContents contents = light_maps_->maps().contents();
  contents.settings = light_map_settings(plan_.used(), devices_);
  return contents;
}

void Rendering::add_pass(const HitSource& source, std::size_t after) {
  at_hand_ = after;
  film_.pass = pass_ + static_cast<int>(after);
  LightLayers* const errors = source.errors();
  if (errors && film_.pass == 0) {
    *errors = LightLayers(film_.width, film_.height, scene_);
    film_.runs = std::min(defaults::runs_of_samples, film_.samples_per_pixel);
    runs_ = LightLayers(film_.width * film_.runs, film_.height, scene_);
  }
  const auto height = static_cast<std::uint64_t>(film_.height);
  const Shard own = own_rows();
  const int begin = static_cast<int>(own.begin(height)), end = static_cast<int>(own.end(height));
  // All processes make as many batches: each may have to estimate for the others.
  const int most = static_cast<int>((height - 1) / own.count + 1);
  const OwnerEstimates::Moved moved_before = at_hand().moved();
  const int rows = rows_per_batch(source);
  PrimaryHitBatch batch = trace_rows(source, begin, std::min(begin + rows, end));
  make_maps(source, batch, rows);
  progress_->begin("estimate radiance", static_cast<std::uint64_t>(end - begin), "rows");
  for (int done = 0; done < most; done += rows) {
    progress_->throw_if_cancelled();
    const int first = std::min(begin + done, end), last = std::min(first + rows, end);
    if (done > 0) batch = trace_rows(source, first, last);
    add_rows(source, std::move(batch), first, last);
    progress_->advance(static_cast<std::uint64_t>(last - first));
  }
  progress_->end();
  const OwnerEstimates::Moved moved_now = at_hand().moved();
  costs_.hits_sent += moved_now.hits - moved_before.hits;
  costs_.hit_bytes_sent += moved_now.bytes - moved_before.bytes;
  if (errors && film_.pass + 1 == film_.passes) {
    add_sample_errors(*errors, runs_);
    runs_ = {};
    if (Communicator* const processes = plan_.used().processes) bring_rows(*processes, *errors);
  }
  const std::vector<double> shares = at_hand().photons_->shares();
  for (std::size_t i = 0; i < shares_.size(); ++i) shares_[i] += shares[i] / film_.passes;
}

/// Devices compile at the same time.
double Rendering::compile_seconds() const {
  double most = 0;
  for (const Device& device : devices_) most = std::max(most, device.compile_seconds());
  return most;
}

void Rendering::release() {
  const Stopwatch stopwatch;
  further_.clear();
  drop_maps();
  surface_.reset();
  groups_ = {};
  costs_.release.add(stopwatch.taken());
}

RenderResult Rendering::finish() {
  if (Communicator* const processes = plan_.used().processes) bring_rows(*processes, layers_);
  // Looks at lamps may take more off a surface than light maps, which blur, hold there.
  if (plan_.used().gloss == GlossMode::rays) raise_to_zero(layers_);
  costs_.film.host_bytes = layers_.bytes();
  costs_.shares.clear();
  costs_.compile_seconds = compile_seconds();
  for (std::size_t i = 0; i < devices_.size() && devices_.size() > 1; ++i) {
    const DeviceInfo& device = devices_[i].info();
    costs_.shares.emplace_back("share of " + device.id + " " + device.name, shares_[i]);
  }
  RenderParameters used = plan_.used();
  used.film = {film_.width, film_.height, film_.samples_per_pixel};
  used.radius = radius_;
  RenderCosts costs = costs_;
  if (used.processes) costs.add_processes(*used.processes);
  return {.layers = std::move(layers_),
          .statistics = costs.statistics(),
          .used = used,
          .stored_photons = costs.stored_photons,
          .device_shares = shares_};
}

int Rendering::rows_per_batch(const HitSource& source) const {
  const std::int64_t hits_per_row = std::int64_t{film_.width} *
                                    (film_.samples_per_pixel / film_.passes);
  const int least = (film_.height - 1) / pooled_batches + 1;
  const int most = pooling_ ? least : film_.height;
  // Where light maps are read, only their nodes take long.
  const int neighbours = reads_light_maps(source) ? defaults::neighbours : plan_.used().neighbours;
  return static_cast<int>(
      std::clamp<std::int64_t>(hits_per_batch(neighbours) / hits_per_row, 1, most));
}

PrimaryHitBatch Rendering::trace_rows(const HitSource& source, int first, int last) {
  if (first >= last) return {};
  const Stopwatch hit_watch;
  // Light maps ask for no order, and those of a file for no photons.
  const auto map_of =
      reads_light_maps(source) ? std::span<const std::uint32_t>() : at_hand().photons_->map_of();
  PrimaryHitBatch batch = source.trace(rays_, film_, first, last, map_of);
  costs_.hits.add(hit_watch.taken());
  costs_.rays += batch.rays;
  return batch;
}

void Rendering::add_rows(const HitSource& source, PrimaryHitBatch batch, int first, int last) {
  const auto add = [&](PrimaryHitBatch& seen, float illuminance_weight,
                       std::span<const std::uint8_t> by_photons) {
    Estimates estimates = reads_light_maps(source) ? read_light_maps(seen.hits, by_photons)
                                                   : estimate(seen.hits);
    const Stopwatch film_watch;
    if (pooling_) {
      estimates = pooled(*pooling_, estimates, seen.hits.size());
      pool_emission(*pooling_, seen);
    }
    if (source.errors()) {
      add_to_film(runs_, seen, estimates, illuminance_weight);
      join_runs(seen, film_.runs);
    }
    add_to_film(layers_, seen, estimates, illuminance_weight);
    costs_.film.add(film_watch.taken());
    if (!source.errors() || !gathered_nodes_) return;
    seen.emission.clear();  // its samples alone err
    add_to_film(*source.errors(), seen,
                light_maps_->errors(seen.hits, estimates, gathered_nodes_->errors(), by_photons),
                illuminance_weight);
  };
  std::vector<std::uint8_t> by_photons;
  if (batch.reflected.size() > 0 && reads_light_maps(source)) {
    by_photons = suits_photons(batch.hits, batch.reflected, film_.runs, light_maps().blotches());
  }
  PrimaryHitBatch reflected;
  reflected.hits = std::move(batch.reflected);
  add(batch, 1.0f / static_cast<float>(film_.samples_per_pixel), {});
  if (reflected.hits.size() == 0 && !(plan_.used().processes && film_.lobe_rays)) return;
  add(reflected, 0.0f, by_photons);  // the pixel's illuminance is not theirs
}

Estimates Rendering::estimate(const PrimaryHits& hits) {
  const Stopwatch stopwatch;
  const double compiled = compile_seconds();
  const TimeTaken built_before = costs_.build.time;
  Rendering& pass = at_hand();
  Estimates estimates = pass.photons_->estimate(hits);
  costs_.estimate.add(stopwatch.taken() - (costs_.build.time - built_before));
  costs_.estimate_compile_seconds += compile_seconds() - compiled;
  costs_.hit_count += hits.size();
  return estimates;
}

LightMapEstimates& Rendering::light_maps() {
  if (light_maps_) return *light_maps_;
  light_maps_.emplace(rays_, light_map_parameters_, *photons_, gathering());
  for (Rendering* further : further_) {
    light_maps_->add_pass(*further->photons_, further->gathering());
  }
  return *light_maps_;
}

GatheringPass Rendering::gathering() {
  if (!plan_.gathers_at_nodes()) return {};
  if (!gathered_nodes_) {
    node_gather_.emplace(rays_, *photons_, end_parameters_, caustics_ ? &*caustics_ : nullptr,
                         plan_.node_gathering(pass_, radius_));
    constexpr double inset_of_spacing = 1.0 / 512;
    gathered_nodes_.emplace(scene_, *node_gather_, layer_powers_,
                            rays_of_nodes(scene_, plan_.used().light_map_rays,
                                          inset_of_spacing * light_map_parameters_.spacing));
  }
  return {&*gathered_nodes_, &node_gather_->ends()};
}

LightMapFrames& Rendering::frames() {
  if (!frames_) frames_.emplace(rays_, light_maps().maps(), light_maps().source());
  return *frames_;
}

Estimates Rendering::read_light_maps(const PrimaryHits& hits,
                                     std::span<const std::uint8_t> by_photons) {
  const Stopwatch stopwatch;
  LightMapEstimates& light_maps = this->light_maps();
  const std::uint64_t alone_before = light_maps.hits_alone();
  const std::uint64_t nodes_before = light_maps.maps().statistics().nodes;
  const TimeTaken filled_before = light_maps.fill_time();
  const TimeTaken built_before = costs_.build.time;
  Estimates estimates = light_maps.estimate(hits, *progress_, at_hand_, by_photons);
  const LightMapStatistics maps = light_maps.maps().statistics();
  const TimeTaken filling = light_maps.fill_time() - filled_before;
  // Nodes may be the first to look at some maps of photons.
  costs_.light_maps.add(filling - (costs_.build.time - built_before),
                        maps.value_bytes + maps.index_bytes);
  costs_.light_map_nodes += maps.nodes - nodes_before;
  costs_.light_map_errors = light_maps.errors_read();
  costs_.estimate.add(stopwatch.taken() - filling);
  costs_.hit_count += light_maps.hits_alone() - alone_before;
  return estimates;
}

}  // namespace photile
