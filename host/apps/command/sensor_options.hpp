// Where a command measures, and by how many rays.
#pragma once

#include <string>
#include <vector>

#include "glare/measure_glare.hpp"
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

/// Where a command measures.
struct PlaceOptions : measuring::Places {
  PlaceOptions() { layout.wall_band = defaults::wall_band; }

  std::vector<double> inside;  ///< a point in the room; empty = by the camera
  std::string room_names;      ///< a glob; "" = the one room that the above tells
};

/// Adds --inside, --rooms, --wall-band, --spacing and --clearance.
void add_plane_options(const OptionGroup& places, PlaceOptions& options);

/// Adds --grid, --points, --plane and those of add_plane_options.
void add_place_options(CLI::App& command, PlaceOptions& options);

/// Notes the files that will be read. Errors: those of note_input.
void note_places(const PlaceOptions& options);

/// Looks for the rooms that the options name. Errors: those of rooms_named.
void find_rooms(PlaceOptions& options, const Scene& scene);

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
///   floor   the rooms of the latter
///   plane   becomes that of the latter where they are in one room
/// Errors: those of the readers and of working_plane_grid; UsageError where no point over the floor
/// is free.
std::vector<glare::Observer> observers_at(const ObserverOptions& options, const PlaceOptions& floor,
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
