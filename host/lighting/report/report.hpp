// A measurement as pages for people who plan light.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "measuring/measurement.hpp"
#include "measuring/requirements.hpp"
#include "report/false_colour.hpp"
#include "report/plan_lines.hpp"

namespace photile::report {

/// A table of texts; the first column is aligned to the left.
struct ReportTable {
  std::string heading;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// A picture with what it shows.
struct ReportPicture {
  std::string caption;
  std::string png;          ///< bytes of the file
  std::string values = {};  ///< that its colours stand for; "" = a picture as it looks
};

/// A luminaire as its photometric file describes it.
struct DataSheet {
  std::string heading;
  std::vector<std::pair<std::string, std::string>> rows;  ///< name and value
  std::string drawing;                                    ///< SVG
};

/// A figure of a plane's points that is no illuminance, such as a year's daylight, drawn on it.
struct ReportMap {
  measuring::GridValues values;  ///< of one "light", the figure's name
  FalseColour colours;
  PlanSurroundings surroundings = {};
};

/// What a report is for, and who answers for it; "" = not said.
struct ReportProject {
  std::string name, client, designer;
  bool said() const { return !name.empty() || !client.empty() || !designer.empty(); }
};

/// What a report says beside the values.
struct ReportText {
  std::string title;                                       ///< name of the scene
  std::vector<std::pair<std::string, std::string>> facts;  ///< name and value, in order
  std::optional<measuring::Requirement> requirement = std::nullopt;
  std::vector<ReportTable> tables = {};
  std::optional<measuring::Judgement> glare =
      std::nullopt;  ///< the highest UGR, beside the requirement
  ReportProject project = {};
  std::string logo = {};  ///< a picture as a data URI, "" = none
  std::vector<ReportPicture> pictures = {};
  std::vector<std::pair<std::string, std::string>> room = {};    ///< name and value
  std::vector<std::pair<std::string, std::string>> energy = {};  ///< name and value
  std::vector<DataSheet> sheets = {};
  std::vector<ReportMap> maps = {};
  double rendering = 0;  ///< the least Ra that all luminaires' files state; 0 = some states none
  std::vector<std::string> warnings = {};  ///< what the program doubts of the scene and its points
  std::string language = "en";
  std::string subject = "Illuminance";  ///< of a report without a project's name
};

/// An HTML page that needs no other file and prints on numbered pages of A4: a title page with the
/// project, a picture, what is required and whether it is met, the room, its energy and, where a
/// project is named, lines to sign on; the pictures; a page for each grid with its figures, their
/// errors and false-colour plans of all lights together and of each; the maps, the tables, the data
/// sheets, the facts. Well-formed XML.
///   surroundings   of each grid's plane, in the order of the grids
std::string report_html(const measuring::Measurement& measurement, const ReportText& text,
                        const FalseColour& colours,
                        const std::vector<PlanSurroundings>& surroundings);

}  // namespace photile::report
