#include "maps/map_store.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "common/value_range.hpp"
#include "geometry/radius_range.hpp"
#include "maps/build_maps.hpp"
#include "maps/check_photons.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/photon_maps.hpp"
#include "photile/scene_builder.hpp"
#include "photile/statistics.hpp"
#include "photile/surface_index.hpp"

namespace photile::maps {

std::vector<std::uint32_t> MapStore::maps_of(const PrimaryHits& hits, std::size_t first,
                                             std::size_t count) const {
  const auto begin = hits.oriented_face.begin() + static_cast<std::ptrdiff_t>(first);
  std::vector<std::uint32_t> maps(begin, begin + static_cast<std::ptrdiff_t>(count));
  if (!map_of.empty()) {
    for (std::uint32_t& map : maps) map = map_of[map];
  }
  return maps;
}

}  // namespace photile::maps

namespace photile {

namespace {

void check(const Scene& scene, const Photons& photons, const NeighbourGroups& groups,
           const PhotonMapParameters& parameters) {
  check_radius(scene, parameters.radius);
  if (parameters.radius > groups.radius) {
    throw UsageError(fmt::format("radius {} m is larger than the neighbour groups' {} m",
                                 parameters.radius, groups.radius));
  }
  check_setting("photons_per_cell", setting_value(parameters.photons_per_cell));
  if (photons.size() > limits::max_stored_photons) {
    throw UsageError(fmt::format("{} stored photons; at most {} can be indexed", photons.size(),
                                 limits::max_stored_photons));
  }
}

}  // namespace

PhotonMaps::PhotonMaps(Device& device, const Scene& scene, const Photons& photons,
                       const NeighbourGroups& groups, const PhotonMapParameters& parameters,
                       Progress& progress, std::span<const std::uint8_t> requested) {
  build(device, scene, photons, nullptr, groups, parameters, requested, progress);
}

PhotonMaps::PhotonMaps(Device& device, const Scene& scene, Photons&& photons,
                       const NeighbourGroups& groups, const PhotonMapParameters& parameters,
                       Progress& progress, std::span<const std::uint8_t> requested) {
  Photons own = std::move(photons);
  build(device, scene, own, &own, groups, parameters, requested, progress);
}

void PhotonMaps::build(Device& device, const Scene& scene, const Photons& photons,
                       Photons* consumed, const NeighbourGroups& groups,
                       const PhotonMapParameters& parameters,
                       std::span<const std::uint8_t> requested, Progress& progress) {
  check_scene(scene);
  check(scene, photons, groups, parameters);
  const Stopwatch stopwatch;
  progress.begin("build photon maps", 0, "references");
  store_ = std::make_unique<maps::MapStore>(device, needs_of(scene), parameters);
  const std::string problem = maps::problem_of(photons, store_->needs, 2 * scene.triangle_count());
  if (!problem.empty()) {
    throw InputError(fmt::format("photons of {}: {}", scene.source.string(), problem));
  }
  store_->angle_degrees = groups.angle_degrees;
  store_->cos_angle = std::cos(glm::radians(groups.angle_degrees));
  store_->naive = std::isinf(groups.radius);
  store_->landed = landed_on(scene, photons);
  store_->statistics.photons = photons.size();
  if (groups.offsets.size() != 2 * scene.triangle_count() + 1) {
    throw InputError(
        fmt::format("neighbour groups of {}: they belong to another scene", scene.source.string()));
  }
  maps::build_maps_of_groups(*store_, scene, photons, consumed, groups, requested, progress);

  store_->statistics.spilled_bytes = store_->pages.spilled_bytes();
  store_->statistics.seconds = stopwatch.seconds();
  progress.end();
}

PhotonMaps::PhotonMaps(std::unique_ptr<maps::MapStore> store) : store_(std::move(store)) {}

const maps::MapStore& maps::store_of(const PhotonMaps& maps) { return *maps.store_; }
PhotonMaps maps::maps_in(std::unique_ptr<maps::MapStore> store) {
  return PhotonMaps(std::move(store));
}

PhotonMaps::~PhotonMaps() = default;
PhotonMaps::PhotonMaps(PhotonMaps&&) noexcept = default;
PhotonMaps& PhotonMaps::operator=(PhotonMaps&&) noexcept = default;

const PhotonMapStatistics& PhotonMaps::statistics() const { return store_->statistics; }
const PhotonMapParameters& PhotonMaps::parameters() const { return store_->parameters; }
Device& PhotonMaps::device() const { return *store_->device; }
std::span<const std::uint32_t> PhotonMaps::map_of() const { return store_->map_of; }

}  // namespace photile
