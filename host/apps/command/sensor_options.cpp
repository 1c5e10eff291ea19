#include "command/sensor_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

#include "command/option_group.hpp"
#include "common/files.hpp"
#include "measuring/furniture.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile::app {

void add_plane_options(const OptionGroup& places, PlaneOptions& options) {
  places
      .add("--inside", options.inside, "X,Y,Z",
           "point in the room whose floor is used; default: the first camera's room")
      ->delimiter(',')
      ->expected(3);
  places
      .add("--wall-band", options.wall_band, "M", "width left out along the walls, m",
           number_between(0, limits::max_coordinate))
      ->capture_default_str();
  places.add("--spacing", options.spacing, "M",
             "distance between points, m; default: that of EN 12464-1", positive_number());
  places.add("--clearance", options.clearance, "M",
             "leave out points with a surface less than M metres in front of or behind them; "
             "points inside furniture are always left out",
             positive_number());
}

void add_place_options(CLI::App& command, PlaceOptions& options) {
  const OptionGroup places(command, "Places");
  places.repeat("--grid", options.planes, "FILE", "planes of points as JSON; repeatable");
  places.repeat("--points", options.points, "FILE",
                "points in the format of Radiance and Honeybee; repeatable");
  places.add("--plane", options.plane.height, "HEIGHT",
             "grid of EN 12464-1 over the floor: floor+0.75, or a height in metres");
  add_plane_options(places, options.plane);
}

void note_places(const PlaceOptions& options) {
  for (const auto& file : options.planes) note_input(file);
  for (const auto& file : options.points) note_input(file);
}

std::vector<measuring::SensorGrid> grids_at(const PlaceOptions& options, const Scene& scene) {
  std::vector<measuring::SensorGrid> grids;
  for (const auto& file : options.planes) {
    glm::dvec3 task(0.0);  // a point above it, off the table
    for (auto& grid : measuring::read_planes(file)) {
      if (grid.role == measuring::GridRole::task) {
        task = grid.sensors[grid.sensors.size() / 2].position + 0.05 * grid.layout->normal();
      }
      if (grid.role == measuring::GridRole::background) keep_in_room(scene, task, grid);
      if (!grid.sensors.empty()) grids.push_back(std::move(grid));
    }
  }
  for (const auto& file : options.points) grids.push_back(measuring::read_points(file));
  if (!options.plane.height.empty()) grids.push_back(plane_of(options.plane, scene));
  return grids;
}

measuring::WorkingPlane plane_at(const PlaneOptions& options, const std::string& height) {
  measuring::WorkingPlane plane = measuring::parse_working_plane(height);
  plane.wall_band = options.wall_band;
  plane.spacing = options.spacing;
  if (!options.inside.empty()) {
    plane.inside = glm::dvec3(options.inside[0], options.inside[1], options.inside[2]);
  }
  return plane;
}

measuring::SensorGrid plane_of(const PlaneOptions& options, const Scene& scene) {
  return measuring::working_plane_grid(scene, plane_at(options, options.height));
}

namespace {

/// "inside a solid or beyond the walls (3), less than 1 cm from a surface (2)", without reasons
/// that are known.
std::string reasons_of(const measuring::SensorGrid& grid, const measuring::CountedReasons& known) {
  std::string text;
  for (const auto& [reason, count] : measuring::counted_blanks(grid)) {
    if (std::ranges::count(known, reason, &measuring::CountedReasons::value_type::first)) continue;
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", reason, count);
  }
  return text;
}

}  // namespace

std::size_t clear_of_furniture(const PlaneOptions& options, const Scene& scene,
                               std::span<measuring::SensorGrid> grids, Progress& progress) {
  std::size_t left = 0;
  for (measuring::SensorGrid& grid : grids) {
    if (!grid.remark.empty()) progress.warn(fmt::format("{}: {}", grid.name, grid.remark));
    const std::size_t all = grid.sensors.size();
    const measuring::CountedReasons known = measuring::counted_blanks(grid);
    const std::size_t blank = measuring::leave_out_furniture(scene, options.clearance, grid,
                                                             plane_at(options, "floor").inside);
    if (grid.sensors.empty() && !(options.clearance > 0)) {
      throw UsageError(fmt::format(
          "{}: all {} points lie in objects or on surfaces; give another height or position",
          grid.name, all));
    }
    if (grid.sensors.empty()) {
      throw UsageError(fmt::format("--clearance {}: leaves none of the {} points of {}; reduce it",
                                   options.clearance, all, grid.name));
    }
    left += grid.sensors.size();
    for (const auto& [mark, count] : measuring::counted_marks(grid)) {
      progress.warn(fmt::format("{}: {} of {} points: {}; they count in all results", grid.name,
                                count, all, mark));
    }
    if (blank == 0) continue;
    progress.note(fmt::format("{}: {} of {} points are left out: they lie {}", grid.name, blank,
                              all, reasons_of(grid, known)));
  }
  return left;
}

void add_observers_option(const OptionGroup& places, ObserverOptions& options) {
  places.repeat(
      "--observers", options.files, "FILE",
      "eyes and directions of view whose glare is rated, lines x y z dx dy dz; repeatable");
}

std::vector<glare::Observer> observers_at(const ObserverOptions& options, PlaneOptions floor,
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
    floor.height = options.height;
    measuring::SensorGrid grid = plane_of(floor, scene);
    clear_of_furniture(floor, scene, std::span(&grid, 1), progress);
    grid.name = "point";
    plane = grid.layout;
    add(glare::observers_on(grid, axes, options.directions));
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
