#include "view/frame_worker.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>

#include "photile/errors.hpp"

namespace photile::view {

void FrameSize::record(double pixels, double seconds) {
  const double latest = seconds / pixels;
  constexpr double weight = 0.3;  // of the newest frame: steady, and adapted in a few frames
  seconds_per_pixel_ =
      seconds_per_pixel_ > 0 ? (1 - weight) * seconds_per_pixel_ + weight * latest : latest;
}

std::pair<int, int> FrameSize::fit(int width, int height) const {
  if (seconds_per_pixel_ <= 0) return {width, height};
  const double pixels = static_cast<double>(width) * height;
  const double scale = std::clamp(std::sqrt(budget_ / (seconds_per_pixel_ * pixels)), 1.0 / 8, 1.0);
  const auto scaled = [&](int length) {
    return std::max(1, static_cast<int>(std::lround(length * scale)));
  };
  return {scaled(width), scaled(height)};
}

namespace {

/// Seconds that the first picture of a scene may take to have light everywhere.
constexpr double patience = 10;
/// Seconds of a viewer at rest: those of valuing nodes for each second of drawing.
constexpr double filled_over_drawn = 5;
/// Samples of the first whole picture after quick ones, and by how much each has more than the one
/// before: each starts anew.
constexpr int first_samples = 4, more_samples = 4;

}  // namespace

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

/// Whether something else is wanted by now.
bool FrameWorker::outdated(const Task& task) const {
  const std::lock_guard lock(mutex_);
  return task.version != version_;
}

/// Waits until there is something to do. False: the end.
bool FrameWorker::next_task(std::stop_token stop, Task& task) {
  std::unique_lock lock(mutex_);
  const auto has_work = [&] {
    const bool still = maps_ && maps_->whole && !request_.moving && done_samples_ < most_samples_;
    return maps_ && request_.width > 0 && (done_version_ != version_ || lacking_ || still);
  };
  if (!wake_.wait(lock, stop, has_work) || stop.stop_requested()) return false;
  const bool shown = done_version_ == version_;
  const bool refines = !request_.moving && shown && done_samples_ > 0;
  const bool whole = shown && !lacking_ && !request_.moving;
  const bool draws = !request_.powers.empty() && maps_->renderer->draws();
  const int first = draws && !request_.moving ? first_samples : 1;
  task = {request_,
          maps_,
          std::min(refines ? more_samples * done_samples_ : first, most_samples_),
          version_,
          draws && !whole,
          shown};
  return true;
}

/// What a moving viewer's frame leaves of its time, and a little in any case: nodes must come at
/// last. At rest a lamp that was set is shown before anything is filled; after that no frame has to
/// be in time, and drawing what hardly changed would take most of it.
double FrameWorker::time_to_fill(const Task& task) const {
  if (task.request.moving) return std::max(frame_seconds_ - draw_seconds_, 0.25 * frame_seconds_);
  return task.shown ? filled_over_drawn * draw_seconds_ + frame_seconds_ : 0;
}

/// The whole window, however many nodes are missing: new surface is seen coarsely at once, and
/// finer from frame to frame, by what there is time for. The first picture of a scene shows light
/// on all surface, or on as much of it as there is patience for.
std::shared_ptr<const Frame> FrameWorker::draw(const std::stop_token& stop, const Task& task) {
  const Stopwatch stopwatch;
  const FrameRequest& wanted = task.request;
  Frame frame;
  frame.layers.width = wanted.width;
  frame.layers.height = wanted.height;
  frame.mixed.resize(static_cast<std::size_t>(wanted.width) *
                     static_cast<std::size_t>(wanted.height));
  MapGeneration& maps = *task.maps;
  const bool is_first = drawn_scene_ != maps.scene;
  const FrameFilling filling(is_first ? patience : time_to_fill(task), [&] {
    return stop.stop_requested() || (!is_first && !wanted.moving && outdated(task));
  });
  const Stopwatch of_drawing;
  const DrawnFrame drawn = maps.renderer->draw(
      wanted.camera, {wanted.width, wanted.height, 1}, wanted.powers, filling, frame.mixed,
      Progress::none(), maps.coarser ? maps.coarser->renderer.get() : nullptr);
  draw_seconds_ = of_drawing.seconds() - drawn.fill_seconds;
  drawn_scene_ = maps.scene;
  frame.lacking = drawn.lacking_share;
  lacks_nodes_ = drawn.lacking > 0;
  frame.photons = maps.photons;
  frame.scene = maps.scene;
  frame.camera = wanted.camera;
  frame.emitted_photons = maps.emitted_photons;
  frame.noise = maps.noise;
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
  Interruption progress(
      [&] { return stop.stop_requested() || (!task.request.moving && outdated(task)); });
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
  return std::make_shared<Frame>(
      Frame{std::move(result.layers),
            {},
            std::move(reflections),
            task.maps->photons,
            task.maps->scene,
            task.request.camera,
            result.used.film.samples_per_pixel,
            0.0,
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
      task.maps->shown = true;
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
