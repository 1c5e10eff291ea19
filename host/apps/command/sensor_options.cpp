#include "command/sensor_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <sstream>

#include "command/option_group.hpp"
#include "common/files.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile::app {

void add_plane_options(const OptionGroup& places, PlaceOptions& options) {
  CLI::Option* const inside = places
                                  .add("--inside", options.inside, "X,Y,Z",
                                       "point in the room; default: the first camera's room")
                                  ->delimiter(',')
                                  ->expected(3);
  places
      .add("--rooms", options.room_names, "GLOB",
           "rooms by name, as photile info lists them; * = all")
      ->excludes(inside);
  places
      .add("--wall-band", options.layout.wall_band, "M", "width left out along the walls, m",
           number_between(0, limits::max_coordinate))
      ->capture_default_str();
  places.add("--spacing", options.layout.spacing, "M",
             "distance between points, m; default: that of EN 12464-1", positive_number());
  places.add("--clearance", options.clearance, "M",
             "leave out points with a surface less than M metres in front of or behind them",
             positive_number());
}

void add_place_options(CLI::App& command, PlaceOptions& options) {
  const OptionGroup places(command, "Places");
  places.repeat("--grid", options.planes, "FILE", "planes of points as JSON; repeatable");
  places.repeat("--points", options.points, "FILE",
                "points in the format of Radiance and Honeybee; repeatable");
  places.add("--plane", options.plane, "HEIGHT",
             "grid of EN 12464-1 over the floor: floor+0.75, or a height in metres");
  add_plane_options(places, options);
}

void note_places(const PlaceOptions& options) {
  for (const auto& file : options.planes) note_input(file);
  for (const auto& file : options.points) note_input(file);
}

void find_rooms(PlaceOptions& options, const Scene& scene) {
  if (!options.inside.empty()) {
    options.layout.inside = glm::dvec3(options.inside[0], options.inside[1], options.inside[2]);
  }
  if (!options.room_names.empty()) {
    options.rooms = measuring::rooms_named(scene, options.room_names);
    options.layout.inside = options.rooms.front().inside;
  }
}

void add_observers_option(const OptionGroup& places, ObserverOptions& options) {
  places.repeat(
      "--observers", options.files, "FILE",
      "eyes and directions of view whose glare is rated, lines x y z dx dy dz; repeatable");
}

std::vector<glare::Observer> observers_at(const ObserverOptions& options, const PlaceOptions& floor,
                                          const Scene& scene,
                                          std::optional<measuring::PlaneLayout>& plane,
                                          Progress& progress) {
  const auto axes = trace::PlanAxes::in_world(scene);
  std::vector<glare::Observer> all;
  const auto add = [&](const std::vector<glare::Observer>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  for (const auto& file : options.files) {
    add(glare::observers_at(measuring::read_points(file), axes));
  }
  if (!options.height.empty()) {
    auto grids = measuring::grids_at(scene,
                                     {.plane = options.height,
                                      .layout = floor.layout,
                                      .rooms = floor.rooms,
                                      .clearance = floor.clearance},
                                     progress);
    for (measuring::SensorGrid& grid : grids) {
      grid.name = floor.rooms.empty() ? "point" : grid.name + ": point";
      add(glare::observers_on(grid, axes, options.directions));
    }
    if (grids.size() == 1) plane = grids.front().layout;
  }
  if (2 * all.size() > limits::max_sensors) {
    throw UsageError(
        fmt::format("{} observers, more than {}; rate fewer", all.size(), limits::max_sensors / 2));
  }
  return all;
}

void add_sensor_options(const OptionGroup& group, MeasuringParameters& parameters) {
  group
      .add("--rays", parameters.gathering.rays, "N", "rays per point and repeat",
           count_between(1, limits::max_samples_per_pixel))
      ->capture_default_str();
  group
      .add("--repeats", parameters.repeats, "N",
           "independent measurements, whose scatter gives the standard error",
           count_between(2, limits::max_repeats))
      ->capture_default_str();
}

namespace {

/// 0 where `text` is no factor or no list of parts.
double maintenance_of(const std::string& text, std::string& parts) {
  if (text.find('=') == std::string::npos) {
    const double whole = parse_share(text).value_or(0);
    return whole <= 1 ? whole : 0;
  }
  double product = 1;
  std::istringstream list(text);
  for (std::string part; std::getline(list, part, ',');) {
    const std::size_t equals = part.find('=');
    const std::string name = part.substr(0, equals);
    constexpr std::array names{"LLMF", "LSF", "LMF", "RSMF", "RMF"};
    const auto share =
        equals == std::string::npos ? std::nullopt : parse_share(part.substr(equals + 1));
    if (std::find(names.begin(), names.end(), name) == names.end() || !share || *share > 1)
      return 0;
    product *= *share;
    parts += fmt::format("{}{} {:g}", parts.empty() ? "" : " x ", name, *share);
  }
  return product;
}

}  // namespace

void add_maintenance_option(const OptionGroup& group, MeasuringParameters& parameters,
                            std::string* parts) {
  const auto take = [&parameters, parts](const std::string& text) {
    std::string told;
    parameters.maintenance = maintenance_of(text, told);
    if (!(parameters.maintenance > 0)) {
      throw UsageError(
          fmt::format("--maintenance {}: use a factor above 0 up to 1, or its parts, such as "
                      "LLMF=0.9,LSF=1,LMF=0.95,RSMF=0.94",
                      text));
    }
    if (parts != nullptr) *parts = told;
  };
  group
      .call("--maintenance", take, "X|PARTS",
            "maintenance factor of all values, above 0 up to 1, or its parts by CIE 97, such as "
            "LLMF=0.9,LSF=1,LMF=0.95,RSMF=0.94; luminaires of a list may have their own")
      ->default_str("1");
}

}  // namespace photile::app
