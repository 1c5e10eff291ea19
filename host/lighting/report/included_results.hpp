// Results of other commands in a report.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "measuring/requirements.hpp"
#include "report/report.hpp"

namespace photile::report {

struct IncludedResults {
  std::vector<ReportTable> tables;
  /// DA and UDI of the planes of a year, the highest UGR at the points of a plane of observers.
  std::vector<ReportMap> maps;
  /// The highest UGR of all observers, where one is required.
  std::optional<measuring::Judgement> glare = std::nullopt;
  /// A year of the lamps, dimmed to what daylight lacks at the first grid; 0 = not said.
  double kilowatt_hours = 0;
};

/// Adds one file's content. Errors: nlohmann::json::exception where it is no result.
void include_result(const nlohmann::json& content,
                    const std::optional<measuring::Requirement>& requirement,
                    IncludedResults& results);

/// Reads what `photile glare -o FILE.json` and `photile daylight -o FILE.json` have written. Of
/// many observers the table has the worst. Errors: InputError naming a file that is neither.
IncludedResults included_results(std::span<const std::filesystem::path> files,
                                 const std::optional<measuring::Requirement>& requirement);

}  // namespace photile::report
