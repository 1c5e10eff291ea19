#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "command/command_line.hpp"
#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/processes.hpp"
#include "command/setting_options.hpp"
#include "command/terminal_progress.hpp"
#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/progress.hpp"
#include "validation/validate.hpp"

namespace photile::app {
namespace {

struct ValidateOptions {
  validation::ValidationParameters parameters;
  std::string integrator = "both";
  std::string only;  ///< part of the names of cases; "" = all
  DeviceOptions device;
  int threads = 0;
  std::string json;  ///< file, "" = none
  bool quiet = false;
};

using nlohmann::json;
using validation::Measured;
using validation::Quantity;
using validation::ValidationRow;
using validation::Verdict;

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::within:
      return "ok";
    case Verdict::misses:
      return "MISSES";
    default:
      return "too noisy";
  }
}

const char* unit_of(Quantity quantity) { return quantity == Quantity::luminance ? "cd/m2" : "lx"; }

std::string columns(const std::optional<Measured>& measured) {
  if (!measured) return {};
  return fmt::format("  {:>10.4g}{:>+8.2f}%{:>7.2f}%  {:<9}", measured->value,
                     100 * measured->error, 100 * measured->noise, name_of(measured->verdict));
}

std::string heading(const char* method) {
  return fmt::format("  {:>10}{:>9}{:>8}  {:<9}", method, "error", "noise", "");
}

json measured_json(const Measured& measured) {
  return {{"value", measured.value},
          {"error", measured.error},
          {"noise", measured.noise},
          {"seeds", measured.seeds},
          {"verdict", name_of(measured.verdict)}};
}

bool within(const std::optional<Measured>& measured) {
  return !measured || measured->verdict == Verdict::within;
}

/// A line per reading: expected, then value, error, noise and verdict of each method.
std::vector<std::string> validation_table(std::span<const ValidationRow> rows) {
  std::vector<std::string> lines;
  std::string name;
  const bool photons = !rows.empty() && rows.front().photons;
  const bool paths = !rows.empty() && rows.front().paths;
  lines.push_back(fmt::format("{:<34}{:>10} {:<6}{}{}", "", "expected", "",
                              photons ? heading("photon map") : "", paths ? heading("paths") : ""));
  for (const ValidationRow& row : rows) {
    if (row.name != name) lines.push_back(name = row.name);
    lines.push_back(fmt::format("  {:<32}{:>10.4g} {:<6}{}{}", row.place, row.expected,
                                unit_of(row.quantity), columns(row.photons), columns(row.paths)));
  }
  for (std::string& line : lines) line.erase(line.find_last_not_of(' ') + 1);
  return lines;
}

/// The content of --json FILE.
json validation_json(std::span<const ValidationRow> rows,
                     const validation::ValidationParameters& parameters,
                     std::span<const Device> devices, double seconds) {
  json result{{"photile", version_number()},
              {"tolerance", validation::tolerance},
              {"seed", parameters.photons.seed},
              {"photons", parameters.photons.photons.emitted_photons},
              {"neighbours", parameters.photons.neighbours},
              {"paths", parameters.paths},
              {"devices", json::array()},
              {"seconds", seconds},
              {"readings", json::array()}};
  for (const Device& device : devices) {
    result["devices"].push_back(
        {{"name", device.info().name}, {"platform", device.info().platform}});
  }
  for (const ValidationRow& row : rows) {
    json entry{{"case", row.name},
               {"source", row.source},
               {"place", row.place},
               {"unit", unit_of(row.quantity)},
               {"expected", row.expected}};
    if (row.photons) entry["photon_map"] = measured_json(*row.photons);
    if (row.paths) entry["path"] = measured_json(*row.paths);
    result["readings"].push_back(entry);
  }
  return result;
}

/// Readings for which some method misses the tolerance, or is too noisy to decide.
std::size_t rows_not_within(std::span<const ValidationRow> rows) {
  return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [](const auto& row) {
    return !within(row.photons) || !within(row.paths);
  }));
}

std::vector<validation::AnalyticCase> chosen_cases(const std::string& only) {
  std::vector<validation::AnalyticCase> cases = validation::analytic_cases();
  std::string names;
  for (const auto& each : cases) names += (names.empty() ? "'" : ", '") + each.name + "'";
  std::erase_if(cases, [&](const auto& each) { return each.name.find(only) == std::string::npos; });
  if (cases.empty()) {
    throw UsageError(fmt::format("--case '{}': no name contains it; there are {}", only, names));
  }
  return cases;
}

void run_validate(ValidateOptions& options) {
  handle_signals();
  const Stopwatch stopwatch;
  validation::ValidationParameters& parameters = options.parameters;
  parameters.by_photons = options.integrator != "path";
  parameters.by_paths = options.integrator != "photon-map";
  if (!options.json.empty()) {
    const std::filesystem::path file = options.json;
    check_outputs(std::span(&file, 1));
  }
  const auto cases = chosen_cases(options.only);

  const ThreadLimit threads(options.threads);
  TerminalProgress progress(options.quiet);
  std::vector<Device> devices;
  if (parameters.by_photons) devices = open_devices(options.device);
  std::vector<validation::ValidationRow> rows;
  progress.begin("validate", cases.size(), "cases");
  for (const auto& each : cases) {
    QuietProgress quiet(progress);
    const auto of_case = validation::validate(each, devices, parameters, quiet);
    rows.insert(rows.end(), of_case.begin(), of_case.end());
    progress.advance(1);
  }
  progress.end();
  for (const auto& line : validation_table(rows)) std::cout << line << '\n';
  if (!options.json.empty()) {
    write_file(options.json,
               json_text(validation_json(rows, parameters, devices, stopwatch.seconds()), 2));
  }
  const std::size_t failed = rows_not_within(rows);
  if (failed > 0) {
    throw Error(
        fmt::format("{} of {} readings are not within {}%; those marked 'too noisy' "
                    "need more --photons or --paths; with fewer photons lower -k",
                    failed, rows.size(), 100 * validation::tolerance));
  }
}

}  // namespace

void add_validate_command(CLI::App& photile) {
  auto options = std::make_shared<ValidateOptions>();
  RenderParameters& photons = options->parameters.photons;
  photons.photons.emitted_photons = defaults::validation_photons;
  photons.neighbours = defaults::validation_neighbours;
  options->parameters.paths = defaults::validation_paths;
  CLI::App* command =
      photile.add_subcommand("validate", "Check scenes whose light is known in closed form");
  const OptionGroup group(*command);
  group
      .add("--integrator", options->integrator, "", "methods to measure with",
           CLI::IsMember({"photon-map", "path", "both"}))
      ->capture_default_str();
  group.add("--case", options->only, "TEXT", "only cases with this in their names");
  for (const char* name : {"photons_emitted", "neighbours"}) add_setting(*command, photons, name);
  group
      .add("--paths", options->parameters.paths, "N", "paths of a measurement by path tracing",
           count_between(1, std::numeric_limits<int>::max()))
      ->capture_default_str();
  group
      .add("--seed", photons.seed, "N", "seed from which all others follow",
           count_between(0, std::numeric_limits<std::uint64_t>::max() - 16))
      ->capture_default_str();
  group.add("--device", options->device.selector, "SELECTOR",
            "OpenCL device, as in photile render");
  group
      .add("--threads", options->threads, "N", "threads on the host; 0: one per core",
           count_between(0, limits::max_threads))
      ->capture_default_str();
  group.add("--json", options->json, "FILE", "write the readings as JSON");
  group.flag("-q,--quiet", options->quiet, "no progress");
  command->callback([options] { run_validate(*options); });
}

}  // namespace photile::app
