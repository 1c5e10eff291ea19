// The files that `photile measure` writes: checked early, written late.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "command/output_files.hpp"
#include "command/report_contents.hpp"
#include "measuring/measurement.hpp"
#include "report/record.hpp"

namespace CLI {
class App;
}

namespace photile::app {

struct MeasureOutputOptions {
  std::vector<std::string> outputs;  ///< -o: .csv, .json, .svg, .dxf, .html or .pdf
  FalseColourOptions false_colour;
  std::string honeybee;                   ///< folder, "" = none
  std::string picture;                    ///< EXR for the report, "" = none
  std::string logo;                       ///< PNG or JPEG for the report, "" = none
  std::string maintenance;                ///< parts of the factor, "" = not said
  std::string project, client, designer;  ///< for the report's title page, "" = not said
  ReportOptions report;
  bool daylight_factor = false;  ///< values are per cent of the sky's lux
};

/// Adds -o, --honeybee and the options of false colour.
void add_measure_output_options(CLI::App& command, MeasureOutputOptions& options);

class MeasureOutputs {
 public:
  /// Errors: UsageError for options that do not go together; those of check_outputs and
  /// check_report; OutputError where the folder cannot be made.
  explicit MeasureOutputs(MeasureOutputOptions& options);

  /// Notes the files whose names follow from what is measured: a plan of each plane goes to the
  /// .svg or .dxf, numbered where there are several, and a file of each grid to the folder.
  /// Errors: UsageError where a plan is asked for and there is no plane, or where two grids have
  /// one file; those of note_output.
  void check_names(const std::vector<measuring::SensorGrid>& grids) const;

  /// Warns where the picture of --picture shows other surfaces than `scene` has.
  void check_picture(const Scene& scene, Progress& progress) const;

  /// Checks that the moods of a file fit the picture, which `write` shows in them ("" = none).
  /// Errors: those of report_pictures.
  void check_moods(const std::filesystem::path& moods) const;

  /// Whether it writes the full record of the run and of the scene.
  bool any_record() const {
    return has_any(options_.outputs, {".json"}) || !drawn_files(options_.outputs).empty();
  }

  /// "lux", or "DF %" of daylight factors.
  const std::string& unit() const { return unit_; }

  /// Errors: OutputError.
  ///   moods   file of those that a report shows; "" = none
  void write(const measuring::Measurement& measurement, const report::MeasureRun& run,
             const std::filesystem::path& moods) const;

 private:
  nlohmann::ordered_json record_of(const measuring::Measurement& measurement,
                                   const report::MeasureRun& run,
                                   const std::filesystem::path& moods) const;

  const MeasureOutputOptions& options_;
  std::string unit_;
  report::FalseColour colours_;
  std::string logo_;  ///< as a page holds it
};

}  // namespace photile::app
