#include "report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "common/foreign_text.hpp"
#include "report/plan_drawing.hpp"
#include "report/printing.hpp"
#include "report/tables.hpp"
#include "report/words.hpp"

namespace photile::report {

namespace {

constexpr std::size_t most_light_plans = 6;  ///< more do not fit on a page

constexpr const char* style = R"(<style>
body { font-family: sans-serif; font-size: 10pt; margin: 2em auto; max-width: 60em; color: #222; }
h1 { font-size: 18pt; } h2 { font-size: 12pt; margin-bottom: 0.3em; }
h3 { font-size: 10pt; margin: 0 0 0.3em 0; }
table { border-collapse: collapse; } th, td { padding: 0.15em 0.7em; text-align: right; }
th { border-bottom: 1px solid #222; } th:first-child, td:first-child { text-align: left; }
.error { color: #777; font-size: 85%; } .plan svg { max-width: 100%; }
figure { display: inline-block; width: 48%; margin: 0 1% 0.8em 0; vertical-align: top; }
img { max-width: 100%; } figcaption { color: #777; }
.title figure { float: right; width: 52%; margin: 0 0 1em 1em; } .title h2 { clear: none; }
.title .logo { float: right; max-width: 45mm; max-height: 18mm; }
.about { width: 45%; } .about dt { width: 11em; } .about dd { margin-left: 11em; }
.end { clear: both; }
.texts th, .texts td { text-align: left; } .target td { white-space: nowrap; }
.sign { margin-top: 1.5em; width: 100%; break-inside: avoid; }
.sign td { text-align: left; width: 33%; padding-right: 3em; padding-top: 1.6em; }
.sign .line { border-top: 1px solid #222; color: #777; padding-top: 0.15em; }
.lights .plan { display: inline-block; width: 32%; }
.maps .plan { display: inline-block; width: 48%; } .maps svg { width: 100%; height: auto; }
.sheet { display: inline-block; width: 48%; margin: 0 1% 1em 0; vertical-align: top; }
dl { margin: 0.3em 0; }
dt { float: left; clear: left; width: 13em; color: #777; } dd { margin: 0 0 0.2em 13em; }
.sheet dt { width: 9em; } .sheet dd { margin-left: 9em; }
@media print {
  body { margin: 0; max-width: none; font-size: 8.5pt; }
  h2 { break-after: avoid; } .plan, tr, figure, .sheet { break-inside: avoid; }
  .grid, .grid + .maps, .title + .pictures { break-before: page; }
  .plan svg { max-width: none; } .lights svg { height: 36mm; width: auto; }
}
)";

/// A report under way, in its language.
class Page {
 public:
  explicit Page(const ReportText& report) : report_(report) {}

  std::string said(std::string_view english) const { return translated(english, report_.language); }

  template <class... T>
  std::string with(std::string_view english, const T&... values) const {
    return fmt::format(fmt::runtime(said(english)), values...);
  }

  std::string styles() const {
    return style +
           fmt::format(
               "@page {{ size: A4; margin: 15mm 15mm 18mm 15mm;\n"
               "  @bottom-left {{ content: \"{}\"; font: 8pt sans-serif; color: #777; }}\n"
               "  @bottom-right {{ content: \"{} \" counter(page) \" {} \" counter(pages);\n"
               "    font: 8pt sans-serif; color: #777; }} }}\n</style>\n",
               css_text(report_.project.name.empty() ? report_.title : report_.project.name),
               said("page"), said("of"));
  }

  std::string title(const measuring::Measurement& measurement) const {
    const bool named = !report_.project.name.empty();
    std::string text = "<section class=\"title\">\n";
    if (!report_.logo.empty()) {
      text += fmt::format("<img class=\"logo\" alt=\"\" src=\"{}\"/>\n", report_.logo);
    }
    text += fmt::format(
        "<h1>{}</h1>\n",
        escaped_xml(named ? report_.project.name : said(report_.subject) + ": " + report_.title));
    std::vector<std::pair<std::string, std::string>> about;
    if (report_.project.said()) {
      about = {{"project", report_.project.name},
               {"client", report_.project.client},
               {"designer", report_.project.designer},
               {"scene", report_.title}};
      for (const auto& fact : report_.facts) {
        if (fact.first == "date") about.push_back(fact);
      }
    }
    if (!report_.pictures.empty()) text += figure(report_.pictures.front());
    text += "<div class=\"about\">\n" + list(about, "project");
    if (!report_.room.empty()) text += heading("Room") + list(report_.room);
    if (!report_.energy.empty()) text += heading("Energy") + list(report_.energy);
    text += "</div>\n<div class=\"end\"></div>\n";
    if (report_.requirement) {
      text += target(measurement, *report_.requirement);
    } else if (!measurement.empty()) {
      text += summary(measurement);
    }
    if (report_.project.said()) text += sign();
    return text + "</section>\n";
  }

  std::string pictures() const {
    if (report_.pictures.size() < 2) return {};
    std::string text = "<section class=\"pictures\">\n" + heading("Pictures");
    for (const ReportPicture& picture : report_.pictures) text += figure(picture);
    return text + "</section>\n";
  }

  std::string grid(const measuring::GridValues& values, const FalseColour& colours,
                   const PlanSurroundings& surroundings) const {
    std::string text = fmt::format(
        "<section class=\"grid\">\n<h2>{}</h2>\n<table>\n<tr><th></th><th>E<sub>m</sub> {}</th>"
        "<th>E<sub>min</sub></th><th>E<sub>max</sub></th><th>U<sub>o</sub></th>"
        "<th>U<sub>d</sub></th></tr>\n",
        grid_heading(values.grid), said("lux"));
    for (const measuring::LightValues& light : values.lights) text += light_row(light);
    const measuring::GridStatistics& s = values.total().statistics;
    text += "</table>\n";
    const std::string least = number_text(s.minimum.value, 4),
                      most = number_text(s.minimum_at_most, 4);
    if (s.minimum_at_most - s.minimum.value > s.minimum.standard_error) {
      text += fmt::format(
          "<p class=\"error\">{}</p>\n",
          with(
              "Of many noisy values the least is too low: the true E<sub>min</sub> lies between {} "
              "and {} lux.",
              least, most));
    }
    if (!values.grid.layout) return text + "</section>\n";
    text += "<div class=\"plan\">\n" +
            plan_svg(values, values.total(), colours, PlanSize::whole, surroundings) + "</div>\n";
    if (values.lights.size() == 1 || values.lights.size() > most_light_plans + 1) {
      return text + "</section>\n";
    }
    text += "<div class=\"lights\">\n";
    FalseColour each = colours;
    each.scale = 0;  // its own: a weak lamp would show nothing on the scale of all
    for (std::size_t i = 1; i < values.lights.size(); ++i) {
      text += "<div class=\"plan\">\n" +
              plan_svg(values, values.lights[i], each, PlanSize::small, surroundings) + "</div>\n";
    }
    return text + "</div>\n</section>\n";
  }

  std::string table(const ReportTable& table) const {
    if (table.rows.empty()) return {};
    std::string text = heading(table.heading) + "<table class=\"texts\">\n<tr>";
    for (const std::string& column : table.columns) {
      text += fmt::format("<th>{}</th>", escaped_xml(said(column)));
    }
    text += "</tr>\n";
    for (const auto& row : table.rows) {
      text += "<tr>";
      for (const std::string& value : row) {
        text += fmt::format("<td>{}</td>", escaped_xml(said(value)));
      }
      text += "</tr>\n";
    }
    return text + "</table>\n";
  }

  /// Side by side, under the name of their grid.
  std::string maps() const {
    std::string text, grid;
    for (const ReportMap& map : report_.maps) {
      if (grid != map.values.grid.name) {
        grid = map.values.grid.name;
        text += fmt::format("<h2>{}</h2>\n", escaped_xml(said(grid)));
      }
      text +=
          "<div class=\"plan\">\n" +
          plan_svg(map.values, map.values.total(), map.colours, PlanSize::small, map.surroundings) +
          "</div>\n";
    }
    return text.empty() ? text : "<section class=\"maps\">\n" + text + "</section>\n";
  }

  std::string sheets() const {
    std::string text;
    for (const DataSheet& sheet : report_.sheets) {
      text += fmt::format("<div class=\"sheet\">\n<h3>{}</h3>\n{}{}</div>\n",
                          escaped_xml(sheet.heading), sheet.drawing, list(sheet.rows));
    }
    return text;
  }

  std::string heading(std::string_view english) const {
    return fmt::format("<h2>{}</h2>\n", escaped_xml(said(english)));
  }

  std::string list(const std::vector<std::pair<std::string, std::string>>& pairs,
                   std::string_view kind = "facts") const {
    std::string text;
    for (const auto& [name, value] : pairs) {
      if (value.empty()) continue;
      text += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped_xml(said(name)),
                          escaped_xml(said(value)));
    }
    return text.empty() ? text : fmt::format("<dl class=\"{}\">\n{}</dl>\n", kind, text);
  }

 private:
  /// Within a string of a style sheet within a page.
  static std::string css_text(const std::string& text) {
    std::string safe;
    for (const char c : utf8_of(text)) {
      const auto byte = static_cast<unsigned char>(c);
      const bool plain = byte >= 0x20 && std::string_view("\"\\<>&").find(c) == std::string::npos;
      safe += plain ? std::string(1, c) : fmt::format("\\{:x} ", byte);
    }
    return safe;
  }

  static std::string cell(const std::string& value, const Measured& measured) {
    return fmt::format("<td>{} <span class=\"error\">&#177; {}</span></td>", value,
                       number_text(measured.standard_error, 2));
  }
  static std::string lux_cell(const Measured& lux) { return cell(number_text(lux.value, 4), lux); }
  static std::string ratio_cell(const Measured& ratio) {
    return cell(fmt::format("{:.3f}", ratio.value), ratio);
  }

  std::string light_row(const measuring::LightValues& light) const {
    const measuring::GridStatistics& s = light.statistics;
    return fmt::format("<tr><td>{}</td>{}{}{}{}{}</tr>\n",
                       escaped_xml(light.light.empty() ? said("all lights") : light.light),
                       lux_cell(s.mean), lux_cell(s.minimum), lux_cell(s.maximum),
                       ratio_cell(s.uniformity), ratio_cell(s.diversity));
  }

  std::string grid_heading(const measuring::SensorGrid& grid) const {
    std::string text = with("{}: {} points", said(grid.name), grid.sensors.size());
    if (grid.layout) {
      const measuring::PlaneLayout& layout = *grid.layout;
      text += with(", {:.2f} x {:.2f} m, {:.2f} m apart", glm::length(layout.u),
                   glm::length(layout.v), layout.spacing());
    }
    return escaped_xml(text);
  }

  std::string judgement_row(const measuring::Judgement& judgement) const {
    const std::string value = judgement.figure == "Em" ? lux_cell(judgement.measured)
                              : judgement.figure == "Uo"
                                  ? ratio_cell(judgement.measured)
                                  : fmt::format("<td>{:.1f}</td>", judgement.measured.value);
    return fmt::format("<tr><td>{}</td><td>{}</td><td>{} {:g}</td>{}<td>{}</td></tr>\n",
                       escaped_xml(said(judgement.grid)), judgement.figure,
                       said(judgement.at_most ? "at most" : "at least"), judgement.required, value,
                       met(judgement.met()));
  }

  std::string met(bool is) const { return is ? said("met") : "<b>" + said("not met") + "</b>"; }

  /// What is required, and whether it is met.
  std::string target(const measuring::Measurement& measurement,
                     const measuring::Requirement& requirement) const {
    std::string text = fmt::format(
        "<h2>{}: {}</h2>\n<p>{}</p>\n<table class=\"target\">\n<tr><th></th><th></th><th>{}</th>"
        "<th>{}</th><th></th></tr>\n",
        said("Key figures"), escaped_xml(requirement.name),
        escaped_xml(
            requirement.reference.empty() ? "" : requirement.reference + ", " + requirement.what),
        said("required"), said("measured"));
    for (const measuring::GridValues& values : measurement) {
      for (const measuring::Judgement& judgement : measuring::judge(values, requirement)) {
        text += judgement_row(judgement);
      }
    }
    const auto add = [&](const char* figure, const char* limit, double required,
                         const std::string& value, const std::string& verdict) {
      if (!(required > 0)) return;
      text += fmt::format("<tr><td></td><td>{}</td><td>{} {:g}</td><td>{}</td><td>{}</td></tr>\n",
                          figure, said(limit), required, value, verdict);
    };
    if (report_.glare) {
      text += judgement_row(*report_.glare);
    } else {
      add("UGR", "at most", requirement.glare, said("see photile glare"), "");
    }
    const double ra = report_.rendering;
    add("Ra", "at least", requirement.rendering,
        ra > 0 ? fmt::format("{:g}, {}", ra, said("by the luminaires' data sheets"))
               : said("see the luminaires' data sheets"),
        ra > 0 ? met(ra >= requirement.rendering) : "");
    return text + "</table>\n";
  }

  /// The figures of all grids, where nothing is required.
  std::string summary(const measuring::Measurement& measurement) const {
    std::string text = heading("Key figures") +
                       fmt::format(
                           "<table class=\"target\">\n<tr><th></th><th>E<sub>m</sub> {}</th>"
                           "<th>U<sub>o</sub></th></tr>\n",
                           said("lux"));
    for (const measuring::GridValues& values : measurement) {
      const measuring::GridStatistics& s = values.total().statistics;
      text += fmt::format("<tr><td>{}</td>{}{}</tr>\n", escaped_xml(said(values.grid.name)),
                          lux_cell(s.mean), ratio_cell(s.uniformity));
    }
    return text + "</table>\n";
  }

  /// A line for the designer, and one for the client.
  std::string sign() const {
    std::string text = "<table class=\"sign\">\n";
    for (const auto& [role, name] :
         {std::pair("designed by", report_.project.designer),
          std::pair("accepted for the client by", report_.project.client)}) {
      text += fmt::format(
          "<tr><td>{}</td><td></td><td></td></tr>\n"
          "<tr><td class=\"line\">{}</td><td class=\"line\">{}</td>"
          "<td class=\"line\">{}</td></tr>\n",
          name.empty() ? "&#160;" : escaped_xml(name), said(role), said("date"), said("signature"));
    }
    return text + "</table>\n";
  }

  std::string figure(const ReportPicture& picture) const {
    return fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"/>"
        "<figcaption>{0}</figcaption></figure>\n",
        escaped_xml(said(picture.caption) +
                    (picture.values.empty() ? "" : ": " + said(picture.values))),
        base64(picture.png));
  }

  const ReportText& report_;
};

}  // namespace

std::string report_html(const measuring::Measurement& measurement, const ReportText& text,
                        const FalseColour& colours,
                        const std::vector<PlanSurroundings>& surroundings) {
  const Page page(text);
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"{2}\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<title>{0}</title>\n{1}</head>\n<body>\n",
      escaped_xml(text.title), page.styles(), text.language);
  html += page.title(measurement) + page.pictures();
  for (std::size_t grid = 0; grid < measurement.size(); ++grid) {
    html += page.grid(measurement[grid], colours, surroundings[grid]);
  }
  std::string tables;
  for (const ReportTable& table : text.tables) tables += page.table(table);
  if (measurement.empty()) html += std::exchange(tables, {});
  html += page.maps() + (tables.empty() ? "<section>\n" : "<section class=\"grid\">\n") + tables +
          page.sheets();
  html += page.heading("How it was measured") + page.list(text.facts);
  return html + "</section>\n</body>\n</html>\n";
}

}  // namespace photile::report
