// The options that say where a command measures: levels above the floor of a room.
#pragma once

#include <string>
#include <vector>

#include "measuring/sensor_grid.hpp"
#include "photile/defaults.hpp"
#include "photile/progress.hpp"
#include "photile/scene.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace photile::app {

struct PlaneOptions {
  std::string height;  ///< of the working plane; "" = none
  double wall_band = defaults::wall_band;
  double spacing = 0;  ///< metres; 0 = that of EN 12464-1
  std::string up = "y";
  std::vector<double> inside;  ///< a point in the room; empty = by the camera
  double clearance = 0;        ///< metres; 0 = furniture is not looked for

  int up_axis() const { return up[0] - 'x'; }
};

/// Adds --inside, which needs `plane`, --wall-band, --spacing, --clearance and --up, in the group
/// Places.
void add_plane_options(CLI::App& command, CLI::Option* plane, PlaneOptions& options);

/// The grid over the floor. Errors: those of parse_working_plane and working_plane_grid.
measuring::SensorGrid plane_of(const PlaneOptions& options, const Scene& scene);

/// Leaves out what furniture stands on, where --clearance asks for it, and tells how much that is.
/// Errors: UsageError where no point is left.
void clear_of_furniture(const PlaneOptions& options, const Scene& scene,
                        measuring::SensorGrid& grid, Progress& progress);

}  // namespace photile::app
