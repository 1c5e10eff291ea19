// Where a command measures, and by how many rays.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "glare/measure_glare.hpp"
#include "measuring/measurement.hpp"
#include "measuring/sensor_grid.hpp"
#include "measuring/working_plane.hpp"
#include "photile/defaults.hpp"
#include "photile/progress.hpp"
#include "photile/scene.hpp"

namespace CLI {
class App;
}

namespace photile::app {

class OptionGroup;

struct PlaneOptions {
  std::string height;  ///< of the working plane; "" = none
  double wall_band = defaults::wall_band;
  double spacing = 0;          ///< metres; 0 = that of EN 12464-1
  std::vector<double> inside;  ///< a point in the room; empty = by the camera
  double clearance = 0;        ///< metres from furniture; 0 = none
};

/// Positions of sensors.
struct PlaceOptions {
  std::vector<std::string> planes, points;  ///< files
  PlaneOptions plane;

  bool empty() const { return planes.empty() && points.empty() && plane.height.empty(); }
};

/// Adds --inside, --wall-band, --spacing and --clearance.
void add_plane_options(const OptionGroup& places, PlaneOptions& options);

/// Adds --grid, --points, --plane and those of add_plane_options.
void add_place_options(CLI::App& command, PlaceOptions& options);

/// Notes the files that will be read. Errors: those of note_input.
void note_places(const PlaceOptions& options);

/// The grids of the files, and the working plane's. Errors: those of the readers and of plane_of.
std::vector<measuring::SensorGrid> grids_at(const PlaceOptions& options, const Scene& scene);

/// The plane that these options describe, at `height`. Errors: those of parse_working_plane.
measuring::WorkingPlane plane_at(const PlaneOptions& options, const std::string& height);

/// The grid over the floor. Errors: those of parse_working_plane and working_plane_grid.
measuring::SensorGrid plane_of(const PlaneOptions& options, const Scene& scene);

/// Makes points blank that lie inside solids or beyond the walls, and those nearer to furniture
/// than --clearance, and prints how many there are. Returns how many are left of all grids. Errors:
/// UsageError where no point of a grid is left.
std::size_t clear_of_furniture(const PlaneOptions& options, const Scene& scene,
                               std::span<measuring::SensorGrid> grids, Progress& progress);

/// People whose glare is rated.
struct ObserverOptions {
  std::vector<std::string> files;               ///< of points that face where they look
  std::string height;                           ///< of eyes over the floor; "" = none
  int directions = defaults::glare_directions;  ///< at each point over the floor

  bool empty() const { return files.empty() && height.empty(); }
};

/// Adds --observers.
void add_observers_option(const OptionGroup& places, ObserverOptions& options);

/// Those of the files, and those over the floor.
///   plane   becomes that of the latter
/// Errors: those of read_points and plane_of; UsageError where no point over the floor is free.
std::vector<glare::Observer> observers_at(const ObserverOptions& options, PlaneOptions floor,
                                          const Scene& scene,
                                          std::optional<measuring::PlaneLayout>& plane,
                                          Progress& progress);

/// Adds --rays and --repeats.
void add_sensor_options(const OptionGroup& group, MeasuringParameters& parameters);

/// Adds --maintenance: a factor, or its parts by the names of CIE 97, whose product it is.
///   parts   becomes these, "LLMF 0.9 x LMF 0.95", where they are given; null = not needed
void add_maintenance_option(const OptionGroup& group, MeasuringParameters& parameters,
                            std::string* parts = nullptr);

}  // namespace photile::app
