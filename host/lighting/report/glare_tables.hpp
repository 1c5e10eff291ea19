// Glare ratings as text for people and programs.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "glare/measure_glare.hpp"
#include "glare/ugr_table.hpp"

namespace photile::report {

/// A line for each observer under a heading, and one that names the highest rating of each kind.
std::vector<std::string> glare_lines(std::span<const glare::ObserverGlare> all);

/// A line for each observer: name, place, direction, illuminance and background with their standard
/// errors, ratings. Fields of what is not known are empty.
std::string glare_csv(std::span<const glare::ObserverGlare> all);

/// The same with the luminaires and the sources of pictures.
nlohmann::ordered_json glare_json(std::span<const glare::ObserverGlare> all);

/// A UGR table as data sheets have it: rooms in rows, five reflectances crosswise and endwise.
std::vector<std::string> ugr_table_lines(const glare::UgrTable& table);
std::string ugr_table_csv(const glare::UgrTable& table);
nlohmann::ordered_json ugr_table_json(const glare::UgrTable& table);

}  // namespace photile::report
