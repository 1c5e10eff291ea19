// Light at points by the processes that hold the photon maps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "photile/communicator.hpp"
#include "estimate/light_at_points.hpp"
#include "render/map_owners.hpp"

namespace photile {

/// Points and estimates that went to other processes.
struct PointTraffic {
  std::uint64_t points = 0, bytes = 0;
};

/// Sends points to the owners of their maps, and brings their estimates back. What a point gets
/// must not depend on the points beside it. Collective: all processes ask at the same time.
class Exchange : public LightAtPoints {
 public:
  enum class Points {
    own,    ///< each process asks for points of its own, or for none
    common  ///< all ask for the same points: each estimates those of its maps, and all have all
  };

  /// References are kept.
  ///   here          answers for maps of this process
  ///   lights        layers of the scene
  ///   many_lights   estimates have the form of many lights
  ///   traffic       is added to
  Exchange(Communicator& processes, std::shared_ptr<const MapOwners> owners,
           std::shared_ptr<LightAtPoints> here, Points points, std::size_t lights, bool many_lights,
           PointTraffic& traffic)
      : processes_(processes),
        owners_(std::move(owners)),
        here_(std::move(here)),
        points_(points),
        lights_(lights),
        many_(many_lights),
        traffic_(traffic) {}

  Estimates at(const PrimaryHits& points, const Progress& progress) override {
    return points_ == Points::own ? at_own(points, progress) : at_common(points, progress);
  }

 private:
  Estimates at_own(const PrimaryHits& points, const Progress& progress);
  Estimates at_common(const PrimaryHits& points, const Progress& progress);
  Estimates none_yet() const;
  /// Positions of points, by their owners.
  std::vector<std::vector<std::uint32_t>> by_owner(const PrimaryHits& points) const;
  Estimates in_order(std::span<const std::vector<std::uint32_t>> places,
                     std::span<const std::vector<std::byte>> bytes, std::size_t points) const;

  Communicator& processes_;
  std::shared_ptr<const MapOwners> owners_;
  std::shared_ptr<LightAtPoints> here_;
  Points points_;
  std::size_t lights_;
  bool many_;
  PointTraffic& traffic_;
};

}  // namespace photile
