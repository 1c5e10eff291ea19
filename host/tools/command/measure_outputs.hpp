// The files that `photile measure` writes: checked early, written late.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "measuring/measure_grids.hpp"
#include "measuring/measurement.hpp"
#include "photile/light_mix.hpp"
#include "photile/scene.hpp"
#include "tools/command/false_colour_options.hpp"
#include "tools/report/false_colour.hpp"

namespace CLI {
class App;
}

namespace photile::app {

struct MeasureOutputOptions {
  std::vector<std::string> outputs;  ///< -o: .csv, .json, .svg or .html
  FalseColourOptions false_colour;
  std::string honeybee;  ///< folder, "" = none
};

/// Adds -o, --honeybee and the options of false colour.
void add_measure_output_options(CLI::App& command, MeasureOutputOptions& options);

/// What was measured, and how.
struct MeasureRun {
  const Scene& scene;
  const LightMix& mix;
  const measuring::MeasuringParameters& parameters;
};

class MeasureOutputs {
 public:
  /// Errors: UsageError for a name with another ending; those of check_outputs; OutputError where
  /// the folder cannot be made.
  MeasureOutputs(const MeasureOutputOptions& options, const std::filesystem::path& scene);

  /// A plan of each plane goes to the .svg, numbered where there are several.
  /// Errors: OutputError; UsageError where a plan is asked for and there is no plane.
  void write(const measuring::Measurement& measurement, const MeasureRun& run) const;

 private:
  std::vector<std::filesystem::path> csv_, json_, svg_, html_;
  measuring::FalseColour colours_;
  std::filesystem::path honeybee_;
};

}  // namespace photile::app
