#include "serve/live_room.hpp"

#include <utility>

#include "common/process_limits.hpp"
#include "photile/errors.hpp"

namespace photile::serve {
namespace {

/// Pixels of the view that light is computed for before a page tells its own.
constexpr int opening_width = 1280, opening_height = 800;

bool is_same(const Camera& a, const Camera& b) {
  return a.position == b.position && a.forward == b.forward &&
         a.vertical_field_of_view == b.vertical_field_of_view;
}

}  // namespace

LiveRoom::LiveRoom(const Scene& scene, view::PhotonWorker::OpenDevices open_devices,
                   LiveRoomParameters parameters)
    : first_scene_(std::shared_ptr<void>(), &scene),
      parameters_(std::move(parameters)),
      points_(first_scene_),
      year_(parameters_.measure_year),
      moods_(parameters_.moods),
      frames_(parameters_.render.film.samples_per_pixel, defaults::view_frames_per_second,
              [this](const Camera& camera, view::MapGeneration& maps, const DrawnFrame& drawn) {
                std::shared_ptr<LiveLight> light;
                {
                  const std::lock_guard lock(mutex_);
                  if (maps.scene == edition_.scene) light = edition_.light;
                }
                if (light) light->take(camera, maps, drawn);
              }),
      photons_(std::move(open_devices), parameters_.light_map_bytes) {
  publish::check_materials(scene);
  edition_.scene = first_scene_;
  edition_.mix = parameters_.mix_of(scene);
  find_presets();
  std::vector<double> powers;
  for (const MixedLight& light : edition_.mix.lights) {
    powers.push_back(edition_.mix.lumens_of(light));
  }
  if (parameters_.white_balance) {
    white_ = parameters_.white ? *parameters_.white : image::white_of_light(powers, edition_.mix);
  }
}

LiveRoom::Edition LiveRoom::made(int number, std::shared_ptr<const Scene> scene) {
  Edition edition{number, std::move(scene), {}, nullptr, {}};
  edition.mix = parameters_.mix_of(*edition.scene);
  edition.light =
      std::make_shared<LiveLight>(*edition.scene, edition.mix.lights.size(), [this] { changed(); });
  ToneMapping display;
  display.view = parameters_.view;
  {
    const std::lock_guard lock(mutex_);
    display.white = white_;
  }
  const Camera opening = parameters_.camera_of(*edition.scene);
  edition.page =
      publish::page_text({.scene = *edition.scene,
                          .opening = opening,
                          .atlas = edition.light->atlas(),
                          .light = nullptr,
                          .edition = number,
                          .mix = edition.mix,
                          .node_errors = nullptr,
                          .presets = {},
                          .hours = publish::sky_hours(edition.mix, parameters_.situation),
                          .display = display,
                          .title = parameters_.title,
                          .version = parameters_.version});
  return edition;
}

void LiveRoom::make_page() {
  Edition edition = made(1, first_scene_);
  lower_priority();  // a browser without a graphics chip draws on the same cores
  // The room is seen before its light is computed, which takes all cores.
  const std::lock_guard lock(mutex_);
  photons_.trace(first_scene_, parameters_.render,
                 std::exchange(parameters_.prepared, std::nullopt), parameters_.keep);
  edition_ = std::move(edition);
  moods_number_ = 1;
  if (shown_.empty()) {  // light for the first page, before it tells where it looks
    frames_.show({.camera = parameters_.camera_of(*first_scene_),
                  .width = opening_width,
                  .height = opening_height,
                  .powers = view::scales_of(edition_.mix)});
  }
  ++changes_;
  news_.notify_all();
}

/// Has photons traced in a scene that was loaded again.
void LiveRoom::take_scene() {
  if (!parameters_.luminaires) return;
  try {
    std::unique_lock lock(mutex_);
    const std::shared_ptr<const Scene> scene = parameters_.luminaires->take_scene();
    lock.unlock();
    if (!scene) return;
    publish::check_materials(*scene);
    next_ = made((next_ ? next_->number : edition_.number) + 1, scene);
  } catch (const Error& error) {
    return tell(error.what());
  }
  retrace();
}

/// By the newest settings.
void LiveRoom::retrace() {
  std::unique_lock lock(mutex_);
  const RenderParameters parameters = parameters_.render;
  settings_changed_ = false;
  lock.unlock();
  photons_.trace(next_ ? next_->scene : edition_.scene, parameters, std::nullopt, {});
}

/// Another scene is shown from its first maps on; until then, the last is.
void LiveRoom::take_maps() {
  std::shared_ptr<view::MapGeneration> maps = photons_.take();
  if (!maps) return;
  if (!maps->renderer->reads_light_maps()) {
    constexpr const char* problem = "the live page needs light maps; choose maps other than naive";
    if (!seen_) throw UsageError(problem);
    return tell(problem);
  }
  const std::lock_guard lock(mutex_);
  if (!next_ || maps->scene != next_->scene) {
    for (auto& [name, viewer] : viewers_) viewer.done = viewer.request.moving;
    frames_.use(std::move(maps));
    return;
  }
  const auto looking = viewers_.find(shown_);
  view::FrameRequest request;
  if (looking != viewers_.end()) request = looking->second.request;
  edition_ = *std::exchange(next_, std::nullopt);
  if (request.width == 0) {
    request = {parameters_.camera_of(*edition_.scene), opening_width, opening_height};
  }
  request.moving = true;  // no exact picture before pages show the new scene
  request.powers = view::scales_of(edition_.mix);
  request.mixdown = nullptr;
  frames_.use(std::move(maps), &request);
  points_.use(edition_.scene);
  find_presets();
  ++moods_number_;
  shown_.clear();
  frame_ = nullptr;
  white_is_known_ = false;
  ++changes_;
  news_.notify_all();
}

void LiveRoom::tell(std::string problem) {
  const std::lock_guard lock(mutex_);
  message_ = std::move(problem);
  ++changes_;
}

void LiveRoom::changed() {
  const std::lock_guard lock(mutex_);
  ++changes_;
  news_.notify_all();
}

void LiveRoom::step() {
  take_scene();
  if (settings_changed_) retrace();
  take_maps();
  take_errors();
  const std::lock_guard lock(mutex_);
  take_frame();
  const auto current = viewers_.find(shown_);
  if (current != viewers_.end() && !current->second.done) return;
  for (auto& [name, viewer] : viewers_) {
    if (viewer.edition != edition_.number) continue;
    if (!viewer.done && viewer.request.width > 0) return show(name);
  }
}

/// Makes frames for a viewer from now on.
void LiveRoom::show(const std::string& viewer) {
  shown_ = viewer;
  frames_.show(viewers_[viewer].request);
}

void LiveRoom::take_frame() {
  const std::shared_ptr<const view::Frame> latest = frames_.latest();
  if (!latest || latest == frame_ || latest->scene != edition_.scene) return;
  frame_ = latest;
  seen_ = true;
  ++changes_;
  news_.notify_all();
  const auto found = viewers_.find(shown_);
  if (found == viewers_.end() || !latest->mixed.empty()) return;
  Viewer& viewer = found->second;
  const view::FrameRequest& asked = viewer.request;
  if (asked.moving || !is_same(asked.camera, latest->camera) ||
      asked.width != latest->layers.width || asked.height != latest->layers.height) {
    return;
  }
  viewer.picture = latest;
  ++viewer.picture_number;
  viewer.done = latest->samples_per_pixel >= parameters_.render.film.samples_per_pixel;
  if (white_is_known_ || asked.mixdown) return;
  white_is_known_ = true;
  if (parameters_.white || !parameters_.white_balance) return;
  white_ =
      image::white_of(latest->layers, LightMix::of(*edition_.scene, edition_.mix.lumen_per_watt));
}

void LiveRoom::take_errors() {
  for (const std::exception_ptr& error : {photons_.take_error(), frames_.take_error()}) {
    if (!error) continue;
    if (!seen_) std::rethrow_exception(error);
    try {
      std::rethrow_exception(error);
    } catch (const std::exception& told) {
      tell(told.what());
    }
  }
}

double LiveRoom::left_alone() const {
  const std::lock_guard lock(mutex_);
  return visited_ && viewers_.empty() ? since_left_.seconds() : 0.0;
}

void LiveRoom::finish(const std::function<void(const LightMapContents&)>& keep) {
  photons_.stop();
  const std::shared_ptr<view::MapGeneration> maps = frames_.stop();
  if (!keep || !maps || !maps->whole || maps->scene != first_scene_ || !traced_as_asked_) return;
  if (const auto contents = maps->renderer->light_map_contents()) keep(*contents);
}

}  // namespace photile::serve
