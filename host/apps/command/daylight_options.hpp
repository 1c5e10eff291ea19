// The options of `photile daylight`.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "command/render_options.hpp"
#include "command/report_program.hpp"
#include "command/sensor_options.hpp"
#include "photile/defaults.hpp"
#include "photile/progress.hpp"
#include "photile/sensors.hpp"
#include "report/daylight_tables.hpp"

namespace photile::app {

struct DaylightOptions {
  RenderOptions render;
  MeasuringParameters parameters;
  PlaceOptions places;
  std::vector<std::string> outputs;  ///< .csv, .json, .svg, .html, .pdf
  std::string honeybee;              ///< folder, "" = none
  ReportOptions report;
  int patches = defaults::sky_patches;
  std::string suns = "rays";
  report::DaylightAsked asked{defaults::daylight_lux, {}, {}};
  std::string occupied = "8-18", days = "mon-sun";
  std::string schedule;             ///< file, "" = none
  std::vector<std::string> blinds;  ///< a scene's file, or groups of panes
  double lamps_to = 0;              ///< lux that lamps keep; 0 = no lamps
  double lamp_efficacy = defaults::lamp_efficacy;
  double seconds = 0;  ///< for which rounds are added; 0 = one round

  DaylightOptions() {
    parameters.repeats = defaults::daylight_repeats;
    parameters.gathering.rays = defaults::daylight_rays;
  }

  /// Whether blinds are another scene.
  bool blinds_are_scene() const {
    return blinds.size() == 1 && blinds.front().find('=') == std::string::npos;
  }
};

/// Rounds of a year for the options' seconds, without outputs, lamps and blinds.
///   tell   is given the lines of `photile daylight` after the first round, the second, the fourth
///          and so on
/// Errors: those of loading; Interrupted, when `progress` says so.
void refine_year(DaylightOptions options, const std::function<void(std::vector<std::string>)>& tell,
                 Progress& progress);

}  // namespace photile::app
