// Measurements and glare ratings as text for people and programs (lines, CSV, JSON), and numbers as
// people read them.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <glm/glm.hpp>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "glare/measure_glare.hpp"
#include "measuring/measurement.hpp"

namespace photile::report {

/// A line for each observer under a heading, and one that names the highest rating of each kind.
std::vector<std::string> glare_lines(std::span<const glare::ObserverGlare> all);

/// A line for each observer: name, position, direction, illuminance and background with their
/// standard errors, ratings. Fields of what is not known are empty.
///   ground   reflectance of the ground under the sky, a further column; none without a sky
std::string glare_csv(std::span<const glare::ObserverGlare> all,
                      std::optional<double> ground = std::nullopt);

/// The ratings with the luminaires and the sources of pictures.
nlohmann::ordered_json glare_json(std::span<const glare::ObserverGlare> all);
/// These as `observers`, with the `plane` and the `plan` of those over a floor.
nlohmann::ordered_json glare_record(const Scene& scene, std::span<const glare::ObserverGlare> all,
                                    const std::optional<measuring::PlaneLayout>& plane);

/// A value with so many digits that count; large ones are whole numbers in place of powers of ten:
/// "12500", not "1.25e+04".
inline std::string number_text(double value, int digits) {
  const double size = std::abs(value);
  if (size >= std::pow(10.0, digits) - 0.5 && size < 1e9) return fmt::format("{:.0f}", value);
  return fmt::format("{:.{}g}", value, digits);
}

/// The same with groups of three from 10,000 on: "0.5857", "6000", "11,990".
std::string grouped(double value, int digits);

/// The least of `steps`, ascending from 1, times a power of ten that is not below a value above 0.
inline double rounded_up(double value, std::initializer_list<double> steps) {
  const double decade = std::pow(10, std::floor(std::log10(value)));
  for (const double step : steps) {
    if (step * decade >= value) return step * decade;
  }
  return 10 * decade;
}

/// A vector, and a value with its standard error, as JSON has them.
inline nlohmann::ordered_json vector_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
inline nlohmann::ordered_json measured_json(const Measured& measured) {
  return {{"value", measured.value}, {"standard_error", measured.standard_error}};
}

/// A rectangle of cells, as JSON has it.
nlohmann::ordered_json plane_json(const measuring::PlaneLayout& layout);

/// Rows in columns that are as wide as their widest text, two blanks apart; the first is aligned to
/// the left, all others to the right.
std::vector<std::string> aligned(const std::vector<std::vector<std::string>>& rows);

/// A line for each sensor, with a heading: grid, point (from 0), x, y, z, dx, dy, dz, lux,
/// standard_error; with several lights also `lux <light>` and `standard_error <light>` of each.
///   ground   reflectance of the ground under the sky, a last column; none without a sky
std::string measurement_csv(const measuring::Measurement& measurement,
                            const std::string& unit = "lux",
                            std::optional<double> ground = std::nullopt);

/// The heading of that column, and its field; "" without.
std::string ground_heading(std::optional<double> ground);
std::string ground_field(std::optional<double> ground);

/// Array of grids, each with `name`, `points`, `plane` (where it is one), `statistics` and
/// `sensors`.
nlohmann::ordered_json measurement_json(const measuring::Measurement& measurement);

/// A line for each grid and light, with a heading: Em, Emin, Emax, Uo, Ud with standard errors.
std::vector<std::string> measurement_lines(const measuring::Measurement& measurement,
                                           const std::string& unit = "lux");

}  // namespace photile::report
