// Photon maps that get better in the background, for the room's thread to take.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "photile/renderer.hpp"
#include "render/render_session.hpp"
#include "view/frame.hpp"
#include "view/photon_map.hpp"

namespace photile::view {

/// Photon maps on separate devices, so that one set can be built while another is in use.
struct MapGeneration {
  std::shared_ptr<const Scene> scene;  ///< held for the renderer; null where its owner is elsewhere
  std::vector<Device> devices;
  std::unique_ptr<RenderSession> renderer;
  /// The maps of a first picture, shown where the light maps of this one have no node yet; null =
  /// none.
  std::shared_ptr<MapGeneration> coarser;
  /// The frames of that, which show it so; null = none.
  cache::FrameView* coarser_view() const {
    return coarser ? &coarser->renderer->frames().view() : nullptr;
  }
  std::uint64_t emitted_photons = 0;
  bool whole = false;            ///< of all photons that were asked for
  std::atomic<bool> lit{false};  ///< set once a frame had its own light on all surface
  std::shared_ptr<const InspectablePhotons> photons;
};

/// The progress of the work in the background.
struct WorkProgress {
  std::string stage;  ///< "" = nothing is under way
  double share = 0;   ///< of the stage, in [0, 1]; 0 where it is not known
};

/// Traces photons and builds maps on its own thread: first those of a first picture
/// (render/quality.hpp), so that there is something to see at once, then, when that has light
/// everywhere, those that `render` builds from the same parameters.
class PhotonWorker {
 public:
  using OpenDevices = std::function<std::vector<Device>()>;
  using Deliver = std::function<void(std::shared_ptr<MapGeneration>)>;

  ///   prepared   photons of an earlier run, in place of all tracing, or none
  ///   keep       is given the photons of the last maps; may be empty
  ///   deliver    is called on the worker's thread with each set of maps
  PhotonWorker(const Scene& scene, OpenDevices open_devices, const RenderParameters& parameters,
               std::optional<TracedPhotons> prepared, KeepPhotons keep, Deliver deliver);
  ~PhotonWorker();

  WorkProgress progress() const;

  /// The error that ended the work, or null; each is returned once.
  std::exception_ptr take_error();

 private:
  class Listener;

  void work(std::optional<TracedPhotons> prepared);
  std::shared_ptr<MapGeneration> build(const RenderParameters& parameters, bool whole,
                                       TracedPhotons* prepared);

  const Scene& scene_;
  std::shared_ptr<const PreparedScene> prepared_scene_;  ///< once there is any
  const OpenDevices open_devices_;
  const RenderParameters parameters_;
  const KeepPhotons keep_;
  const Deliver deliver_;
  std::unique_ptr<Listener> listener_;
  mutable std::mutex mutex_;
  std::exception_ptr error_;
  std::jthread thread_;  // last: it uses all of the above
};

class PhotonFeed {
 public:
  ///   light_map_bytes   that nodes may take; 0 = no bound
  PhotonFeed(PhotonWorker::OpenDevices open_devices, std::uint64_t light_map_bytes)
      : open_devices_(std::move(open_devices)), light_map_bytes_(light_map_bytes) {}

  /// Cancels the current work, and traces this scene, which maps hold from then on. As
  /// PhotonWorker.
  void trace(std::shared_ptr<const Scene> scene, const RenderParameters& parameters,
             std::optional<TracedPhotons> prepared, KeepPhotons keep);
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
