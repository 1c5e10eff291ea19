// Illuminance at clicked points, measured by sensor rays on its own thread.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "measuring/measurement.hpp"
#include "photile/layered_picture.hpp"
#include "photile/light_layers.hpp"
#include "photile/scene.hpp"

namespace photile::view {

/// A point on a surface, and what has been read there so far.
struct ClickedPoint {
  int number = 0;            ///< from 1, as it was clicked
  glm::dvec3 position{0.0};  ///< metres in the scene file's world
  glm::dvec3 normal{0.0};    ///< unit, on the side that was seen
  /// Per repeat and layer the irradiance at power 1: linear RGB, lm/m2 or W/m2.
  std::vector<std::vector<glm::vec3>> repeats = {};

  /// Lux of each light of a mix, and of all together last, times a factor. Standard errors are from
  /// the scatter of repeats; there are none before the second.
  ///   layers   into which the lights' lux are summed; null = each light's own
  std::vector<Measured> lux(const LightMix& mix, double factor,
                            const LayerMixdown* layers = nullptr) const;
  bool read() const { return repeats.size() >= 2; }
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

/// Lines x y z dx dy dz, as `photile measure --points` reads them.
std::string points_text(const std::vector<ClickedPoint>& points);

/// A line for each point: number, place, normal, lux and standard error of all lights and of each
/// layer.
std::string points_csv(const std::vector<ClickedPoint>& points, const LightMix& mix,
                       const LayerMixdown& layers, double factor);

}  // namespace photile::view
