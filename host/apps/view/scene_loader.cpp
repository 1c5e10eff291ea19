#include "view/scene_loader.hpp"

#include <utility>

#include "photile/defaults.hpp"

namespace photile::view {

SceneLoader::SceneLoader(std::filesystem::path scene, SceneLoadOptions options)
    : scene_(std::move(scene)),
      options_(std::move(options)),
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

SceneLoader::~SceneLoader() {
  thread_.request_stop();
  wake_.notify_all();
}

void SceneLoader::load(const std::string& luminaires) {
  const std::lock_guard lock(mutex_);
  requested_ = luminaires;
  loaded_.reset();
  error_ = nullptr;
  wake_.notify_all();
}

std::optional<SceneLoader::Loaded> SceneLoader::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(loaded_, std::nullopt);
}

std::exception_ptr SceneLoader::take_error() {
  const std::lock_guard lock(mutex_);
  return std::exchange(error_, nullptr);
}

bool SceneLoader::busy() const {
  const std::lock_guard lock(mutex_);
  return requested_ || loading_;
}

void SceneLoader::work(const std::stop_token& stop) {
  while (true) {
    {
      std::unique_lock lock(mutex_);
      loading_ = false;
      if (!wake_.wait(lock, stop, [&] { return requested_.has_value(); })) return;
      if (stop.stop_requested()) return;
      options_.luminaires_text = *std::exchange(requested_, std::nullopt);
      loading_ = true;
    }
    std::shared_ptr<const loading::SourcedScene> scene;
    std::exception_ptr error;
    try {
      scene = std::make_shared<const loading::SourcedScene>(
          loading::load_sourced_scene(scene_, options_));
    } catch (...) {
      error = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    if (requested_) continue;
    if (scene) loaded_ = Loaded{options_.luminaires_text, std::move(scene)};
    error_ = error;
  }
}

SkySituation take_moving_sky(SceneLoadOptions& options) {
  SkySituation& situation = options.situation;
  const bool placed = situation.site || !situation.weather.empty();
  const bool asked = options.sky ? options.sky->kind == SkyKind::patches : placed;
  if (!asked || options.sun || (situation.time && !placed)) return {};
  if (!placed) {  // nothing moves its patches: they are one line of the lights
    for (const char* const glob : {"sky_[0-9]*", "ground"}) {
      options.light_groups.insert(options.light_groups.begin(), {glob, "sky"});
    }
  }
  if (!options.sky) options.sky = Sky{SkyKind::patches, 0, 0, 0, defaults::view_sky_patches};
  SkySituation taken;
  taken.north_degrees = situation.north_degrees;  // the patches know it
  std::swap(taken, situation);
  return taken;
}

}  // namespace photile::view
