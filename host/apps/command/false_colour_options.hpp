// The options of Radiance's falsecolor, under its names and with its defaults.
#pragma once

#include <string>

#include "report/false_colour.hpp"

namespace CLI {
class App;
}

namespace photile::app {

/// As typed, checked against the limits.
struct FalseColourOptions {
  report::FalseColour colours;  ///< but for the top of the scale; no label: the unit
  std::string scale;            ///< top, or "auto"

  FalseColourOptions();

  /// What they ask for where values are in `unit`.
  report::FalseColour of(const std::string& unit) const;
};

/// Adds --scale.
void add_scale_option(CLI::App& command, FalseColourOptions& options, const std::string& group);

/// Adds all of them to a subcommand.
void add_false_colour_options(CLI::App& command, FalseColourOptions& options);

}  // namespace photile::app
