// Photon maps of the scene as it is now, for the window's thread to take.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "view/photon_worker.hpp"

namespace photile::view {

class PhotonFeed {
 public:
  ///   light_map_bytes   that nodes may take; 0 = no bound
  PhotonFeed(PhotonWorker::OpenDevices open_devices, std::uint64_t light_map_bytes)
      : open_devices_(std::move(open_devices)), light_map_bytes_(light_map_bytes) {}

  /// Ends what it is at, and traces this scene, which maps hold from then on. As PhotonWorker.
  void trace(std::shared_ptr<const Scene> scene, const RenderParameters& parameters,
             std::optional<PreparedPhotons> prepared, KeepPhotons keep);
  void stop() { worker_.reset(); }

  /// The newest maps, once whenever there is something new in them.
  std::shared_ptr<MapGeneration> take();

  WorkProgress progress() const { return worker_ ? worker_->progress() : WorkProgress(); }
  std::exception_ptr take_error() { return worker_ ? worker_->take_error() : nullptr; }

 private:
  const PhotonWorker::OpenDevices open_devices_;
  const std::uint64_t light_map_bytes_;
  std::mutex mutex_;
  std::shared_ptr<MapGeneration> delivered_;
  std::optional<PhotonWorker> worker_;  // last: it delivers
};

}  // namespace photile::view
