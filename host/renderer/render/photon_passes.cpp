#include "render/photon_passes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "device/context.hpp"
#include "maps/map_page.hpp"
#include "photile/limits.hpp"
#include "render/exchange.hpp"
#include "render/setting.hpp"
#include "render/shared_photons.hpp"
#include "trace/photon_tracer.hpp"

namespace photile {
namespace {

/// Light that is made when it is first asked for.
class LazyLight : public light::LightAtPoints {
 public:
  using Make = std::function<std::shared_ptr<light::LightAtPoints>()>;
  explicit LazyLight(Make make) : make_(std::move(make)) {}

  LightTable at(const PrimaryHits& points, const Progress& progress) override {
    if (points.size() == 0) return {};
    if (!light_) light_ = make_();
    return light_->at(points, progress);
  }

 private:
  Make make_;
  std::shared_ptr<light::LightAtPoints> light_;
};

/// The same light maps, with nodes as close together as this spacing asks for, by levels that are
/// split everywhere.
cache::LightMapParameters finer_than(cache::LightMapParameters maps, double spacing) {
  const double halvings = std::round(std::log2(maps.spacing / spacing));
  maps.skipped_levels =
      std::clamp(static_cast<int>(halvings), 0, limits::max_light_map_levels - maps.levels);
  maps.levels += maps.skipped_levels;
  return maps;
}

}  // namespace

PassLight::PassLight(const RayScene& rays, const RenderPlan& plan, PassPhotons photons,
                     Growth growth)
    : rays_(rays),
      plan_(plan),
      photons_(std::move(photons)),
      layer_powers_(light::layer_powers(rays.scene())),
      is_shared_(plan.used().processes != nullptr) {
  if (!plan.reads_light_maps()) return;
  if (plan.gathers_at_nodes()) {
    gather_.emplace(rays, *photons_.at_ends.of_points, *photons_.at_ends.of_nodes, photons_.ends,
                    photons_.caustics.of_points.get(),
                    plan.node_gathering(photons_.radius, photons_.maps));
  } else {
    by_photons_.emplace(*photons_.all.of_nodes);
  }
  read_light_maps(std::move(growth));
  if (photons_.contents) cache_->maps().restore(*photons_.contents);
}

void PassLight::grow(int parts) { read_light_maps({parts, gathered_->take_points()}); }

void PassLight::read_light_maps(Growth growth) {
  cache_.reset();
  if (gather_) {
    gathered_.emplace(
        *gather_, layer_powers_,
        cache::rays_of_nodes(rays_.scene(), growth.parts * plan_.used().light_map_rays,
                             plan_.used().light_map_spacing > 0 ? 0.0 : photons_.maps.spacing),
        std::move(growth.points));
  }
  cache_.emplace(rays_, photons_.maps, *photons_.all.of_points, nodes(),
                 gather_ ? &gather_->ends() : nullptr);
}

std::span<const std::uint32_t> PassLight::map_of() const {
  const auto& estimate = photons_.all.estimate;
  return cache_ || !estimate || is_shared_ ? std::span<const std::uint32_t>() : estimate->map_of();
}

std::vector<double> PassLight::fractions() const {
  const auto& estimate = (gather_ ? photons_.at_ends : photons_.all).estimate;
  return estimate ? estimate->fractions() : std::vector<double>();
}

PhotonPasses::PhotonPasses(const RayScene& rays, std::span<Device> devices, const RenderPlan& plan,
                           RenderCosts& costs)
    : rays_(rays),
      scene_(rays.scene()),
      devices_(devices),
      plan_(plan),
      costs_(costs),
      layer_powers_(light::layer_powers(scene_)),
      paths_before_(scene_.lights.size()) {}

std::string PhotonPasses::light_map_settings() const {
  // The kind of device is among them: sums may have another order on another.
  std::string words = devices_.front().info().name;
  for (const Setting& setting : settings()) {
    if (setting.group == "Estimate" || setting.name == "max_specular_depth") {
      words += fmt::format(", {} {}", setting.name, text_with_unit(setting, plan_.used()));
    }
  }
  return words;
}

PassPhotons PhotonPasses::next(TracedPhotons* prepared, const KeepPhotons* keep, Progress& progress,
                               int parts) {
  parts_ = parts;
  all_parts_ += parts;
  if (prepared && prepared->light_maps && plan_.reads_light_maps()) {
    if (prepared->light_maps->settings == light_map_settings()) return waiting(*prepared, keep);
    progress.note("light maps of the saved photons are of other settings: they are made anew");
  }
  Maps maps = trace_and_build(prepared, keep, progress);
  const Stopwatch stopwatch;
  PassPhotons photons = std::move(maps.facts);
  photons.all = shared(estimate_of(maps.photons));
  if (plan_.gathers_at_nodes()) photons.at_ends = shared(estimate_at_ends(maps.photons));
  if (maps.caustics.maps) photons.caustics = shared(estimate_of(maps.caustics));
  costs_.estimators.add(stopwatch.taken());
  if (!plan_.reads_light_maps()) ++pass_;
  return photons;
}

/// The photons of `prepared` have no maps until an estimate is needed: light maps tell most light.
PassPhotons PhotonPasses::waiting(TracedPhotons& prepared, const KeepPhotons* keep) {
  radius_ = prepared.radius;
  PassPhotons photons = facts(prepared.photons);
  photons.contents = std::move(prepared.light_maps);
  prepared.light_maps.reset();
  const bool has_caustics = plan_.keeps_caustics() && prepared.caustics->size() > 0;
  if (keep) (*keep)(prepared);
  struct Waiting {
    TracedPhotons photons;
    std::optional<Maps> maps;
  };
  const auto waiting = std::make_shared<Waiting>(Waiting{std::move(prepared), std::nullopt});
  const auto built = [this, waiting]() -> Maps& {
    // This must not be cancelled: photons that are released on the way would be lost.
    if (!waiting->maps) {
      waiting->maps = trace_and_build(&waiting->photons, nullptr, Progress::none());
    }
    return *waiting->maps;
  };
  const auto lazy = [](LazyLight::Make make) {
    const auto light = std::make_shared<LazyLight>(std::move(make));
    return PhotonLight{light, light, nullptr};
  };
  photons.all = lazy([this, built] { return estimate_of(built().photons); });
  if (plan_.gathers_at_nodes()) {
    photons.at_ends = lazy([this, built] { return estimate_at_ends(built().photons); });
  }
  if (has_caustics) {
    photons.caustics = lazy([this, built] { return estimate_of(built().caustics); });
  }
  return photons;
}

PassPhotons PhotonPasses::facts(const Photons& photons) {
  PassPhotons facts{
      .radius = radius_, .all = {}, .at_ends = {}, .caustics = {}, .maps = {}, .ends = {}};
  if (plan_.reads_light_maps()) {
    const double radius = radius_ * std::sqrt(static_cast<double>(parts_) / all_parts_);
    facts.maps = plan_.light_maps(radius, scene_, photons, layer_powers_);
    if (!first_maps_) first_maps_ = facts.maps;
    facts.maps = finer_than(*first_maps_, facts.maps.spacing);
    facts.ends = plan_.ends(radius_, scene_, photons, layer_powers_);
  }
  return facts;
}

std::shared_ptr<estimate::PhotonEstimate> PhotonPasses::estimate_of(
    const Built& built, const EstimateParameters& parameters) const {
  return std::make_shared<estimate::PhotonEstimate>(
      devices_, scene_, estimate::PhotonEstimate::Parts{built.maps, parameters, built.seen});
}

std::shared_ptr<estimate::PhotonEstimate> PhotonPasses::estimate_of(const Built& built) const {
  return estimate_of(built, plan_.estimate(pass_, built.kernel, surface_));
}

std::shared_ptr<estimate::PhotonEstimate> PhotonPasses::estimate_at_ends(const Built& built) const {
  return estimate_of(built, plan_.estimate_at_ends(built.kernel, surface_));
}

PhotonLight PhotonPasses::shared(std::shared_ptr<estimate::PhotonEstimate> estimate) {
  auto* const processes = plan_.used().processes;
  if (!processes) return {estimate, estimate, estimate};
  const auto by = [&](Exchange::Points points) {
    return std::make_shared<Exchange>(*processes, owners_, estimate, points,
                                      LightTable(rays_.needs()), costs_.points_sent);
  };
  return {by(Exchange::Points::own), by(Exchange::Points::common), estimate};
}

/// A map is not cut, and holds the photons of a triangle at least. Where those of one may be too
/// many, a few paths are traced first to find out. Errors: DeviceMemoryError.
void PhotonPasses::check_map_memory() const {
  constexpr std::uint64_t few = 10'000, most_of_a_path = 8;
  std::uint64_t memory = std::numeric_limits<std::uint64_t>::max();
  for (Device& device : devices_) {
    memory = std::min(memory, device::context_of(device).memory_limit());
  }
  PhotonTracerParameters paths = plan_.tracing(0, {});
  paths.shard = {};
  const double all = static_cast<double>(paths.emitted_photons);
  const std::uint64_t bytes = maps::bytes_per_record(rays_.needs());
  if (memory / bytes / most_of_a_path >= paths.emitted_photons) return;
  paths.emitted_photons = std::min(few, paths.emitted_photons);
  const std::vector<std::uint32_t> landed = landed_on(scene_, trace_photons(rays_, paths).photons);
  const double most = *std::max_element(landed.begin(), landed.end());
  const double certain =
      (most - 4 * std::sqrt(most)) * all / static_cast<double>(paths.emitted_photons);
  const std::uint64_t held = memory / bytes;
  if (!(certain > static_cast<double>(held))) return;
  throw DeviceMemoryError(fmt::format(
      "a surface has {:.0f} photons or more, and the device's memory holds {}; use fewer photons, "
      "more passes, or a larger memory limit if one is set",
      certain, held));
}

PhotonTracerResult PhotonPasses::trace(TracedPhotons* prepared, const KeepPhotons* keep,
                                       Progress& progress) {
  if (pass_ == 0 && !prepared) check_map_memory();
  if (!kernels_) {  // while photons are traced
    const bool caustics = plan_.keeps_caustics() && rays_.needs().specular_paths;
    kernels_.emplace(scene_, devices_, plan_.used(), plan_.leaves_out_hidden() || caustics,
                     caustics);
  }
  const Stopwatch trace_watch;
  PhotonTracerResult traced;
  if (prepared) {
    traced.photons = std::move(prepared->photons);
    if (plan_.keeps_caustics()) traced.caustics = std::move(*prepared->caustics);
  } else {
    const PhotonTracerParameters tracing = plan_.tracing(pass_, paths_before_, parts_);
    traced = plan_.finds_hot_spots()
                 ? trace::trace_photons_beside_hot_spots(rays_, tracing, progress)
                 : trace_photons(rays_, tracing, progress);
  }
  costs_.trace.add(trace_watch.taken(), traced.photons.bytes() + traced.caustics.bytes());
  if (auto* const processes = plan_.used().processes) {
    const Stopwatch stopwatch;
    traced.photons.of_all = photons_of_all(*processes, traced.photons);
    if (plan_.keeps_caustics()) {
      traced.caustics.of_all = photons_of_all(*processes, traced.caustics);
    }
    costs_.exchange.add(stopwatch.taken());
  }
  count(traced);
  if (pass_ == 0) {
    const Stopwatch radius_watch;
    const bool grouped = prepared && prepared->has_groups();
    radius_ = grouped ? prepared->radius : plan_.radius(traced.photons, progress);
    costs_.radius.add(radius_watch.taken());
    // Groups are found once, because no later radius is larger.
    find_groups(traced.photons, grouped ? prepared : nullptr, progress);
  }
  if (plan_.used().processes) move_to_owners(traced, progress);
  if (pass_ == 0) find_surface(traced.photons);
  if (keep) {
    TracedPhotons own{std::move(traced.photons), std::move(groups_), radius_};
    if (plan_.keeps_caustics()) own.caustics = std::move(traced.caustics);
    (*keep)(own);
    traced.photons = std::move(own.photons);
    groups_ = std::move(own.groups);
    if (own.caustics) traced.caustics = std::move(*own.caustics);
  }
  return traced;
}

void PhotonPasses::move_to_owners(PhotonTracerResult& traced, Progress& progress) {
  const Stopwatch stopwatch;
  auto& processes = *plan_.used().processes;
  progress.begin("exchange photons", 0, "");
  owners_ = std::make_shared<const MapOwners>(scene_, groups_.patches,
                                              traced.photons.of_all->landed, processes.size());
  const double radius = plan_.maps(pass_, radius_).radius;
  const auto move = [&](Photons& photons) {
    PhotonsMoved moved;
    photons = to_owners(processes, scene_, groups_, *owners_, radius, std::move(photons), moved);
    costs_.photons_sent += moved.sent;
    costs_.photon_bytes_sent += moved.bytes;
    costs_.photons_held += moved.held;
  };
  move(traced.photons);
  if (traced.caustics.total() > 0) move(traced.caustics);
  progress.end();
  costs_.exchange.add(stopwatch.taken(), traced.photons.bytes() + traced.caustics.bytes());
}

/// The photons are gone when this returns: the maps hold copies.
PhotonPasses::Maps PhotonPasses::trace_and_build(TracedPhotons* prepared, const KeepPhotons* keep,
                                                 Progress& progress) {
  PhotonTracerResult traced = trace(prepared, keep, progress);
  const PhotonMapParameters parameters = plan_.maps(pass_, radius_);
  PassPhotons found = facts(traced.photons);
  Maps maps{build(std::move(traced.photons), parameters, plan_.used().kernel,
                  plan_.leaves_out_hidden(), progress),
            {},
            std::move(found)};
  const PhotonMapStatistics& built = maps.photons.maps->front().statistics();
  costs_.maps = built.maps;
  costs_.normal_filtered_maps = built.normal_filtered_maps;
  costs_.map_sizes = built.map_sizes;
  // Among the photons of all light, caustics have the same groups, lit surface and radius.
  if (traced.caustics.total() > 0) {
    maps.caustics = build(std::move(traced.caustics), parameters, caustic_kernel, true, progress);
  }
  const Stopwatch release_watch;
  traced = {};
  costs_.release.add(release_watch.taken());
  return maps;
}

PhotonPasses::Built PhotonPasses::build(Photons photons, const PhotonMapParameters& parameters,
                                        DensityKernel kernel, bool leaves_out_hidden,
                                        Progress& progress) {
  const Stopwatch stopwatch;
  kernels_->wait();
  std::shared_ptr<const estimate::VisiblePhotons> seen;
  if (leaves_out_hidden) {
    seen =
        std::make_shared<const estimate::VisiblePhotons>(rays_, photons, kernel, parameters.radius);
  }
  std::vector<std::uint8_t> own;
  if (owners_) own = owners_->maps_of(plan_.used().processes->rank());
  std::vector<PhotonMaps> maps = estimate::build_maps_on_each(devices_, scene_, std::move(photons),
                                                              groups_, parameters, progress, own);
  std::uint64_t device_bytes = 0, spilled_bytes = 0;
  for (const PhotonMaps& one : maps) {
    device_bytes += one.statistics().device_bytes - one.statistics().spilled_bytes;
    spilled_bytes += one.statistics().spilled_bytes;
  }
  costs_.build.add(stopwatch.taken(), spilled_bytes, device_bytes);
  const PhotonMapStatistics& built = maps.front().statistics();
  costs_.references += built.references;
  costs_.largest_map = std::max(costs_.largest_map, built.largest_map);
  return {std::make_shared<const std::vector<PhotonMaps>>(std::move(maps)), kernel,
          std::move(seen)};
}

void PhotonPasses::count(const PhotonTracerResult& traced) {
  for (std::size_t light = 0; light < paths_before_.size(); ++light) {
    const std::uint64_t paths = traced.photons.emitted_per_light[light];
    paths_before_[light] += paths;
    costs_.emitted_photons += paths;
  }
  costs_.stored_photons += traced.photons.total();
  costs_.caustic_photons += traced.caustics.total();
}

void PhotonPasses::find_groups(const Photons& photons, TracedPhotons* prepared,
                               Progress& progress) {
  const Stopwatch stopwatch;
  groups_ = prepared ? std::move(prepared->groups)
                     : find_map_groups(
                           scene_, photons, plan_.used().maps, plan_.groups(radius_), progress,
                           plan_.passes() > 1 ? MapUsers::any_photons : MapUsers::these_photons);
  costs_.group.add(stopwatch.taken(), groups_.bytes());
  costs_.group_members = groups_.members.size();
  costs_.groups = groups_.offsets.size() - 1;
  costs_.patches = groups_.patches.count();
}

void PhotonPasses::find_surface(const Photons& photons) {
  if (!plan_.clips_areas()) return;
  const Stopwatch stopwatch;
  surface_ = std::make_shared<const SurfaceIndex>(
      index_surface(scene_, photons, radius_, plan_.used().angle_degrees));
  costs_.surface.add(stopwatch.taken(), surface_->bytes());
  costs_.components = surface_->components;
  costs_.surface_leaves = surface_->leaves.size();
}

}  // namespace photile
