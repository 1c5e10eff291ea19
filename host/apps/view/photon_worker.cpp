#include "view/photon_worker.hpp"

#include <algorithm>
#include <chrono>

#include "photile/errors.hpp"
#include "render/quality.hpp"

namespace photile::view {

/// Seconds that the tracing of photons may wait for the light of a first picture.
constexpr double patience = 10;

/// Keeps the reports of the stages for other threads, and cancels the stages.
class PhotonWorker::Listener : public Progress {
 public:
  void begin(std::string_view stage, std::uint64_t total, std::string_view) override {
    const std::lock_guard lock(mutex_);
    stage_ = stage;
    total_ = total;
    done_ = 0;
  }
  void advance(std::uint64_t count) override { done_ += count; }
  void end() override {
    const std::lock_guard lock(mutex_);
    stage_.clear();
  }
  bool cancelled() const override { return stopped_; }

  void stop() { stopped_ = true; }

  WorkProgress progress() const {
    const std::lock_guard lock(mutex_);
    const double share =
        total_ > 0 ? static_cast<double>(done_.load()) / static_cast<double>(total_) : 0;
    return {stage_, std::min(share, 1.0)};
  }

 private:
  mutable std::mutex mutex_;
  std::string stage_;
  std::uint64_t total_ = 0;
  std::atomic<std::uint64_t> done_{0};
  std::atomic<bool> stopped_{false};
};

PhotonWorker::PhotonWorker(const Scene& scene, OpenDevices open_devices,
                           const RenderParameters& parameters,
                           std::optional<TracedPhotons> prepared, KeepPhotons keep, Deliver deliver)
    : scene_(scene),
      open_devices_(std::move(open_devices)),
      parameters_(parameters),
      keep_(std::move(keep)),
      deliver_(std::move(deliver)),
      listener_(std::make_unique<Listener>()),
      thread_([this, prepared = std::move(prepared)]() mutable { work(std::move(prepared)); }) {}

PhotonWorker::~PhotonWorker() { listener_->stop(); }

WorkProgress PhotonWorker::progress() const { return listener_->progress(); }

std::exception_ptr PhotonWorker::take_error() {
  const std::lock_guard lock(mutex_);
  return std::exchange(error_, nullptr);
}

void PhotonWorker::work(std::optional<TracedPhotons> prepared) {
  try {
    std::shared_ptr<MapGeneration> first;
    if (!prepared) {
      first = build(first_picture_parameters(parameters_), false, nullptr);
      deliver_(first);
      // All processors are to work for the first picture; a viewer who walks on sees new surface
      // all the time.
      for (const Stopwatch waited; !first->lit && waited.seconds() < patience;) {
        listener_->throw_if_cancelled();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    }
    const std::shared_ptr<MapGeneration> whole =
        build(parameters_, true, prepared ? &*prepared : nullptr);
    if (whole->renderer->reads_light_maps()) whole->coarser = std::move(first);
    deliver_(whole);
  } catch (const Interrupted&) {
    // The room was closed, or other parameters were asked for.
  } catch (...) {
    const std::lock_guard lock(mutex_);
    error_ = std::current_exception();
  }
}

std::shared_ptr<MapGeneration> PhotonWorker::build(const RenderParameters& parameters, bool whole,
                                                   TracedPhotons* prepared) {
  listener_->throw_if_cancelled();
  auto generation = std::make_shared<MapGeneration>();
  generation->devices = open_devices_();
  const KeepPhotons keep = [&](const TracedPhotons& photons) {
    generation->photons = std::make_shared<InspectablePhotons>(InspectablePhotons::of(photons));
    if (whole && keep_) keep_(photons);
  };
  if (!prepared_scene_) prepared_scene_ = std::make_shared<const PreparedScene>(scene_);
  generation->renderer =
      std::make_unique<RenderSession>(prepared_scene_, generation->devices, parameters, *listener_);
  generation->renderer->keep_passes(prepared, keep, *listener_);
  generation->emitted_photons = parameters.photons.emitted_photons;
  generation->whole = whole;
  return generation;
}

void PhotonFeed::trace(std::shared_ptr<const Scene> scene, const RenderParameters& parameters,
                       std::optional<TracedPhotons> prepared, KeepPhotons keep) {
  worker_.reset();
  take();  // of the scene before
  const Scene& traced = *scene;
  worker_.emplace(traced, open_devices_, parameters, std::move(prepared), std::move(keep),
                  [this, scene = std::move(scene), bounded = std::shared_ptr<MapGeneration>()](
                      std::shared_ptr<MapGeneration> maps) mutable {
                    if (maps != bounded) {  // else frames are drawn from it by now
                      maps->scene = scene;
                      if (maps->renderer->reads_light_maps()) {
                        maps->renderer->frames().view().bound(light_map_bytes_);
                      }
                    }
                    bounded = maps;
                    const std::lock_guard lock(mutex_);
                    delivered_ = std::move(maps);
                  });
}

std::shared_ptr<MapGeneration> PhotonFeed::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(delivered_, nullptr);
}

}  // namespace photile::view
