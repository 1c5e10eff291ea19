// A year of daylight at the points of grids.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <numbers>
#include <optional>

#include "arrays.hpp"
#include "common/foreign_text.hpp"
#include "daylight/sky_states.hpp"
#include "grids.hpp"
#include "parts.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "report/daylight_tables.hpp"
#include "weather/sky_patches.hpp"
#include "weather/weather_file.hpp"
#include "work.hpp"

namespace photile::python {
namespace {

using daylight::SkyState;
using measuring::SensorGrid;

struct YearOptions {
  std::filesystem::path weather;
  std::optional<Site> site;
  int patches = 0, rounds = 1;
  bool suns_by_rays = true;
  double north = 0;  ///< degrees
  std::vector<daylight::BlindGroup> blinds;
  SharedScene closed;  ///< the scene with closed blinds, null = none
  std::vector<std::string> portals;
  MeasuringParameters measuring;
  double lamps_to = 0, lamp_efficacy = 100;  ///< lux, 0 = no lamps; lm/W
  std::string device;
};

/// The state of each hour in each state of the blinds: 1 = there are no blinds.
std::size_t states_of(const YearOptions& options) {
  return options.closed ? 2 : std::size_t{1} << options.blinds.size();
}

YearOptions year_options(const py::dict& options, const py::object& closed,
                         const py::dict& settings) {
  YearOptions year;
  year.weather = field<std::string>(options, "weather");
  if (const auto text = field<std::string>(options, "site"); !text.empty())
    year.site = Site::parse(text);
  year.patches = field<int>(options, "patches");
  year.rounds = field<int>(options, "rounds");
  year.suns_by_rays = field<std::string>(options, "suns") == "rays";
  year.north = field<double>(options, "north");
  for (const auto& text : field<std::vector<std::string>>(options, "blinds"))
    year.blinds.push_back(daylight::BlindGroup::parse(text));
  if (!closed.is_none()) year.closed = closed.cast<SharedScene>();
  year.portals = field<std::vector<std::string>>(options, "portals");
  year.measuring.gathering.rays = field<int>(options, "rays");
  year.measuring.repeats = field<int>(options, "repeats");
  year.measuring.maintenance = field<double>(options, "maintenance");
  year.lamps_to = field<double>(options, "lamps_to");
  year.lamp_efficacy = field<double>(options, "lamp_efficacy");
  year.device = field<std::string>(options, "device");
  set_all(year.measuring.photons, settings);
  check_measuring(year.measuring);
  if (year.blinds.size() > daylight::most_blind_groups) {
    throw UsageError("blinds: " + std::to_string(year.blinds.size()) + " groups, more than " +
                     std::to_string(daylight::most_blind_groups) + "; let some close together");
  }
  return year;
}

daylight::Year year_of(const YearOptions& options, const std::vector<SensorGrid>& grids,
                       double ground) {
  weather::WeatherYear weather = weather::read_weather(options.weather);
  if (options.site) weather.site = *options.site;
  daylight::Year year{{}, weather::sky_patches(options.patches), {}, options.suns_by_rays, {}};
  year.hours = daylight::sky_hours(weather, year.patches, ground);
  for (const SensorGrid& grid : grids)
    year.sensors.insert(year.sensors.end(), grid.sensors.begin(), grid.sensors.end());
  const std::size_t states = states_of(options);
  if (year.sensors.size() * year.hours.size() * states > limits::max_profile_values) {
    throw UsageError(std::to_string(year.sensors.size()) + " points of " +
                     std::to_string(year.hours.size()) + " hours in " + std::to_string(states) +
                     " states are more than " + std::to_string(limits::max_profile_values) +
                     " values; give fewer points");
  }
  year.parameters = {options.measuring, options.north * std::numbers::pi / 180,
                     daylight::mean_luminances(year.hours, year.patches)};
  return year;
}

daylight::SkyRounds rounds_of(const YearOptions& options, const daylight::Year& year,
                              const SharedScene& scene, const std::vector<SensorGrid>& grids,
                              Progress& progress) {
  const SharedScene closed =
      options.closed ? with_portals(options.closed, grids, options.portals) : nullptr;
  daylight::SkyRounds rounds;
  QuietProgress quiet(progress);
  while (rounds.count() < static_cast<std::size_t>(options.rounds)) {
    Progress& told = rounds.count() == 0 ? progress : quiet;  // stages are shown once
    const daylight::Year next = rounds.count() == 0 ? year : rounds.year_of_next(year);
    if (!closed) {
      rounds.add(daylight::sky_states(next, *scene, options.blinds, told));
      continue;
    }
    std::vector<SkyState> states{daylight::sky_state(next, *scene, "open", 0, told)};
    states.push_back(daylight::sky_state(next, *closed, "closed", 1, told));
    rounds.add(std::move(states));
  }
  return rounds;
}

/// The scene's own lamps at the points.
report::YearLamps lamps_of(const YearOptions& options, const Scene& scene, const LightMix& mix,
                           const daylight::Year& year, Progress& progress) {
  if (!(options.lamps_to > 0) || scene.lights.empty()) return {};
  return with_devices(false, options.device, [&](std::span<Device> devices) {
    return report::year_lamps(scene, year.sensors, mix, options.lamps_to, options.lamp_efficacy,
                              devices, options.measuring, progress);
  });
}

/// A list of (results as the command writes them to .json, lux of shape (points, hours), lux
/// straight from the sun, likewise or None) of each grid, and what the hours are: (month, day, hour
/// of its middle, whether it is occupied) by columns.
py::tuple assess_year(const SharedScene& scene, const py::list& places, const py::dict& options,
                      const py::object& closed, const py::dict& settings,
                      const py::object& progress) {
  const std::vector<SensorGrid> grids = grids_of(places);
  const YearOptions asked_for = year_options(options, closed, settings);
  report::DaylightAsked asked;
  asked.target_lux = field<double>(options, "lux");
  asked.ground = field<double>(options, "ground");
  asked.occupancy.set_hours(field<std::string>(options, "occupied"));
  asked.occupancy.set_days(field<std::string>(options, "days"));
  asked.occupancy.schedule = field<std::string>(options, "schedule");
  const SharedScene own = without_sky(scene);
  const LightMix mix = mix_of(*own, options);
  daylight::Year year;
  report::DaylightResults results = run(progress, [&](Progress& told) {
    year = year_of(asked_for, grids, asked.ground);
    asked.occupied = daylight::occupied_hours(year.hours, asked.occupancy);
    const SharedScene lit = with_portals(own, grids, asked_for.portals);
    const auto rounds = rounds_of(asked_for, year, lit, grids, told);
    const auto lamps = lamps_of(asked_for, *lit, mix, year, told);
    return report::daylight_results(asked, year, grids, rounds, lamps);
  });
  const py::list records = parsed(json_text(report::daylight_json(results, asked), -1));
  const auto hours = static_cast<py::ssize_t>(year.hours.size());
  const auto by_hour = [&](std::vector<float>& values, std::size_t points) -> py::object {
    if (values.empty()) return py::none();
    return taken<float>(std::move(values), {static_cast<py::ssize_t>(points), hours});
  };
  py::list all;
  for (std::size_t i = 0; i < results.grids.size(); ++i) {
    report::GridDaylight& grid = results.grids[i];
    const std::size_t points = grid.points.size();
    all.append(py::make_tuple(records[i], by_hour(grid.lux, points), by_hour(grid.sun, points)));
  }
  std::vector<int> months, days;
  std::vector<double> middles;
  for (const daylight::SkyHour& hour : year.hours) {
    months.push_back(hour.month);
    days.push_back(hour.day);
    middles.push_back(hour.hour);
  }
  return py::make_tuple(all, py::make_tuple(months, days, middles, asked.occupied));
}

}  // namespace

void define_daylight(py::module_& module) { module.def("daylight", &assess_year); }

}  // namespace photile::python
