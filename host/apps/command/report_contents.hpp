// What a report of `photile measure` has of the scene and of its pictures.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "measuring/sensor_grid.hpp"
#include "photile/layered_picture.hpp"
#include "photile/scene.hpp"
#include "report/false_colour.hpp"
#include "report/luminaires.hpp"
#include "report/report.hpp"

namespace photile::app {

/// Lamps with their numbers on the plans, kinds, photometric files, positions in the scene file's
/// world and powers. Lights of the sky have no position.
report::ReportTable lamp_schedule(const Scene& scene, const LightMix& mix);

/// Such as 2026-11-23.
std::string today();

/// The outputs of a command by the endings of their names: a table, plans, a report.
struct Results {
  std::function<std::string()> csv, json;
  std::function<std::vector<std::string>()> plans = {};  ///< SVG
  std::function<std::string()> page = {};                ///< HTML
};

/// Whether any of the files ends in one of these, in small letters or capitals.
bool has_any(const std::vector<std::string>& files, std::initializer_list<const char*> endings);

/// Writes each file: a .csv, .json, .html or .pdf, and plans to each .svg, numbered where they are
/// more than one. Makes of `results` what the files ask for. Errors: OutputError.
void write_results(const std::vector<std::string>& files, const Results& results);

std::size_t planes_of(const std::vector<measuring::SensorGrid>& grids);

/// Notes the files of plans for check_outputs, which knows that of a single one already. Errors:
/// UsageError where there is nothing to draw; those of note_output.
void note_plans(const std::vector<std::string>& files, std::size_t plans);

/// What is around the planes of maps.
void add_surroundings(const Scene& scene, std::vector<report::ReportMap>& maps);

/// W that each layer of the mix takes from the mains: in proportion to its lumens what its
/// luminaires' files state, and where one of them states nothing by an efficacy (lm/W).
std::vector<double> watts_of(const Scene& scene, const LightMix& mix, double efficacy);

/// lm of each of the scene's lights.
std::vector<double> lumens_of(const Scene& scene, const LightMix& mix);

/// The least Ra of all luminaires; 0 where a file states none.
double least_rendering(const std::vector<report::Part>& parts);

/// Luminaires by their photometric files, with totals.
report::ReportTable list_of_parts(const std::vector<report::Part>& parts);
std::vector<report::DataSheet> data_sheets(const std::vector<report::Part>& parts);

/// Name and value: power, watts by square metre, also by 100 lux, and LENI of EN 15193, where they
/// are known.
///   area             m2; 0 = not known
///   mean             lux of the task
///   kilowatt_hours   a year; 0 = not known
std::vector<std::pair<std::string, std::string>> energy_of(const std::vector<report::Part>& parts,
                                                           double area, double mean,
                                                           double kilowatt_hours);

/// A row for each opaque material that a triangle has, with its luminous reflectance in percent.
report::ReportTable reflectances(const Scene& scene);

/// The file of moods for a report: the one that is given, else the scene's, "" where there is none.
std::filesystem::path moods_of_report(const std::string& given, const std::filesystem::path& scene);

/// The picture as it was rendered and with each mood of the file, in its colours and, where it has
/// illuminance, in lux. Errors: those of relit_picture and of Moods.
std::vector<report::ReportPicture> report_pictures(const std::filesystem::path& picture,
                                                   const std::filesystem::path& moods,
                                                   const report::FalseColour& colours);

}  // namespace photile::app
