// Results of other commands in a report.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "measuring/requirements.hpp"
#include "report/report.hpp"

namespace photile::report {

struct IncludedResults {
  std::vector<ReportTable> tables;
  /// The highest UGR of all observers, where one is required.
  std::optional<measuring::Judgement> glare = std::nullopt;
  /// A year of the lamps, dimmed to what daylight lacks at the first grid; 0 = not said.
  double kilowatt_hours = 0;
};

/// Reads what `photile glare -o FILE.json` and `photile daylight -o FILE.json` have written. Of
/// many observers the table has the worst. Errors: InputError naming a file that is neither.
IncludedResults included_results(std::span<const std::filesystem::path> files,
                                 const std::optional<measuring::Requirement>& requirement);

}  // namespace photile::report
