// A measurement on one page, for people who plan light.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "measuring/measurement.hpp"
#include "measuring/requirements.hpp"
#include "tools/report/false_colour.hpp"

namespace photile::measuring {

/// What a report says beside the values.
struct ReportText {
  std::string title;                                       ///< name of the scene
  std::vector<std::pair<std::string, std::string>> facts;  ///< name and value, in order
  std::optional<Requirement> requirement = std::nullopt;
};

/// An HTML page that needs no other file: what is required and whether it is met, the figures of
/// each grid with their errors, false-colour plans of all lights together and of each, and the
/// facts. Well-formed XML; prints on A4.
std::string report_html(const Measurement& measurement, const ReportText& text,
                        const FalseColour& colours);

}  // namespace photile::measuring
