// The options that say where a command measures: levels above the floor of a room.
#pragma once

#include <string>
#include <vector>

#include "measuring/sensor_grid.hpp"
#include "measuring/working_plane.hpp"
#include "photile/defaults.hpp"
#include "photile/progress.hpp"
#include "photile/scene.hpp"

namespace CLI {
class App;
}

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

/// Adds --inside, --wall-band, --spacing, --clearance and --up, in the group
/// Places.
void add_plane_options(CLI::App& command, PlaneOptions& options);

/// What these options say of a level at `height`. Errors: those of parse_working_plane.
measuring::WorkingPlane plane_at(const PlaneOptions& options, const std::string& height);

/// The grid over the floor. Errors: those of parse_working_plane and working_plane_grid.
measuring::SensorGrid plane_of(const PlaneOptions& options, const Scene& scene);

/// Makes points blank that lie inside solids or beyond the walls, and those nearer to furniture
/// than
/// --clearance, and tells how many there are. Errors: UsageError where no point is left.
void clear_of_furniture(const PlaneOptions& options, const Scene& scene,
                        measuring::SensorGrid& grid, Progress& progress);

}  // namespace photile::app
