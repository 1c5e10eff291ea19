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

/// Light of photons whose maps are built when it is first asked for.
class LaterLight : public light::LightAtPoints {
 public:
  using Find = std::function<light::LightAtPoints&()>;
  explicit LaterLight(Find find) : find_(std::move(find)) {}

  LightTable at(const PrimaryHits& points, const Progress& progress) override {
    return points.size() == 0 ? LightTable() : find_().at(points, progress);
  }

 private:
  Find find_;
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

PassLight::PassLight(const RayScene& rays, const RenderPlan& plan, PassPhotons photons, int parts,
                     cache::GatheredPoints points)
    : rays_(rays),
      plan_(plan),
      photons_(std::move(photons)),
      layer_powers_(light::layer_powers(rays.scene())) {
  make_light(parts, std::move(points));
  if (photons_.contents) cache_->maps().restore(*photons_.contents);
}

void PassLight::make_light(int parts, cache::GatheredPoints points) {
  if (plan_.light_by() == LightBy::photons) return;
  cache_.reset();
  cache::NodeSource* nodes = nullptr;
  if (plan_.light_by() == LightBy::cached_photons) {
    nodes = &by_photons_.emplace(*photons_.all);
  } else {
    const RenderParameters& used = plan_.used();
    if (!gather_) {
      gather_.emplace(rays_, *photons_.at_ends, photons_.ends, photons_.caustics.get(),
                      plan_.node_gathering(photons_.radius, photons_.maps));
    }
    nodes = &gathered_.emplace(
        *gather_, layer_powers_,
        cache::rays_of_nodes(rays_.scene(), parts * used.light_map_rays,
                             used.light_map_spacing > 0 ? 0.0 : photons_.maps.spacing),
        std::move(points));
  }
  cache_.emplace(rays_, photons_.maps, *photons_.all, *nodes, gather_ ? &gather_->ends() : nullptr);
}

std::span<const std::uint32_t> PassLight::map_of() const {
  return cache_ || plan_.used().processes ? std::span<const std::uint32_t>()
                                          : photons_.estimate->map_of();
}

std::vector<double> PassLight::fractions() const {
  return photons_.estimate ? photons_.estimate->fractions() : std::vector<double>();
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
    if (prepared->light_maps->settings == light_map_settings()) return build_later(*prepared, keep);
    progress.note("the saved light maps have other settings: they are computed again");
  }
  PassPhotons photons = build(prepared, keep, progress);
  if (!plan_.reads_light_maps()) ++pass_;
  return photons;
}

/// Photons of the pass, their maps and estimates. The photons are gone when this returns: the maps
/// hold copies.
PassPhotons PhotonPasses::build(TracedPhotons* prepared, const KeepPhotons* keep,
                                Progress& progress) {
  PhotonTracerResult traced = trace(prepared, keep, progress);
  PassPhotons photons = facts(traced.photons);
  Parts all = build_maps(std::move(traced.photons), plan_.used().kernel, plan_.leaves_out_hidden(),
                         progress);
  costs_.note_last(all.maps->front().statistics());
  // Among the photons of all light, caustics have the same groups, lit surface and radius.
  std::optional<Parts> caustics;
  if (traced.caustics.total() > 0) {
    caustics = build_maps(std::move(traced.caustics), caustic_kernel, true, progress);
  }
  const Stopwatch release_watch;
  traced = {};
  costs_.release.add(release_watch.taken());

  const Stopwatch stopwatch;
  const auto estimate_by = [&](const Parts& parts) {
    return std::make_shared<estimate::PhotonEstimate>(devices_, scene_, parts);
  };
  auto estimate = estimate_by(all);
  photons.all = shared(estimate);
  if (plan_.gathers_at_nodes()) {
    all.parameters.neighbours = plan_.neighbours_at_ends();
    photons.at_ends = shared(estimate = estimate_by(all));
  }
  if (caustics) photons.caustics = shared(estimate_by(*caustics));
  photons.estimate = std::move(estimate);
  costs_.estimators.add(stopwatch.taken());
  return photons;
}

