// What a report of `photile measure` has of the scene and of its pictures.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command/report_program.hpp"
#include "measuring/sensor_grid.hpp"
#include "report/false_colour.hpp"

namespace photile::app {

/// The outputs of a command by the endings of their names: tables, and what photile.report draws.
struct Results {
  std::function<std::string()> csv, json;
  std::function<nlohmann::ordered_json()> record = {};  ///< for reports and plans
  std::size_t plans = 0;                                ///< that the record has
  ReportOptions report = {};
};

/// Whether any of the files ends in one of these, in small letters or capitals.
bool has_any(const std::vector<std::string>& files, std::initializer_list<const char*> endings);

/// Writes each file: a .csv, .json, .html or .pdf, and plans to each .svg or .dxf, numbered where
/// they are more than one. Makes of `results` what the files ask for. Errors: OutputError; those of
/// draw_report.
void write_results(const std::vector<std::string>& files, const Results& results);

std::size_t planes_of(const std::vector<measuring::SensorGrid>& grids);

/// Notes the files of plans for check_outputs, which knows that of a single one already. Errors:
/// UsageError where there is nothing to draw; those of note_output.
void note_plans(const std::vector<std::string>& files, std::size_t plans);

/// The file of moods for a report: the one that is given, else the scene's, "" where there is none.
std::filesystem::path moods_of_report(const std::string& given, const std::filesystem::path& scene);

/// The picture as it was rendered and with each mood of the file, in its colours and, where it has
/// illuminance, in lux: caption, PNG in base64 and what the colours stand for. Errors: those of
/// relit_picture and of Moods.
nlohmann::ordered_json report_pictures(const std::filesystem::path& picture,
                                       const std::filesystem::path& moods,
                                       const report::FalseColour& colours);

}  // namespace photile::app
