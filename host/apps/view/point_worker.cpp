#include "view/point_worker.hpp"

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <span>
#include <utility>

#include "photile/defaults.hpp"
#include "photile/sensors.hpp"
#include "trace/random_stream.hpp"

namespace photile::view {

PointWorker::PointWorker(std::shared_ptr<const Scene> scene)
    : scene_(std::move(scene)), thread_([this](const std::stop_token& stop) { work(stop); }) {}

PointWorker::~PointWorker() {
  thread_.request_stop();
  wake_.notify_all();
}

void PointWorker::use(std::shared_ptr<const Scene> scene) {
  const std::lock_guard lock(mutex_);
  scene_ = std::move(scene);
  for (ClickedPoint& point : points_) point.repeats.clear();
  wake_.notify_all();
}

int PointWorker::add(const glm::dvec3& position, const glm::dvec3& normal) {
  const std::lock_guard lock(mutex_);
  points_.push_back({++clicked_, position, normal});
  wake_.notify_all();
  return clicked_;
}

void PointWorker::remove(int number) {
  const std::lock_guard lock(mutex_);
  std::erase_if(points_, [&](const ClickedPoint& point) { return point.number == number; });
}

std::vector<ClickedPoint> PointWorker::points() const {
  const std::lock_guard lock(mutex_);
  return points_;
}

void PointWorker::work(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    ClickedPoint next;
    std::shared_ptr<const Scene> scene;
    {
      std::unique_lock lock(mutex_);
      const auto lacking = [&] {
        return std::min_element(points_.begin(), points_.end(), [](const auto& a, const auto& b) {
          return a.repeats.size() < b.repeats.size();
        });
      };
      wake_.wait(lock, stop, [&] {
        const auto point = lacking();
        return point != points_.end() && point->repeats.size() < defaults::clicked_repeats;
      });
      if (stop.stop_requested()) return;
      next = *lacking();
      scene = scene_;
    }
    const Sensor sensor = in_scene(*scene, {next.position, next.normal});
    const std::uint64_t seed =
        trace::seed_of_repeat(defaults::seed, static_cast<std::uint32_t>(1000 * next.number) +
                                                  static_cast<std::uint32_t>(next.repeats.size()));
    const LightLayers layers =
        gather_by_paths(*scene, std::span(&sensor, 1), {.rays = defaults::clicked_rays}, seed)
            .layers.dense();
    std::vector<glm::vec3> irradiance;
    for (const auto& layer : layers.layers) {
      irradiance.push_back(glm::pi<float>() * layer.radiance.front());
    }
    const std::lock_guard lock(mutex_);
    if (scene != scene_) continue;
    for (ClickedPoint& point : points_) {
      if (point.number == next.number) point.repeats.push_back(std::move(irradiance));
    }
  }
}

}  // namespace photile::view
