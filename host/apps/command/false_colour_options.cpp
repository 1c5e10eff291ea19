#include "command/false_colour_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "command/validators.hpp"

namespace photile::app {
namespace {

CLI::Validator top_of_scale() {
  const auto check = [](std::string& text) -> std::string {
    if (text == "auto" || parse_value(text, PositiveNumbers{})) return {};
    return fmt::format("'{}' is neither auto nor a number greater than 0", text);
  };
  return {check, ""};
}

}  // namespace

FalseColourOptions::FalseColourOptions() : scale(fmt::format("{}", colours.scale)) {
  colours.label.clear();
}

report::FalseColour FalseColourOptions::of(const std::string& unit) const {
  report::FalseColour result = colours;
  if (result.label.empty()) result.label = unit;
  result.scale = scale == "auto" ? 0 : std::stod(scale);
  return result;
}

void add_scale_option(CLI::App& command, FalseColourOptions& options, const std::string& group) {
  command
      .add_option("-s,--scale", options.scale,
                  "top of the scale, or auto: 98% of the values lie below")
      ->type_name("X|auto")
      ->check(top_of_scale())
      ->capture_default_str()
      ->group(group);
}

void add_false_colour_options(CLI::App& command, FalseColourOptions& options) {
  report::FalseColour& colours = options.colours;
  const char* group = "False colour";
  add_scale_option(command, options, group);
  command.add_option("-l,--label", colours.label, "text of the legend; default: the unit")
      ->type_name("TEXT")
      ->group(group);
  command.add_option("-n,--steps", colours.steps, "steps of the legend and isolines")
      ->type_name("N")
      ->transform(count_between(1, 100))
      ->capture_default_str()
      ->group(group);
  command.add_option("--log", colours.decades, "logarithmic scale over so many decades")
      ->type_name("DECADES")
      ->transform(number_between(0.1, 30))
      ->group(group);
  command.add_option("--pal", colours.palette, "palette")
      ->type_name("")
      ->check(CLI::IsMember(report::Palette::names()))
      ->capture_default_str()
      ->group(group);
  const auto contours = [&](const char* name, report::Contours drawn, const char* what) {
    return command
        .add_flag_callback(
            name, [&colours, drawn] { colours.contours = drawn; }, what)
        ->group(group);
  };
  CLI::Option* lines = contours("--cl", report::Contours::lines, "isolines alone");
  CLI::Option* bands = contours("--cb", report::Contours::bands, "bands around the isolines alone");
  CLI::Option* steps =
      contours("--cp", report::Contours::steps, "posterized: one colour for each step");
  bands->excludes(lines);
  steps->excludes(lines)->excludes(bands);
}

}  // namespace photile::app
