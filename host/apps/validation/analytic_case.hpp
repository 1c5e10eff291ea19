// Scenes whose light is known in closed form.
#pragma once

#include <string>
#include <vector>

#include "photile/scene.hpp"
#include "photile/sensors.hpp"

namespace photile::validation {

enum class Quantity {
  illuminance,  ///< lux
  luminance     ///< cd/m2, seen along the sensor's normal
};

/// One reading: the mean over sensors at places of like light, and what it must be.
struct Reading {
  std::string place;
  std::vector<Sensor> sensors;
  double expected = 0;
  Quantity quantity = Quantity::illuminance;
};

struct AnalyticCase {
  std::string name;
  std::string source;  ///< what it follows, and the closed form
  Scene scene;         ///< one light
  std::vector<Reading> readings;
  /// Of the photons asked for, what this case needs: those whose readings are means over whole
  /// rooms need few.
  double photon_share = 1;
  /// Of the neighbours asked for, what an estimate takes: the mean over many sensors is quiet with
  /// few, whose small discs see no curvature of the irradiance.
  double neighbour_share = 1;
};

/// All cases, in the order of the documentation. Expected values are computed from form factors,
/// not quoted: some of the tables printed in CIE 171:2006 are known to be wrong (Ashdown, "CIE
/// 171:2006 errata", 2016, on table 19 of case 5.7).
std::vector<AnalyticCase> analytic_cases();

// The parts of that list.
void add_direct_cases(std::vector<AnalyticCase>& cases);
void add_reflection_cases(std::vector<AnalyticCase>& cases);
void add_furnace_cases(std::vector<AnalyticCase>& cases);

}  // namespace photile::validation
