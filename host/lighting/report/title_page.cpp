#include <fmt/format.h>

#include "report/page.hpp"

namespace photile::report {

namespace {

using Row = std::vector<std::string>;

std::string verdict(const Page& page, bool met) {
  return met ? page.said("met") : fmt::format("<b>{}</b>", page.said("not met"));
}

/// A figure beside its limit.
Row figure_row(const Page& page, const std::string& grid, const std::string& figure, bool at_most,
               double required, const std::string& value, const std::string& verdict) {
  return {page.text(grid), figure,
          fmt::format("{} {:g}", page.said(at_most ? "at most" : "at least"), required), value,
          verdict};
}

Row judgement_row(const Page& page, const measuring::Judgement& judgement) {
  const Measured& measured = judgement.measured;
  const std::string value = judgement.figure == "Em"   ? Page::lux(measured)
                            : judgement.figure == "Uo" ? Page::ratio(measured)
                                                       : measuring::glare_text(measured.value);
  return figure_row(page, judgement.grid, judgement.figure, judgement.at_most, judgement.required,
                    value, verdict(page, judgement.met()));
}

/// What is required, and whether it is met.
std::string target(const Page& page, const measuring::Measurement& measurement,
                   const measuring::Requirement& requirement, const ReportText& report) {
  std::vector<Row> rows;
  for (const measuring::GridValues& values : measurement) {
    for (const measuring::Judgement& judgement : measuring::judge(values, requirement)) {
      rows.push_back(judgement_row(page, judgement));
    }
  }
  if (report.glare) {
    rows.push_back(judgement_row(page, *report.glare));
  } else if (requirement.glare > 0) {
    rows.push_back(
        figure_row(page, "", "UGR", true, requirement.glare, page.said("see photile glare"), ""));
  }
  if (requirement.rendering > 0) {
    const double ra = report.rendering;
    const bool known = ra > 0;
    rows.push_back(
        figure_row(page, "", "Ra", false, requirement.rendering,
                   known ? fmt::format("{:g}, {}", ra, page.said("by the luminaires' data sheets"))
                         : page.said("see the luminaires' data sheets"),
                   known ? verdict(page, ra >= requirement.rendering) : ""));
  }
  const std::string source =
      requirement.reference.empty() ? "" : requirement.reference + ", " + requirement.what;
  return fmt::format("<h2>{}: {}</h2>\n<p>{}</p>\n", page.said("Key figures"),
                     escaped_xml(requirement.name), escaped_xml(source)) +
         Page::table("target", {"", "", page.said("required"), page.said("measured"), ""}, rows);
}

/// The figures of all grids, where nothing is required.
std::string key_figures(const Page& page, const measuring::Measurement& measurement) {
  std::vector<Row> rows;
  for (const measuring::GridValues& values : measurement) {
    const measuring::GridStatistics& s = values.total().statistics;
    rows.push_back({page.text(values.grid.name), Page::lux(s.mean), Page::ratio(s.uniformity)});
  }
  return page.heading("Key figures") +
         Page::table("target", {"", "E<sub>m</sub> " + page.said("lux"), "U<sub>o</sub>"}, rows);
}

/// A line for the designer, and one for the client.
std::string lines_to_sign(const Page& page, const ReportProject& project) {
  std::vector<Row> rows;
  for (const auto& [role, name] : {std::pair("designed by", project.designer),
                                   std::pair("accepted for the client by", project.client)}) {
    rows.push_back({name.empty() ? "&#160;" : escaped_xml(name), "", ""});
    rows.push_back({page.said(role), page.said("date"), page.said("signature")});
  }
  return Page::table("sign", {}, rows);
}

}  // namespace

std::string title_page(const Page& page, const measuring::Measurement& measurement,
                       const ReportText& report) {
  const ReportProject& project = report.project;
  std::string html = "<section class=\"title\">\n";
  if (!report.logo.empty()) {
    html += fmt::format("<img class=\"logo\" alt=\"\" src=\"{}\"/>\n", report.logo);
  }
  html +=
      fmt::format("<h1>{}</h1>\n",
                  escaped_xml(project.name.empty() ? page.said(report.subject) + ": " + report.title
                                                   : project.name));
  if (!report.pictures.empty()) html += page.figure(report.pictures.front());
  html += "<div class=\"about\">\n";
  if (project.said()) {
    std::vector<std::pair<std::string, std::string>> about{{"project", project.name},
                                                           {"client", project.client},
                                                           {"designer", project.designer},
                                                           {"scene", report.title}};
    for (const auto& fact : report.facts) {
      if (fact.first == "date") about.push_back(fact);
    }
    html += page.list(about, "project");
  }
  if (!report.room.empty()) html += page.heading("Room") + page.list(report.room);
  if (!report.energy.empty()) html += page.heading("Energy") + page.list(report.energy);
  html += "</div>\n<div class=\"end\"></div>\n";
  if (report.requirement) {
    html += target(page, measurement, *report.requirement, report);
  } else if (!measurement.empty()) {
    html += key_figures(page, measurement);
  }
  if (project.said()) html += lines_to_sign(page, project);
  return html + "</section>\n";
}

}  // namespace photile::report
