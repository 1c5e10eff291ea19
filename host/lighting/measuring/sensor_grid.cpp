#include "measuring/sensor_grid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "photile/scene.hpp"

namespace photile::measuring {
namespace {

int whole(double count) { return static_cast<int>(std::clamp(std::round(count), 1.0, 1e6)); }

}  // namespace

glm::dvec3 PlaneLayout::middle_of(std::uint32_t cell) const {
  const auto column = static_cast<double>(cell % static_cast<std::uint32_t>(columns));
  const auto row = static_cast<double>(cell / static_cast<std::uint32_t>(columns));
  return origin + (column + 0.5) / columns * u + (row + 0.5) / rows * v;
}

PlaneLayout in_world(const Scene& scene, PlaneLayout layout) {
  layout.origin = place_in_world(scene, layout.origin);
  layout.u = direction_in_world(scene, layout.u);
  layout.v = direction_in_world(scene, layout.v);
  return layout;
}

PlaneLayout in_scene(const Scene& scene, PlaneLayout layout) {
  layout.origin = place_in_scene(scene, layout.origin);
  layout.u = direction_in_scene(scene, layout.u);
  layout.v = direction_in_scene(scene, layout.v);
  return layout;
}

SensorGrid grid_on_plane(const std::string& name, PlaneLayout layout) {
  SensorGrid grid{name, {}, {}};
  const glm::dvec3 normal = layout.normal() + 0.0;  // no -0 in tables
  for (const std::uint32_t cell : layout.cells) {
    grid.sensors.push_back({layout.middle_of(cell), normal});
  }
  grid.layout = std::move(layout);
  return grid;
}

PointCounts points_of_en12464(double u, double v) {
  const double longer = std::max(u, v), shorter = std::min(u, v);
  const double d = longer >= 2 * shorter ? shorter : longer;
  const double spacing = std::min(10.0, 0.2 * std::pow(5.0, std::log10(d)));
  const double resulting = d / whole(d / spacing);
  return {whole(u / resulting), whole(v / resulting)};
}

}  // namespace photile::measuring
