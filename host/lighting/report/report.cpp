#include "report/report.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <utility>

#include "report/page.hpp"
#include "report/plan_drawing.hpp"
#include "report/tables.hpp"

namespace photile::report {

namespace {

constexpr std::size_t most_light_plans = 6;  ///< more do not fit on a page

std::string section(const char* kind, const std::string& content) {
  return fmt::format("<section class=\"{}\">\n{}</section>\n", kind, content);
}

std::string plan(const measuring::GridValues& values, const measuring::LightValues& light,
                 const FalseColour& colours, PlanSize size, const PlanSurroundings& surroundings) {
  return "<div class=\"plan\">\n" + plan_svg(values, light, colours, size, surroundings) +
         "</div>\n";
}

std::string grid_heading(const Page& page, const measuring::SensorGrid& grid) {
  std::string text = page.with("{}: {} points", page.said(grid.name), grid.sensors.size());
  if (grid.layout) {
    text += page.with(", {:.2f} x {:.2f} m, {:.2f} m apart", glm::length(grid.layout->u),
                      glm::length(grid.layout->v), grid.layout->spacing());
  }
  return fmt::format("<h2>{}</h2>\n", escaped_xml(text));
}

/// How many points are not measured, or doubtful, and why.
std::string remarks(const Page& page, const measuring::SensorGrid& grid) {
  std::string html;
  const auto add = [&](std::string_view text, const measuring::CountedReasons& counted) {
    for (const auto& [reason, count] : counted) {
      html += fmt::format("<p class=\"remark\">{}</p>\n",
                          escaped_xml(page.with(text, count, page.said(reason))));
    }
  };
  add("\u00d7 {} points are not measured: {}.", measuring::counted_blanks(grid));
  add("\u00d7 {} points are measured, but marked: {}.", measuring::counted_marks(grid));
  return html;
}

/// Figures of all lights together and of each, and their plans.
std::string grid_page(const Page& page, const measuring::GridValues& values,
                      const FalseColour& colours, const PlanSurroundings& surroundings) {
  std::vector<std::vector<std::string>> rows;
  for (const measuring::LightValues& light : values.lights) {
    const measuring::GridStatistics& s = light.statistics;
    rows.push_back({light.light.empty() ? page.text("all lights") : escaped_xml(light.light),
                    Page::lux(s.mean), Page::lux(s.minimum), Page::lux(s.maximum),
                    Page::ratio(s.uniformity), Page::ratio(s.diversity)});
  }
  std::string html = grid_heading(page, values.grid) +
                     Page::table("",
                                 {"", "E<sub>m</sub> " + page.said("lux"), "E<sub>min</sub>",
                                  "E<sub>max</sub>", "U<sub>o</sub>", "U<sub>d</sub>"},
                                 rows);
  html += remarks(page, values.grid);
  const measuring::GridStatistics& s = values.total().statistics;
  if (s.minimum_at_most - s.minimum.value > s.minimum.standard_error) {
    html += fmt::format(
        "<p class=\"error\">{}</p>\n",
        page.with("Of many noisy values the least is too low: the true E<sub>min</sub> lies "
                  "between {} and {} lux.",
                  number_text(s.minimum.value, 4), number_text(s.minimum_at_most, 4)));
  }
  if (!values.grid.layout) return section("grid", html);
  html += plan(values, values.total(), colours, PlanSize::whole, surroundings);
  if (values.lights.size() == 1 || values.lights.size() > most_light_plans + 1) {
    return section("grid", html);
  }
  FalseColour each = colours;
  each.scale = 0;  // its own: a weak lamp would show nothing on the scale of all
  html += "<div class=\"lights\">\n";
  for (std::size_t i = 1; i < values.lights.size(); ++i) {
    html += plan(values, values.lights[i], each, PlanSize::small, surroundings);
  }
  return section("grid", html + "</div>\n");
}

/// Side by side, under the name of their grid.
std::string maps(const Page& page, const std::vector<ReportMap>& all) {
  std::string html, grid;
  for (const ReportMap& map : all) {
    if (grid != map.values.grid.name) html += page.heading(grid = map.values.grid.name);
    html += plan(map.values, map.values.total(), map.colours, PlanSize::small, map.surroundings);
  }
  return html.empty() ? html : section("maps", html);
}

std::string tables(const Page& page, const std::vector<ReportTable>& all) {
  std::string html;
  const auto said = [&](std::vector<std::string> texts) {
    for (std::string& text : texts) text = page.text(text);
    return texts;
  };
  for (const ReportTable& table : all) {
    if (table.rows.empty()) continue;
    std::vector<std::vector<std::string>> rows;
    for (const auto& row : table.rows) rows.push_back(said(row));
    html += page.heading(table.heading) + Page::table("texts", said(table.columns), rows);
  }
  return html;
}

}  // namespace

std::string report_html(const measuring::Measurement& measurement, const ReportText& text,
                        const FalseColour& colours,
                        const std::vector<PlanSurroundings>& surroundings) {
  const Page page(text.language);
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"{2}\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<title>{0}</title>\n{1}</head>\n<body>\n",
      escaped_xml(text.title),
      page.style(text.project.name.empty() ? text.title : text.project.name), text.language);
  html += title_page(page, measurement, text);
  if (text.pictures.size() > 1) {
    std::string figures = page.heading("Pictures");
    for (const ReportPicture& picture : text.pictures) figures += page.figure(picture);
    html += section("pictures", figures);
  }
  for (std::size_t grid = 0; grid < measurement.size(); ++grid) {
    html += grid_page(page, measurement[grid], colours, surroundings[grid]);
  }
  std::string rest = tables(page, text.tables);
  if (measurement.empty()) html += std::exchange(rest, {});
  html += maps(page, text.maps) + (rest.empty() ? "<section>\n" : "<section class=\"grid\">\n");
  for (const DataSheet& sheet : text.sheets) {
    rest += fmt::format("<div class=\"sheet\">\n<h3>{}</h3>\n{}{}</div>\n",
                        escaped_xml(sheet.heading), sheet.drawing, page.list(sheet.rows));
  }
  if (!text.warnings.empty()) {
    rest += page.heading("Warnings") + "<ul>\n";
    for (const std::string& line : text.warnings) {
      rest += fmt::format("<li>{}</li>\n", escaped_xml(line));
    }
    rest += "</ul>\n";
  }
  return html + rest + page.heading("How it was measured") + page.list(text.facts) +
         "</section>\n</body>\n</html>\n";
}

}  // namespace photile::report