/// The photons of `prepared` have no maps until an estimate is needed: light maps tell most light.
PassPhotons PhotonPasses::build_later(TracedPhotons& prepared, const KeepPhotons* keep) {
  radius_ = prepared.radius;
  PassPhotons photons = facts(prepared.photons);
  photons.contents = std::exchange(prepared.light_maps, std::nullopt);
  const bool has_caustics = plan_.gathers_at_nodes() && prepared.caustics->size() > 0;
  if (keep) (*keep)(prepared);
  struct Later {
    TracedPhotons prepared;
    std::optional<PassPhotons> built;
  };
  const auto later = std::make_shared<Later>(Later{std::move(prepared), std::nullopt});
  const auto light = [&](PassPhotons::Light PassPhotons::*which) {
    return std::make_shared<LaterLight>([this, later, which]() -> light::LightAtPoints& {
      // This must not be cancelled: photons that are released on the way would be lost.
      if (!later->built) later->built = build(&later->prepared, nullptr, Progress::none());
      return *(*later->built.*which);
    });
  };
  photons.all = light(&PassPhotons::all);
  if (plan_.gathers_at_nodes()) photons.at_ends = light(&PassPhotons::at_ends);
  if (has_caustics) photons.caustics = light(&PassPhotons::caustics);
  return photons;
}

PassPhotons PhotonPasses::facts(const Photons& photons) {
  PassPhotons facts;
  facts.radius = radius_;
  if (plan_.reads_light_maps()) {
    const double radius = radius_ * std::sqrt(static_cast<double>(parts_) / all_parts_);
    facts.maps = plan_.light_maps(radius, scene_, photons, layer_powers_);
    if (!first_maps_) first_maps_ = facts.maps;
    facts.maps = finer_than(*first_maps_, facts.maps.spacing);
    facts.ends = plan_.ends(radius_, scene_, photons, layer_powers_);
  }
  return facts;
}

PassPhotons::Light PhotonPasses::shared(std::shared_ptr<estimate::PhotonEstimate> estimate) {
  auto* const processes = plan_.used().processes;
  if (!processes) return estimate;
  return std::make_shared<Exchange>(*processes, owners_, std::move(estimate),
                                    LightTable(rays_.needs()), costs_.sent);
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
    const bool caustics = plan_.gathers_at_nodes() && rays_.needs().specular_paths;
    kernels_.emplace(scene_, devices_, plan_.used(), plan_.leaves_out_hidden() || caustics,
                     caustics);
  }
  const Stopwatch trace_watch;
  PhotonTracerResult traced;
  if (prepared) {
    traced.photons = std::move(prepared->photons);
    if (plan_.gathers_at_nodes()) traced.caustics = std::move(*prepared->caustics);
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
    if (plan_.gathers_at_nodes()) {
      traced.caustics.of_all = photons_of_all(*processes, traced.caustics);
    }
    costs_.exchange.add(stopwatch.taken());
  }
  costs_.count(traced);
  for (std::size_t light = 0; light < paths_before_.size(); ++light) {
    paths_before_[light] += traced.photons.emitted_per_light[light];
  }
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
    if (plan_.gathers_at_nodes()) own.caustics = std::move(traced.caustics);
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
    photons =
        to_owners(processes, scene_, groups_, *owners_, radius, std::move(photons), costs_.sent);
  };
  move(traced.photons);
  if (traced.caustics.total() > 0) move(traced.caustics);
  progress.end();
  costs_.exchange.add(stopwatch.taken(), traced.photons.bytes() + traced.caustics.bytes());
}

PhotonPasses::Parts PhotonPasses::build_maps(Photons photons, DensityKernel kernel,
                                             bool leaves_out_hidden, Progress& progress) {
  const Stopwatch stopwatch;
  const PhotonMapParameters parameters = plan_.maps(pass_, radius_);
  kernels_->wait();
  Parts parts{nullptr, plan_.estimate(pass_, kernel, surface_)};
  if (leaves_out_hidden) {
    parts.seen =
        std::make_shared<const estimate::VisiblePhotons>(rays_, photons, kernel, parameters.radius);
  }
  std::vector<std::uint8_t> own;
  if (owners_) own = owners_->maps_of(plan_.used().processes->rank());
  parts.maps = std::make_shared<const std::vector<PhotonMaps>>(estimate::build_maps_on_each(
      devices_, scene_, std::move(photons), groups_, parameters, progress, own));
  costs_.add(*parts.maps, stopwatch.taken());
  return parts;
}

void PhotonPasses::find_groups(const Photons& photons, TracedPhotons* prepared,
                               Progress& progress) {
  const Stopwatch stopwatch;
  groups_ = prepared ? std::move(prepared->groups)
                     : find_map_groups(
                           scene_, photons, plan_.used().maps,
                           {radius_, plan_.used().angle_degrees}, progress,
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
