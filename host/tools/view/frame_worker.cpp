#include "tools/view/frame_worker.hpp"

#include <algorithm>
#include <functional>
#include <tuple>
#include <utility>

#include "photile/errors.hpp"

namespace photile::view {

/// Ends a frame that nobody waits for any longer.
class FrameWorker::Interruption : public Progress {
 public:
  explicit Interruption(std::function<bool()> outdated) : outdated_(std::move(outdated)) {}
  bool cancelled() const override { return outdated_(); }

 private:
  std::function<bool()> outdated_;
};

FrameWorker::FrameWorker(int most_samples, double frames_per_second)
    : most_samples_(most_samples),
      size_(frames_per_second),
      thread_([this](std::stop_token stop) { work(std::move(stop)); }) {}

FrameWorker::~FrameWorker() {
  thread_.request_stop();
  wake_.notify_all();
}

void FrameWorker::show(const FrameRequest& request) {
  const std::lock_guard lock(mutex_);
  request_ = request;
  ++version_;
  wake_.notify_all();
}

void FrameWorker::use(std::shared_ptr<MapGeneration> maps) {
  const std::lock_guard lock(mutex_);
  maps_ = std::move(maps);
  ++version_;
  wake_.notify_all();
}

std::shared_ptr<const Frame> FrameWorker::latest() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

bool FrameWorker::finished() const {
  const std::lock_guard lock(mutex_);
  return latest_ && done_version_ == version_ && done_samples_ >= most_samples_;
}

std::exception_ptr FrameWorker::take_error() {
  const std::lock_guard lock(mutex_);
  return std::exchange(error_, nullptr);
}

/// Waits until there is something to do. False: the end.
bool FrameWorker::next_task(std::stop_token stop, Task& task) {
  std::unique_lock lock(mutex_);
  const auto has_work = [&] {
    const bool still = !request_.moving && done_samples_ < most_samples_;
    return maps_ && request_.width > 0 && (done_version_ != version_ || still);
  };
  if (!wake_.wait(lock, stop, has_work) || stop.stop_requested()) return false;
  const bool refines = !request_.moving && done_version_ == version_ && done_samples_ > 0;
  task = {request_, maps_, refines ? std::min(2 * done_samples_, most_samples_) : 1, version_};
  return true;
}

/// The whole window, however many nodes are missing: a level of them is valued for each frame, so
/// that new surface is seen coarsely at once, and the rate does not drop for long.
std::shared_ptr<const Frame> FrameWorker::draw(const Task& task) {
  const Stopwatch stopwatch;
  Frame frame;
  frame.layers.width = task.request.width;
  frame.layers.height = task.request.height;
  frame.mixed.resize(static_cast<std::size_t>(frame.layers.width) *
                     static_cast<std::size_t>(frame.layers.height));
  task.maps->renderer->draw(task.request.camera, frame.layers.width, frame.layers.height,
                            task.request.powers, 1, frame.mixed);
  frame.photons = task.maps->photons;
  frame.camera = task.request.camera;
  frame.emitted_photons = task.maps->emitted_photons;
  frame.noise = task.maps->noise;
  frame.seconds = stopwatch.seconds();
  return std::make_shared<Frame>(std::move(frame));
}

std::shared_ptr<const Frame> FrameWorker::render(const std::stop_token& stop, const Task& task) {
  if (task.request.moving && !task.request.powers.empty() && task.maps->renderer->draws()) {
    return draw(task);
  }
  Film film;
  film.width = task.request.width;
  film.height = task.request.height;
  if (task.request.moving) std::tie(film.width, film.height) = size_.fit(film.width, film.height);
  film.samples_per_pixel = task.samples;
  // What is asked for while the viewer moves would end no frame at all.
  Interruption progress([&] {
    const std::lock_guard lock(mutex_);
    return stop.stop_requested() || (!task.request.moving && task.version != version_);
  });
  const Stopwatch stopwatch;
  RenderResult result = task.maps->renderer->render(task.request.camera, film, progress);
  std::optional<LightLayers> reflections;
  if (task.request.reflections) {
    reflections = std::move(
        task.maps->renderer->render_reflections(task.request.camera, film, progress).layers);
  }
  const double seconds = stopwatch.seconds();
  // The first frame of maps waits for kernels to be compiled.
  if (std::exchange(timed_maps_, task.maps.get()) == task.maps.get()) {
    size_.record(static_cast<double>(film.width) * film.height * task.samples, seconds);
  }
  return std::make_shared<Frame>(Frame{std::move(result.layers),
                                       {},
                                       std::move(reflections),
                                       task.maps->photons,
                                       task.request.camera,
                                       result.used.film.samples_per_pixel,
                                       task.maps->emitted_photons,
                                       task.maps->noise,
                                       seconds,
                                       std::move(result.statistics)});
}

void FrameWorker::work(std::stop_token stop) {
  Task task;
  while (next_task(stop, task)) {
    try {
      std::shared_ptr<const Frame> frame = render(stop, task);
      const std::lock_guard lock(mutex_);
      latest_ = std::move(frame);
      done_version_ = task.version;
      done_samples_ = task.request.moving ? 0 : task.samples;
    } catch (const Interrupted&) {
      // Something else is wanted by now.
    } catch (...) {
      const std::lock_guard lock(mutex_);
      error_ = std::current_exception();
      return;
    }
  }
}

}  // namespace photile::view
