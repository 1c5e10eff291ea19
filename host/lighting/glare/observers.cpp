#include "glare/observers.hpp"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace photile::glare {

std::vector<Observer> observers_at(const measuring::SensorGrid& points,
                                   const measuring::PlanAxes& axes) {
  std::vector<Observer> observers;
  for (std::size_t i = 0; i < points.sensors.size(); ++i) {
    const Sensor& point = points.sensors[i];
    observers.push_back(Observer::looking(fmt::format("{} {}", points.name, i + 1), point.position,
                                          point.normal, axes.up));
  }
  return observers;
}

std::vector<Observer> observers_on(const measuring::SensorGrid& plane,
                                   const measuring::PlanAxes& axes, int directions) {
  std::vector<Observer> observers;
  for (std::size_t i = 0; i < plane.sensors.size(); ++i) {
    for (int direction = 0; direction < directions; ++direction) {
      const double turn = glm::two_pi<double>() * direction / directions;
      observers.push_back(Observer::looking(
          fmt::format("{} {}, {:g} degrees", plane.name, i + 1, 360.0 * direction / directions),
          plane.sensors[i].position, std::cos(turn) * axes.ahead + std::sin(turn) * axes.right,
          axes.up));
    }
  }
  return observers;
}

}  // namespace photile::glare
