// Estimates made by the processes that hold the photon maps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "photile/communicator.hpp"
#include "photile/estimator.hpp"
#include "photile/primary_hits.hpp"
#include "render/map_owners.hpp"

namespace photile {

/// Bytes of estimates, and back: read ones are appended.
std::vector<std::byte> bytes_of(const Estimates& estimates);
void append_estimates(std::span<const std::byte> bytes, Estimates& estimates);

/// Sends hits to the owners of their maps, and brings their estimates back. What a hit gets must
/// not depend on the hits beside it.
class OwnerEstimates {
 public:
  /// Of hits on maps of this process.
  using Estimate = std::function<Estimates(const PrimaryHits& hits)>;

  /// A reference to `processes` is kept.
  ///   lights        layers of the scene
  ///   many_lights   estimates have the form of many lights
  OwnerEstimates(Communicator& processes, std::shared_ptr<const MapOwners> owners,
                 std::size_t lights, bool many_lights)
      : processes_(processes), owners_(std::move(owners)), lights_(lights), many_(many_lights) {}

  /// Of this process's hits, by whichever process. Collective.
  Estimates estimate(const PrimaryHits& hits, const Estimate& here);

  /// Of hits that are the same on all processes: each estimates its own, and all have all.
  /// Collective.
  Estimates estimate_same(const PrimaryHits& hits, const Estimate& here);

  Communicator& processes() const { return processes_; }

  /// Hits and estimates that went to other processes so far.
  struct Moved {
    std::uint64_t hits = 0, bytes = 0;
  };
  const Moved& moved() const { return moved_; }

 private:
  Estimates none_yet() const;
  /// Of some hits; none of none.
  Estimates of(const PrimaryHits& hits, const Estimate& here) const;
  /// Positions of hits, by their owners.
  std::vector<std::vector<std::uint32_t>> by_owner(const PrimaryHits& hits) const;
  Estimates in_order(std::span<const std::vector<std::uint32_t>> places,
                     std::span<const std::vector<std::byte>> bytes, std::size_t hits) const;

  Communicator& processes_;
  std::shared_ptr<const MapOwners> owners_;
  std::size_t lights_;
  bool many_;
  Moved moved_;
};

}  // namespace photile
