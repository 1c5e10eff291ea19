#include "view/frame_worker.hpp"

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
      frame_seconds_(1 / frames_per_second),
      size_(frames_per_second),
      thread_([this](std::stop_token stop) { work(std::move(stop)); }) {}

FrameWorker::~FrameWorker() { stop(); }

std::shared_ptr<MapGeneration> FrameWorker::stop() {
  thread_.request_stop();
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
  return maps_;
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

void FrameWorker::use(std::shared_ptr<MapGeneration> maps, const FrameRequest& request) {
  const std::lock_guard lock(mutex_);
  maps_ = std::move(maps);
  request_ = request;
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
    return maps_ && request_.width > 0 && (done_version_ != version_ || lacking_ || still);
  };
  if (!wake_.wait(lock, stop, has_work) || stop.stop_requested()) return false;
  const bool shown = done_version_ == version_;
  const bool refines = !request_.moving && shown && done_samples_ > 0;
  const bool whole = shown && !lacking_ && !request_.moving;
  task = {request_, maps_, refines ? std::min(2 * done_samples_, most_samples_) : 1, version_,
          !request_.powers.empty() && !whole && maps_->renderer->draws()};
  return true;
}

/// What a frame leaves of its time, and a little in any case: nodes must come at last. At rest no
/// frame has to be in time, and drawing what hardly changed would take most of it: nodes that
/// gather are dear.
double FrameWorker::time_to_fill(bool moving) const {
  const double least = 0.25 * frame_seconds_;
  return std::max(frame_seconds_ - draw_seconds_, moving ? least : 2 * draw_seconds_ + least);
}

/// The whole window, however many nodes are missing: new surface is seen coarsely at once, and
/// finer from frame to frame, by what there is time for. New maps are seen once they show all
/// surface.
std::shared_ptr<const Frame> FrameWorker::draw(const std::stop_token& stop, const Task& task) {
  const Stopwatch stopwatch;
  const FrameRequest& wanted = task.request;
  Frame frame;
  frame.layers.width = wanted.width;
  frame.layers.height = wanted.height;
  frame.mixed.resize(static_cast<std::size_t>(wanted.width) *
                     static_cast<std::size_t>(wanted.height));
  const auto draw_from = [&](MapGeneration& maps, double fill_seconds) {
    const Stopwatch of_drawing;
    const Film film{wanted.width, wanted.height, 1};
    const DrawnFrame drawn =
        maps.renderer->draw(wanted.camera, film, wanted.powers, fill_seconds, frame.mixed);
    draw_seconds_ = of_drawing.seconds() - drawn.fill_seconds;
    return drawn;
  };
  if (drawn_maps_ && drawn_maps_->scene != task.maps->scene) drawn_maps_ = nullptr;
  DrawnFrame drawn = draw_from(*task.maps, time_to_fill(wanted.moving));
  std::shared_ptr<MapGeneration> maps = task.maps;
  if (drawn.empty > 0 && drawn_maps_ && drawn_maps_ != task.maps) {
    maps = drawn_maps_;
    draw_from(*maps, 0);
  }
  while (drawn.empty > 0 && !drawn_maps_ && !stop.stop_requested()) {  // the first picture
    drawn = draw_from(*maps, time_to_fill(wanted.moving));
  }
  drawn_maps_ = maps;
  lacks_nodes_ = drawn.lacking > 0;
  frame.photons = maps->photons;
  frame.scene = maps->scene;
  frame.camera = wanted.camera;
  frame.emitted_photons = maps->emitted_photons;
  frame.noise = maps->noise;
  frame.seconds = stopwatch.seconds();
  return std::make_shared<Frame>(std::move(frame));
}

std::shared_ptr<const Frame> FrameWorker::render(const std::stop_token& stop, const Task& task) {
  lacks_nodes_ = false;
  if (task.quick) return draw(stop, task);
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
  const LightPooling* const pooling = task.request.pooling.get();
  RenderResult result = task.maps->renderer->render(task.request.camera, film, progress, pooling);
  std::optional<LightLayers> reflections;
  if (task.request.reflections) {
    reflections = std::move(
        task.maps->renderer->render_reflections(task.request.camera, film, progress, pooling)
            .layers);
  }
  const double seconds = stopwatch.seconds();
  // The first frame of maps waits for kernels to be compiled.
  if (std::exchange(timed_maps_, task.maps.get()) == task.maps.get()) {
    size_.record(static_cast<double>(film.width) * film.height * task.samples, seconds);
  }
  drawn_maps_ = task.maps;
  return std::make_shared<Frame>(
      Frame{std::move(result.layers),
            {},
            std::move(reflections),
            task.maps->photons,
            task.maps->scene,
            task.request.camera,
            result.used.film.samples_per_pixel,
            task.maps->emitted_photons,
            pooling ? task.maps->noise.pooled(*pooling) : task.maps->noise,
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
      done_samples_ = task.request.moving || task.quick ? 0 : task.samples;
      lacking_ = lacks_nodes_;
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
