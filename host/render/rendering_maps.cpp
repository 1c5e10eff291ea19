// What a rendering looks at: the photons of a pass, their groups and surface, and the maps of them.
#include <algorithm>
#include <utility>
#include <vector>

#include "photile/quiet_progress.hpp"
#include "render/rendering.hpp"
#include "render/shared_photons.hpp"

namespace photile {
namespace {

/// Pixels from one look to the next by which it is foreseen what a large picture shows.
constexpr int look_step = 4;

}  // namespace

MapEstimators::Parts Rendering::parts_of(std::vector<PhotonMaps> maps,
                                         std::shared_ptr<const SeenPhotons> seen) const {
  return {std::move(maps), plan_.estimates(pass_, surface_), std::move(seen)};
}

PhotonTracerResult Rendering::trace(int pass, PreparedPhotons* prepared, const KeepPhotons* keep) {
  if (!kernels_) kernels_.emplace(scene_, devices_, plan_.used());  // while photons are traced
  const Stopwatch trace_watch;
  PhotonTracerResult traced;
  if (prepared) {
    traced.photons = std::move(prepared->photons);
    if (plan_.keeps_caustics()) traced.caustics = std::move(*prepared->caustics);
  } else {
    traced = trace_photons(rays_, plan_.tracing(pass, paths_before_), *progress_);
  }
  costs_.trace.add(trace_watch.taken(), traced.photons.bytes() + traced.caustics.bytes());
  if (Communicator* const processes = plan_.used().processes) {
    const Stopwatch stopwatch;
    traced.photons.of_all = photons_of_all(*processes, traced.photons);
    if (plan_.keeps_caustics()) {
      traced.caustics.of_all = photons_of_all(*processes, traced.caustics);
    }
    costs_.exchange.add(stopwatch.taken());
  }
  count(traced);
  if (pass == 0) {
    const Stopwatch radius_watch;
    const bool grouped = prepared && prepared->has_groups();
    radius_ = grouped ? prepared->radius : plan_.radius(traced.photons, *progress_);
    costs_.radius.add(radius_watch.taken());
    find_groups(traced.photons, grouped ? prepared : nullptr);  // once: no later radius is larger
  }
  if (plan_.used().processes) move_to_owners(traced);
  if (pass == 0) find_surface(traced.photons);
  if (plan_.reads_light_maps()) choose_light_maps(pass, traced.photons);
  if (keep) {
    PreparedPhotons own{std::move(traced.photons), std::move(groups_), radius_};
    if (plan_.keeps_caustics()) own.caustics = std::move(traced.caustics);
    (*keep)(own);
    traced.photons = std::move(own.photons);
    groups_ = std::move(own.groups);
    if (own.caustics) traced.caustics = std::move(*own.caustics);
  }
  return traced;
}

void Rendering::move_to_owners(PhotonTracerResult& traced) {
  const Stopwatch stopwatch;
  Communicator& processes = *plan_.used().processes;
  progress_->begin("exchange photons", 0, "");
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
  progress_->end();
  costs_.exchange.add(stopwatch.taken(), traced.photons.bytes() + traced.caustics.bytes());
}

/// The photons are gone when this returns: the maps hold copies.
Rendering::Maps Rendering::trace_and_build(int pass, PreparedPhotons* prepared,
                                           const KeepPhotons* keep) {
  PhotonTracerResult traced = trace(pass, prepared, keep);
  const PhotonMapParameters parameters = plan_.maps(pass, radius_);
  Maps maps{build(std::move(traced.photons), parameters), {}, nullptr};
  costs_.maps = maps.photons.front().statistics().maps;
  costs_.mixed_maps = maps.photons.front().statistics().mixed_maps;
  costs_.map_sizes = maps.photons.front().statistics().map_sizes;
  // Among the photons of all light, caustics have the same groups, lit surface and radius.
  if (traced.caustics.total() > 0) {
    maps.seen_caustics = std::make_shared<const SeenPhotons>(rays_, traced.caustics);
    maps.caustics = build(std::move(traced.caustics), parameters);
  }
  const Stopwatch release_watch;
  traced = {};
  costs_.release.add(release_watch.taken());
  return maps;
}

std::vector<PhotonMaps> Rendering::build(Photons photons, const PhotonMapParameters& parameters) {
  const Stopwatch stopwatch;
  kernels_->wait();
  std::vector<std::uint8_t> own;
  if (owners_) own = owners_->maps_of(plan_.used().processes->rank());
  std::vector<PhotonMaps> maps = build_maps_on_each(devices_, scene_, std::move(photons), groups_,
                                                    parameters, *progress_, own);
  std::uint64_t device_bytes = 0, spilled_bytes = 0;
  for (const PhotonMaps& one : maps) {
    device_bytes += one.statistics().device_bytes - one.statistics().spilled_bytes;
    spilled_bytes += one.statistics().spilled_bytes;
  }
  costs_.build.add(stopwatch.taken(), spilled_bytes, device_bytes);
  note_maps(maps.front().statistics());
  return maps;
}

void Rendering::note_maps(const PhotonMapStatistics& built) {
  costs_.references += built.references;
  costs_.largest_map = std::max(costs_.largest_map, built.largest_map);
}

bool Rendering::makes_maps_in_sight() const {
  return one_picture_ && !plan_.used().processes && plan_.passes() == 1 &&
         plan_.reads_light_maps() && !plan_.keeps_caustics() && devices_.size() == 1 &&
         !is_global(plan_.used().structure);
}

MapEstimators::Parts Rendering::build_some(std::span<const std::uint8_t> wanted) {
  const Stopwatch stopwatch;
  QuietProgress quiet(*progress_);
  if (seen_.first_of.empty()) seen_ = trace_photons(rays_, plan_.tracing(pass_, {}), quiet).photons;
  kernels_->wait();
  const PhotonMapParameters parameters = plan_.maps(pass_, radius_);
  std::vector<PhotonMaps> maps;
  if (seen_whole_) {
    maps.emplace_back(devices_.front(), scene_, std::move(seen_), groups_, parameters, quiet,
                      wanted);
    seen_ = {};
  } else {
    maps.emplace_back(devices_.front(), scene_, std::as_const(seen_), groups_, parameters, quiet,
                      wanted);
  }
  const PhotonMapStatistics& built = maps.front().statistics();
  costs_.build.add(stopwatch.taken());
  costs_.build.host_bytes += built.spilled_bytes;
  costs_.build.device_bytes += built.device_bytes - built.spilled_bytes;
  costs_.maps += built.maps;
  costs_.mixed_maps += built.mixed_maps;
  costs_.map_sizes.insert(costs_.map_sizes.end(), built.map_sizes.begin(), built.map_sizes.end());
  note_maps(built);
  return parts_of(std::move(maps));
}

void Rendering::make_maps(const HitSource& source, const PrimaryHitBatch& batch, int rows) {
  if (!photons_->makes_maps_in_sight()) return;
  progress_->begin("build photon maps", 0, "");
  const Stopwatch sight_watch;
  std::vector<std::uint32_t> triangles;
  const auto look_at = [&](const PrimaryHits& hits) {
    const std::vector<std::uint32_t> more =
        reads_light_maps(source) ? light_maps().looked_at(hits) : hits.sided_triangle;
    triangles.insert(triangles.end(), more.begin(), more.end());
  };
  look_at(batch.hits);
  look_at(batch.reflected);
  seen_whole_ = rows >= film_.height;
  if (!seen_whole_) {  // what a small picture of the same shows
    PrimaryHitParameters small = film_;
    small.width = (film_.width - 1) / look_step + 1;
    small.height = (film_.height - 1) / look_step + 1;
    small.samples_per_pixel = small.runs = 1;
    const PrimaryHitBatch looks = source.trace(rays_, small, 0, small.height, {});
    look_at(looks.hits);
    look_at(looks.reflected);
  }
  costs_.light_maps.add(sight_watch.taken());
  const Stopwatch stopwatch;
  const TimeTaken built_before = costs_.build.time;
  photons_->look_at(triangles);
  costs_.estimators.add(stopwatch.taken() - (costs_.build.time - built_before));
  progress_->end();
}

void Rendering::count(const PhotonTracerResult& traced) {
  for (std::size_t light = 0; light < paths_before_.size(); ++light) {
    const std::uint64_t paths = traced.photons.emitted_per_light[light];
    paths_before_[light] += paths;
    costs_.emitted_photons += paths;
  }
  costs_.stored_photons += traced.photons.total();
  costs_.caustic_photons += traced.caustics.total();
}

void Rendering::find_groups(const Photons& photons, PreparedPhotons* prepared) {
  const Stopwatch stopwatch;
  groups_ = prepared ? std::move(prepared->groups)
                     : find_map_groups(
                           scene_, photons, plan_.map_mode(), plan_.groups(radius_), *progress_,
                           plan_.passes() > 1 ? MapUsers::any_photons : MapUsers::these_photons);
  costs_.group.add(stopwatch.taken(), groups_.bytes());
  costs_.group_members = groups_.members.size();
  costs_.groups = groups_.offsets.size() - 1;
  costs_.patches = groups_.patches.count();
}

void Rendering::find_surface(const Photons& photons) {
  if (!plan_.clips_areas()) return;
  const Stopwatch stopwatch;
  surface_ = std::make_shared<const SurfaceIndex>(
      index_surface(scene_, photons, radius_, plan_.used().angle_degrees));
  costs_.surface.add(stopwatch.taken(), surface_->bytes());
  costs_.sheets = surface_->sheets;
  costs_.surface_leaves = surface_->leaves.size();
}

Shard Rendering::own_rows() const {
  const Communicator* const processes = plan_.used().processes;
  return processes ? Shard{processes->rank(), processes->size()} : Shard{};
}

OwnerEstimates::Moved Rendering::moved() const {
  OwnerEstimates::Moved sum;
  for (const auto* estimators : {&photons_, &caustics_}) {
    if (!*estimators || !(*estimators)->owners()) continue;
    const OwnerEstimates::Moved& moved = (*estimators)->owners()->moved();
    sum.hits += moved.hits;
    sum.bytes += moved.bytes;
  }
  return sum;
}

}  // namespace photile
