// Reports, plans, UGR tables and Honeybee's files are made of the JSON of results by
// photile.report, a Python program beside the command (python/photile/report).
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "measuring/requirements.hpp"

namespace photile::app {

class OptionGroup;

/// How reports look.
struct ReportOptions {
  std::string templates;                 ///< folder, "" = photile's own
  std::string language = "en";           ///< that has words
  std::vector<std::string> results;      ///< JSON files of other commands
  nlohmann::ordered_json included = {};  ///< what they hold: file and content
};

/// The folder of photile's Python files: beside the installed command, or in the build folder.
/// Errors: OutputError where it is missing.
std::filesystem::path python_package();
/// Debian's Python, which has the packages, or the first of the path.
std::string python_program();

/// Adds --template.
void add_template_option(const OptionGroup& group, ReportOptions& options);

/// Whether a file gets a plan: .svg or .dxf.
bool is_plan(const std::string& file);

/// Those of the files that photile.report draws: plans, .html and .pdf.
std::vector<std::string> drawn_files(const std::vector<std::string>& files);

/// Reads the results, and makes sure, before anything is measured, that all of `files` can be drawn
/// with these options. Nothing where none of them is drawn.
/// Errors: OutputError naming packages of Debian that are missing; InputError naming what of the
/// results or the templates is wrong; UsageError for a language without words.
void check_report(ReportOptions& options, const std::vector<std::string>& files);

/// Draws those of `files` that are drawn, and writes them whole.
///   plans   that the record has: several are numbered
/// Errors: as above, and those of write_file; Interrupted.
void draw_report(const nlohmann::ordered_json& record, const ReportOptions& options,
                 const std::vector<std::string>& files, std::size_t plans);

/// The file of each of several plans: numbered where they are more than one.
std::vector<std::filesystem::path> plan_names(const std::filesystem::path& file, std::size_t plans);

/// Has photile.report make the UGR table of a luminaire, and writes it to `files`, .csv or .json.
/// Returns it in lines for people. Errors: as above, and those of write_file; Interrupted.
std::string write_ugr_table(const nlohmann::ordered_json& luminaire,
                            const std::vector<std::string>& files);

/// Makes sure that Honeybee's files can be written. Errors: OutputError that names what is missing.
void check_honeybee();

/// Has photile.report write Honeybee's files into a folder, which is there. Errors: as above;
/// Interrupted.
///   record_of   makes what they are made of, and may write more into the folder that it is given
void write_honeybee(
    const std::filesystem::path& folder,
    const std::function<nlohmann::ordered_json(const std::filesystem::path& scratch)>& record_of);

/// The observers of the included results, which have been checked.
std::vector<measuring::RatedObserver> observers_in(const nlohmann::ordered_json& included);

}  // namespace photile::app
