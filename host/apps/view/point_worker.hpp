// Illuminance at clicked points, measured by sensor rays on its own thread.
#pragma once

#include <condition_variable>
#include <glm/glm.hpp>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "photile/scene.hpp"

namespace photile::view {

/// A point on a surface, and what has been read there so far.
struct ClickedPoint {
  int number = 0;            ///< from 1, as it was clicked
  glm::dvec3 position{0.0};  ///< metres in the scene file's world
  glm::dvec3 normal{0.0};    ///< unit, on the side that was seen
  /// Per repeat and layer the irradiance at power 1: linear RGB, lm/m2 or W/m2.
  std::vector<std::vector<glm::vec3>> repeats = {};
};

/// Measures points by unbiased paths from a sensor on the surface (gather_by_paths), the one with
/// fewest repeats first, until each has defaults::clicked_repeats of them.
class PointWorker {
 public:
  explicit PointWorker(std::shared_ptr<const Scene> scene);
  ~PointWorker();

  /// From now on points are those of another scene, in the same world: they are measured anew.
  void use(std::shared_ptr<const Scene> scene);

  /// The number of the new point.
  int add(const glm::dvec3& position, const glm::dvec3& normal);
  void remove(int number);
  std::vector<ClickedPoint> points() const;

 private:
  void work(const std::stop_token& stop);

  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  std::shared_ptr<const Scene> scene_;
  std::vector<ClickedPoint> points_;
  int clicked_ = 0;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace photile::view
