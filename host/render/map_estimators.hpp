// Photon maps of a pass on every device, and the estimates made with them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "photile/estimator.hpp"
#include "render/device_estimators.hpp"
#include "render/owner_estimates.hpp"
#include "render/seen_photons.hpp"

namespace photile {

class MapEstimators {
 public:
  struct Parts {
    std::vector<PhotonMaps> maps;            ///< the same on each device
    std::vector<EstimateParameters> levels;  ///< ascending in k: hits choose one, each its own
    /// Of the photons of these maps: what a hit does not see does not count. Null: all count.
    std::shared_ptr<const SeenPhotons> seen = nullptr;
  };
  /// References are kept.
  ///   layer_powers   by which hits choose their own k
  /// Errors: as Estimator.
  MapEstimators(std::span<Device> devices, const Scene& scene, Parts parts,
                std::span<const double> layer_powers);

  /// The same of what `make` gives when it is first needed: errors are then those of `make`, too.
  MapEstimators(std::span<Device> devices, const Scene& scene, std::function<Parts()> make,
                std::span<const double> layer_powers);

  /// Makes those maps of neighbour groups that are 1.
  using MakeSome = std::function<Parts(std::span<const std::uint8_t> wanted)>;
  /// The same of maps of these patches, a reference to which is kept, as they are looked at. What
  /// is looked at first is made alone, and what is looked at next; from then on, all that is left.
  MapEstimators(std::span<Device> devices, const Scene& scene, const Patches& patches,
                MakeSome make, std::span<const double> layer_powers);

  bool makes_maps_in_sight() const { return patches_ != nullptr; }

  /// Makes the maps that serve these sided triangles. Errors: those of making them.
  void look_at(std::span<const std::uint32_t> sided_triangles);

  /// From now on maps are those of several processes, each of which has its own, and all make the
  /// same calls of the two functions below. Before any estimate; references are kept. What is
  /// estimated must not depend on the hits beside it.
  void share(OwnerEstimates owners) { owners_.emplace(std::move(owners)); }
  /// Null where this process has all maps.
  const OwnerEstimates* owners() const { return owners_ ? &*owners_ : nullptr; }

  /// Of hits in any order, of this process alone. Errors: as DeviceEstimators.
  Estimates estimate(const PrimaryHits& hits);
  /// Of hits that are the same in all processes.
  Estimates estimate_same(const PrimaryHits& hits);

  /// Per sided triangle, as PhotonMaps has it: the order of hits. Empty where maps are made as they
  /// are looked at, or are those of several processes.
  std::span<const std::uint32_t> map_of() const {
    return patches_ || owners_ ? std::span<const std::uint32_t>() : built().maps.front().map_of();
  }

  /// k, or the most that a hit has where it has its own.
  int neighbours() const { return built().neighbours.back(); }
  /// Of the maps, metres.
  double radius() const { return built().maps.front().parameters().radius; }

  /// Each device's part of all hits so far; none without any.
  std::vector<double> shares() const {
    return built_.empty() ? std::vector<double>(devices_.size(), 0.0)
                          : built_.front()->estimators.back().shares();
  }

 private:
  struct Built {
    std::vector<PhotonMaps> maps;              ///< on each device
    std::vector<int> neighbours;               ///< of each level
    std::vector<DeviceEstimators> estimators;  ///< of each level; they keep references to the maps
    std::shared_ptr<const SeenPhotons> seen;   ///< as Parts has it
  };

  /// By maps of this process.
  Estimates estimate_here(const PrimaryHits& hits);
  std::unique_ptr<Built> built_of(Parts parts) const;
  Estimates estimate_by(Built& built, const PrimaryHits& hits) const;
  Estimates estimate_by(DeviceEstimators& estimators, const SeenPhotons* seen,
                        const PrimaryHits& hits) const;
  Built& built() const;

  std::span<Device> devices_;
  const Scene& scene_;
  std::span<const double> layer_powers_;
  mutable std::function<Parts()> make_;
  std::optional<OwnerEstimates> owners_;  ///< where several processes have maps
  const Patches* patches_ = nullptr;      ///< where maps are made as they are looked at
  MakeSome make_some_;
  std::vector<std::uint32_t> part_of_;  ///< per map of the groups: in built_; or none
  mutable std::vector<std::unique_ptr<Built>> built_;  ///< one, but where make_some_ made several
};

}  // namespace photile
