// The record of a measurement, from which reports are drawn: how it was made, and the scene with
// its luminaires.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "measuring/measurement.hpp"
#include "measuring/requirements.hpp"
#include "measuring/rooms.hpp"
#include "report/false_colour.hpp"

namespace photile::report {

/// What the photometric file states of the luminaire, name and value: maker, article, luminaire,
/// lamps, power with its efficacy, colour temperature, colour rendering. Nothing of what it leaves
/// out.
std::vector<std::pair<std::string, std::string>> data_rows(const IntensityDistribution& lamp);

/// cd per 1000 lm in the planes C0-C180 and C90-C270, by the degree from -180 to 180 from its aim;
/// angles are negative on the plane's other side.
std::array<std::vector<double>, 2> intensities_of(const IntensityDistribution& lamp);

/// Luminaires of one photometric file, with the same data.
struct Part {
  const IntensityDistribution* lamp;
  std::size_t count = 0;
  double lumens = 0;  ///< of all, at the powers of a mix
  double watts = 0;   ///< of all at those powers; 0 = the file does not state any
};

/// In the order of the scene's lights. Watts are in proportion to lumens, so that dimmed luminaires
/// take less.
///   lumens   of each of the scene's lights
std::vector<Part> parts_of(const Scene& scene, const std::vector<double>& lumens);

/// "area", "point", "spot", "photometric", "sun", "directional" or "environment".
std::string_view kind_name(const Light& light);

/// Power of each light in the mix; lights of a group change together.
std::vector<double> powers_of(const Scene& scene, const LightMix& mix);

/// W that each layer of the mix takes from the mains: in proportion to its lumens what its
/// luminaires' files state, and where one of them states nothing by an efficacy (lm/W).
std::vector<double> watts_of(const Scene& scene, const LightMix& mix, double efficacy);

/// The options of false colour, with the colours of the palette from low to high.
nlohmann::ordered_json colours_json(const FalseColour& colours);

/// Such as 2026-11-23.
std::string today();

/// What was measured, and how.
struct MeasureRun {
  const Scene& scene;
  const LightMix& mix;
  const MeasuringParameters& parameters;
  std::string mood = {};  ///< "" = none
  std::vector<measuring::JudgedTarget> targets = {};
  nlohmann::ordered_json glare = {};  ///< as glare_record; null = none
  std::optional<measuring::NamedRoom> room = std::nullopt;
  std::optional<double> ground = std::nullopt;  ///< its reflectance; none without a sky
  /// What the sky is: name and value.
  std::vector<std::pair<std::string, std::string>> sky = {};
  std::vector<std::string> warnings = {};      ///< of the scene, the points and the lights
  std::optional<double> north = std::nullopt;  ///< degrees clockwise from -z; none = not stated
  std::string version = {};                    ///< of photile
};

/// Of a measurement in this unit.
nlohmann::ordered_json run_json(const measuring::Measurement& measurement, const MeasureRun& run,
                                const std::string& unit);

}  // namespace photile::report
