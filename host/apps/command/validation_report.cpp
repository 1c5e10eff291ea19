#include "command/validation_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "command/version.hpp"

namespace photile::app {
namespace {

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
          {"verdict", name_of(measured.verdict)}};
}

bool within(const std::optional<Measured>& measured) {
  return !measured || measured->verdict == Verdict::within;
}

}  // namespace

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

json validation_json(std::span<const ValidationRow> rows,
                     const validation::ValidationParameters& parameters,
                     std::span<const Device> devices, double seconds) {
  json result{{"photile", version_number()},
              {"seeds", validation::seeds},
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

std::size_t rows_not_within(std::span<const ValidationRow> rows) {
  return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [](const auto& row) {
    return !within(row.photons) || !within(row.paths);
  }));
}

}  // namespace photile::app
