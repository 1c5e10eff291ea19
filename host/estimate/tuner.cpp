#include "estimate/tuner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>

#include "common/value_range.hpp"
#include "estimate/hit_buffers.hpp"
#include "estimate/query.hpp"
#include "estimate/tuning_search.hpp"
#include "photile/errors.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photon_maps.hpp"
#include "photile/statistics.hpp"

namespace photile {
namespace estimate {
namespace {

constexpr double least_gain = 0.03;

/// The sample on the device, with maps of every cell occupancy that was asked for.
class Bench {
 public:
  Bench(Device& device, const SceneNeeds& needs, int neighbours, const TuningSampleSize& size)
      : device_(device),
        neighbours_(static_cast<std::uint32_t>(neighbours)),
        sample_(make_tuning_sample(needs, neighbours, size)),
        groups_(find_neighbour_groups(sample_.scene, {sample_.radius})) {
    upload_hits(device::context_of(device), sample_.hits, 0, sample_.hits.sided_triangle, {},
                nullptr, needs, hits_);
  }

  /// Median of 5 runs over all hits, after one that warms up.
  double microseconds_per_hit(const EstimateTuning& tuning) {
    const maps::MapStore& store = maps::store_of(maps_of(tuning.photons_per_cell));
    const auto query = make_grid_query(store, {.neighbours = neighbours_,
                                               .compiled_neighbours = neighbours_,
                                               .radius = static_cast<float>(sample_.radius),
                                               .tuning = tuning});
    if (!estimates_) {  // the sums of a hit depend on k, not on the tuning
      estimates_.emplace(device::context_of(device_), query->sums());
      estimates_->begin(hits_.count);
    }
    std::array<double, 5> seconds{};
    run(store, *query);
    for (double& measured : seconds) {
      const Stopwatch stopwatch;
      run(store, *query);
      measured = stopwatch.seconds();
    }
    std::nth_element(seconds.begin(), seconds.begin() + 2, seconds.end());
    return 1e6 * seconds[2] / static_cast<double>(sample_.hits.size());
  }

 private:
  const PhotonMaps& maps_of(float photons_per_cell) {
    const auto found = maps_.find(photons_per_cell);
    if (found != maps_.end()) return found->second;
    PhotonMaps maps(device_, sample_.scene, sample_.photons, groups_,
                    {sample_.radius, photons_per_cell});
    return maps_.emplace(photons_per_cell, std::move(maps)).first->second;
  }

  void run(const maps::MapStore& store, Query& query) {
    for_each_page(store, hits_, sample_.hits.sided_triangle,
                  [&](const PageHits& page_hits) { query.estimate(page_hits, *estimates_); });
    device::context_of(device_).finish();
  }

  Device& device_;
  std::uint32_t neighbours_;
  TuningSample sample_;
  NeighbourGroups groups_;
  HitBuffers hits_;
  std::optional<EstimateBuffers> estimates_;
  std::map<float, PhotonMaps> maps_;  ///< by photons per cell
};

}  // namespace

TuningResult tune_on_sample(Device& device, const SceneNeeds& needs, int neighbours,
                            const TuningSampleSize& size, Progress& progress) {
  check_setting("neighbours", setting_value(neighbours));
  progress.begin("tune estimate", 0, "trials");
  Bench bench(device, needs, neighbours, size);
  TuningResult result;
  const auto cost = [&](const EstimateTuning& tuning) {
    progress.throw_if_cancelled();
    double time = std::numeric_limits<double>::infinity();
    try {
      time = bench.microseconds_per_hit(tuning);
    } catch (const DeviceError&) {
      // A driver may refuse a work-group for its registers; the table says that it did.
      time = std::numeric_limits<double>::infinity();
    }
    result.trials.push_back({tuning, time});
    progress.advance(1);
    return time;
  };
  result.best = search_tuning(shipped_tuning(device.info()), needs, neighbours, cost, least_gain);
  progress.end();
  return result;
}

}  // namespace estimate

TuningResult tune_estimate(Device& device, const SceneNeeds& needs, int neighbours,
                           Progress& progress) {
  return estimate::tune_on_sample(device, needs, neighbours, {}, progress);
}

}  // namespace photile
