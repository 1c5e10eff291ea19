#include "report/report.hpp"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "photile/errors.hpp"
#include "report/plan_drawing.hpp"
#include "report/tables.hpp"

namespace photile::report {

namespace {

constexpr std::size_t most_light_plans = 6;  ///< more do not fit on a page

constexpr const char* style = R"(<style>
body { font-family: sans-serif; font-size: 10pt; margin: 2em auto; max-width: 60em; color: #222; }
h1 { font-size: 16pt; } h2 { font-size: 12pt; margin-bottom: 0.3em; }
table { border-collapse: collapse; } th, td { padding: 0.15em 0.7em; text-align: right; }
th { border-bottom: 1px solid #222; } th:first-child, td:first-child { text-align: left; }
.error { color: #777; font-size: 85%; } .plan svg { max-width: 100%; height: auto; }
figure { display: inline-block; width: 48%; margin: 0 1% 0.8em 0; vertical-align: top; }
img { max-width: 100%; } figcaption { color: #777; }
.texts th, .texts td { text-align: left; } .target td { white-space: nowrap; }
.sign { margin-top: 2.5em; width: 100%; break-inside: avoid; }
.sign td { text-align: left; width: 33%; padding-right: 3em; padding-top: 2em; }
.sign .line { border-top: 1px solid #222; color: #777; padding-top: 0.15em; }
.lights .plan { display: inline-block; width: 32%; }
dt { float: left; clear: left; width: 11em; color: #777; } dd { margin: 0 0 0.2em 11em; }
@page { size: A4; margin: 15mm; }
@media print {
  body { margin: 0; max-width: none; font-size: 8.5pt; }
  h2 { break-after: avoid; } .plan, tr, figure { break-inside: avoid; }
  .plan svg { width: auto; height: 75mm; } .lights svg { height: 36mm; }
}
</style>
)";

std::string cell(const std::string& value, const Measured& measured) {
  return fmt::format("<td>{} <span class=\"error\">&#177; {}</span></td>", value,
                     number_text(measured.standard_error, 2));
}

std::string lux_cell(const Measured& lux) { return cell(number_text(lux.value, 4), lux); }

std::string ratio_cell(const Measured& ratio) {
  return cell(fmt::format("{:.3f}", ratio.value), ratio);
}

std::string table_row(const measuring::LightValues& light) {
  const measuring::GridStatistics& s = light.statistics;
  return fmt::format("<tr><td>{}</td>{}{}{}{}{}</tr>\n",
                     light.light.empty() ? "all lights" : escaped_xml(light.light),
                     lux_cell(s.mean), lux_cell(s.minimum), lux_cell(s.maximum),
                     ratio_cell(s.uniformity), ratio_cell(s.diversity));
}

std::string grid_heading(const measuring::SensorGrid& grid) {
  std::string text = fmt::format("{}: {} points", escaped_xml(grid.name), grid.sensors.size());
  if (!grid.layout) return text;
  const measuring::PlaneLayout& layout = *grid.layout;
  return text + fmt::format(", {:.2f} x {:.2f} m, {:.2f} m apart", glm::length(layout.u),
                            glm::length(layout.v), layout.spacing());
}

std::string judgement_row(const measuring::Judgement& judgement) {
  const bool lux = judgement.figure == "Em";
  const std::string value = lux ? lux_cell(judgement.measured)
                            : judgement.figure == "Uo"
                                ? ratio_cell(judgement.measured)
                                : fmt::format("<td>{:.1f}</td>", judgement.measured.value);
  return fmt::format("<tr><td>{}</td><td>{}</td><td>{} {:g}</td>{}<td>{}</td></tr>\n",
                     escaped_xml(judgement.grid), judgement.figure,
                     judgement.at_most ? "at most" : "at least", judgement.required, value,
                     judgement.met() ? "met" : "<b>not met</b>");
}

/// What is required, and whether it is met.
std::string target_section(const measuring::Measurement& measurement,
                           const measuring::Requirement& requirement,
                           const std::optional<measuring::Judgement>& glare) {
  std::string text = fmt::format(
      "<h2>Target: {}</h2>\n<p>{}</p>\n<table class=\"target\">\n<tr><th></th><th></th>"
      "<th>required</th><th>measured</th><th></th></tr>\n",
      escaped_xml(requirement.name),
      escaped_xml(requirement.reference.empty() ? ""
                                                : requirement.reference + ", " + requirement.what));
  for (const measuring::GridValues& values : measurement) {
    for (const measuring::Judgement& judgement : measuring::judge(values, requirement)) {
      text += judgement_row(judgement);
    }
  }
  const auto add_unjudged = [&](const char* figure, const char* limit, double required,
                                const char* where) {
    if (!(required > 0)) return;
    text += fmt::format("<tr><td></td><td>{}</td><td>{} {:g}</td><td>{}</td><td></td></tr>\n",
                        figure, limit, required, where);
  };
  if (glare) {
    text += judgement_row(*glare);
  } else {
    add_unjudged("UGR", "at most", requirement.glare, "see photile glare");
  }
  add_unjudged("Ra", "at least", requirement.rendering, "see the lamps' data sheets");
  return text + "</table>\n";
}

/// The project, and the date among the facts.
std::string project_section(const ReportText& report) {
  const ReportProject& project = report.project;
  if (!project.said()) return {};
  std::string text = "<dl class=\"project\">\n";
  for (const auto& [name, value] :
       {std::pair("project", project.name), std::pair("client", project.client),
        std::pair("designer", project.designer)}) {
    if (value.empty()) continue;
    text += fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, escaped_xml(value));
  }
  for (const auto& [name, value] : report.facts) {
    if (name == "date") text += fmt::format("<dt>date</dt><dd>{}</dd>\n", escaped_xml(value));
  }
  return text + "</dl>\n";
}

/// A line for the designer, and one for the client.
std::string sign_section(const ReportProject& project) {
  std::string text = "<table class=\"sign\">\n";
  for (const auto& [role, name] : {std::pair("designed by", project.designer),
                                   std::pair("accepted for the client by", project.client)}) {
    text += fmt::format(
        "<tr><td>{}</td><td></td><td></td></tr>\n"
        "<tr><td class=\"line\">{}</td><td class=\"line\">date</td>"
        "<td class=\"line\">signature</td></tr>\n",
        name.empty() ? "&#160;" : escaped_xml(name), role);
  }
  return text + "</table>\n";
}

std::string picture_section(const std::vector<ReportPicture>& pictures) {
  if (pictures.empty()) return {};
  std::string text = "<h2>Pictures</h2>\n<div class=\"pictures\">\n";
  for (const ReportPicture& picture : pictures) {
    text += fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"/>"
        "<figcaption>{0}</figcaption></figure>\n",
        escaped_xml(picture.caption), base64(picture.png));
  }
  return text + "</div>\n";
}

std::string table_section(const ReportTable& table) {
  if (table.rows.empty()) return {};
  std::string text =
      fmt::format("<h2>{}</h2>\n<table class=\"texts\">\n<tr>", escaped_xml(table.heading));
  for (const std::string& column : table.columns) {
    text += fmt::format("<th>{}</th>", escaped_xml(column));
  }
  text += "</tr>\n";
  for (const auto& row : table.rows) {
    text += "<tr>";
    for (const std::string& value : row) text += fmt::format("<td>{}</td>", escaped_xml(value));
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

std::string section(const measuring::GridValues& values, const FalseColour& colours,
                    const PlanSurroundings& surroundings) {
  std::string text = fmt::format(
      "<h2>{}</h2>\n<table>\n<tr><th></th><th>E<sub>m</sub> lux</th><th>E<sub>min</sub></th>"
      "<th>E<sub>max</sub></th><th>U<sub>o</sub></th><th>U<sub>d</sub></th></tr>\n",
      grid_heading(values.grid));
  for (const measuring::LightValues& light : values.lights) text += table_row(light);
  const measuring::GridStatistics& s = values.total().statistics;
  text += fmt::format(
      "</table>\n<p class=\"error\">Noise pulls the least value down: the true E<sub>min</sub> is "
      "expected between {} and {} lux, up to the errors above.</p>\n",
      number_text(s.minimum.value, 4), number_text(s.minimum_at_most, 4));
  if (!values.grid.layout) return text;
  text += "<div class=\"plan\">\n" +
          plan_svg(values, values.total(), colours, PlanSize::whole, surroundings) + "</div>\n";
  if (values.lights.size() == 1 || values.lights.size() > most_light_plans + 1) return text;
  text += "<div class=\"lights\">\n";
  FalseColour each = colours;
  each.scale = 0;  // its own: a weak lamp would show nothing on the scale of all
  for (std::size_t i = 1; i < values.lights.size(); ++i) {
    text += "<div class=\"plan\">\n" +
            plan_svg(values, values.lights[i], each, PlanSize::small, surroundings) + "</div>\n";
  }
  return text + "</div>\n";
}

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t byte = 0; byte < 3; ++byte) {
      bits = bits << 8 | (byte < count ? static_cast<unsigned char>(bytes[i + byte]) : 0u);
    }
    for (std::size_t digit = 0; digit < 4; ++digit) {
      text += digit <= count ? digits[bits >> (18 - 6 * digit) & 63u] : '=';
    }
  }
  return text;
}

std::string report_html(const measuring::Measurement& measurement, const ReportText& text,
                        const FalseColour& colours,
                        const std::vector<PlanSurroundings>& surroundings) {
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n<title>{0}</title>\n"
      "{1}</head>\n<body>\n<h1>Illuminance: {0}</h1>\n",
      escaped_xml(text.title), style);
  page += project_section(text);
  if (text.requirement) page += target_section(measurement, *text.requirement, text.glare);
  page += picture_section(text.pictures);
  for (std::size_t grid = 0; grid < measurement.size(); ++grid) {
    page += section(measurement[grid], colours, surroundings[grid]);
  }
  for (const ReportTable& table : text.tables) page += table_section(table);
  page += "<h2>How it was measured</h2>\n<dl>\n";
  for (const auto& [name, value] : text.facts) {
    page += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped_xml(name), escaped_xml(value));
  }
  page += "</dl>\n";
  if (text.project.said()) page += sign_section(text.project);
  return page + "</body>\n</html>\n";
}

namespace {

/// In quotes for the shell.
std::string quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

std::string pdf_of(const std::string& html) {
  const ScratchFolder folder;
  const std::filesystem::path page = folder.path() / "page.html";
  write_file(page, html);
  const std::string command = "weasyprint " + quoted(page.string()) + " - 2> /dev/null";
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) throw OutputError("cannot start weasyprint; write .html, and print that");
  std::string pdf;
  std::array<char, 1 << 16> buffer;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    pdf.append(buffer.data(), count);
  }
  if (pclose(pipe) != 0 || !pdf.starts_with("%PDF")) {
    throw OutputError(
        "weasyprint cannot print the page; install Debian's package weasyprint, or write .html and "
        "print that");
  }
  return pdf;
}

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "photile-XXXXXX").string();
  if (!mkdtemp(name.data())) {
    throw OutputError(name +
                      ": cannot make a temporary folder; set TMPDIR to one that can be written");
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace photile::report
