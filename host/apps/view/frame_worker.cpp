#include "view/frame_worker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/stoppable_progress.hpp"
#include "photile/errors.hpp"

namespace photile::view {

namespace {

/// Seconds of a viewer at rest: those of valuing nodes for each second of drawing.
constexpr double filled_over_drawn = 5;
/// Pixels of a quick frame, whose rays find the nodes that are needed, and of one at rest once all
/// photons are there: then small things are to be found, too.
constexpr double quick_pixels = 64'000, pixels_at_rest = 256'000;
/// Samples of the first whole picture after quick ones, and by how much each has more than the one
/// before: each starts anew.
constexpr int first_samples = 4, more_samples = 4;

Film quick_film(const FrameRequest& request, bool whole) {
  const double pixels = static_cast<double>(request.width) * request.height;
  const double most = request.moving || !whole ? quick_pixels : pixels_at_rest;
  const double side = std::min(1.0, std::sqrt(most / pixels));
  return {static_cast<int>(std::ceil(side * request.width)),
          static_cast<int>(std::ceil(side * request.height)), 1};
}

}  // namespace

void write_frame(const std::filesystem::path& file, const Scene& scene, const Frame& frame,
                 const LightMix& mix, const image::White& white) {
  const auto picture = mixed_picture(frame.layers, mix);
  set_camera_attributes(picture->header(), in_world(scene, frame.camera), frame.layers.width,
                        frame.layers.height);
  image::keep_white(picture->header(), white);
  write_exr(file, *picture);
}

std::vector<glm::vec3> scales_of(const LightMix& mix) {
  std::vector<glm::vec3> scales;
  for (const MixedLight& light : mix.lights) {
    scales.emplace_back(mix.power_in_picture(light) * glm::dvec3(light.tint));
  }
  return scales;
}

FrameWorker::FrameWorker(int most_samples, double frames_per_second, Drawn drawn)
    : most_samples_(most_samples),
      drawn_(std::move(drawn)),
      frame_seconds_(1 / frames_per_second),
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

void FrameWorker::use(std::shared_ptr<MapGeneration> maps, const FrameRequest* request) {
  const std::lock_guard lock(mutex_);
  maps_ = std::move(maps);
  if (request) request_ = *request;
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

/// Whether something else is requested by now.
bool FrameWorker::outdated(const Task& task) const {
  const std::lock_guard lock(mutex_);
  return task.version != version_;
}

/// Waits until there is something to do. False: the end.
bool FrameWorker::next_task(std::stop_token stop, Task& task) {
  std::unique_lock lock(mutex_);
  const auto has_work = [&] {
    const bool still = maps_ && maps_->whole && !request_.moving && done_samples_ < most_samples_;
    return maps_ && request_.width > 0 && (done_version_ != version_ || still);
  };
  if (!wake_.wait(lock, stop, has_work) || stop.stop_requested()) return false;
  const bool shown = done_version_ == version_;
  const bool refines = !request_.moving && shown && done_samples_ > 0;
  const bool whole = shown && !request_.moving;
  const bool draws = !request_.powers.empty() && maps_->renderer->reads_light_maps();
  const int first = draws && !request_.moving ? first_samples : 1;
  task = {request_, maps_, std::min(refines ? more_samples * done_samples_ : first, most_samples_),
          version_, draws && !whole};
  return true;
}

/// Seconds of valuing nodes until the next frame: what a moving viewer's frame leaves of its time,
/// and a little in any case: nodes must come at last. At rest no frame has to be in time, and
/// drawing a picture that hardly changed would take most of it.
double FrameWorker::time_to_fill(const Task& task, double draw_seconds) const {
  if (task.request.moving) return std::max(frame_seconds_ - draw_seconds, 0.25 * frame_seconds_);
  return filled_over_drawn * draw_seconds + frame_seconds_;
}

/// Draws the whole picture, however many nodes are missing: new surface is seen coarsely at once,
/// and finer from frame to frame, by what there is time for. Frames are handed over as they get
/// better, until no node is missing or something else is requested.
void FrameWorker::draw(const std::stop_token& stop, const Task& task) {
  const FrameRequest& requested = task.request;
  MapGeneration& maps = *task.maps;
  bool at_once = requested.moving;
  const Film film = quick_film(requested, maps.whole);
  std::vector<glm::vec3> picture(static_cast<std::size_t>(film.width) *
                                 static_cast<std::size_t>(film.height));
  const auto hand_over = [&](const DrawnFrame& drawn) {
    Frame frame;
    frame.layers.width = requested.width;
    frame.layers.height = requested.height;
    frame.mixed = picture;
    frame.lacking = drawn.lacking_fraction;
    frame.photons = maps.photons;
    frame.scene = maps.scene;
    frame.camera = requested.camera;
    frame.emitted_photons = maps.emitted_photons;
    if (drawn.empty == 0) maps.lit = true;
    keep(task, std::make_shared<Frame>(std::move(frame)), 0);
    if (drawn_) drawn_(requested.camera, maps, drawn);
    at_once = false;
    draw_seconds_ = drawn.draw_seconds;
    return time_to_fill(task, draw_seconds_);
  };
  const auto ended = [&] { return stop.stop_requested() || (!at_once && outdated(task)); };
  FrameFilling filling(requested.moving ? time_to_fill(task, draw_seconds_) : 0.0, ended,
                       hand_over);
  filling.soft = !maps.whole;
  const DrawnFrame drawn =
      maps.renderer->frames().draw(requested.camera, film, requested.powers, filling, picture,
                                   Progress::none(), maps.coarser_view());
  if (ended()) throw Interrupted();
  hand_over(drawn);
}

std::shared_ptr<const Frame> FrameWorker::render(const std::stop_token& stop, const Task& task) {
  Film film;
  film.width = task.request.width;
  film.height = task.request.height;
  film.samples_per_pixel = task.samples;
  // Requests while the viewer moves would otherwise let no frame end.
  StoppableProgress progress(Progress::none(), [&] {
    return stop.stop_requested() || (!task.request.moving && outdated(task));
  });
  const LayerMixdown* const mixdown = task.request.mixdown.get();
  RenderResult result =
      task.maps->renderer->render(camera_hits(task.request.camera), film, progress, mixdown);
  std::optional<LightLayers> reflections;
  if (task.request.reflections) {
    reflections = std::move(
        task.maps->renderer->render(reflected_hits(task.request.camera), film, progress, mixdown)
            .layers);
  }
  return std::make_shared<Frame>(Frame{std::move(result.layers),
                                       {},
                                       std::move(reflections),
                                       task.maps->photons,
                                       task.maps->scene,
                                       task.request.camera,
                                       result.used.film.samples_per_pixel,
                                       0.0,
                                       task.maps->emitted_photons});
}

/// The result for callers of latest().
void FrameWorker::keep(const Task& task, std::shared_ptr<const Frame> frame, int samples) {
  const std::lock_guard lock(mutex_);
  latest_ = std::move(frame);
  done_version_ = task.version;
  done_samples_ = samples;
}

void FrameWorker::work(std::stop_token stop) {
  Task task;
  while (next_task(stop, task)) {
    try {
      if (task.quick) {
        draw(stop, task);
      } else {
        keep(task, render(stop, task), task.request.moving ? 0 : task.samples);
        task.maps->lit = true;
      }
    } catch (const Interrupted&) {
      // Something else is requested by now.
    } catch (...) {
      const std::lock_guard lock(mutex_);
      error_ = std::current_exception();
      return;
    }
  }
}

}  // namespace photile::view
