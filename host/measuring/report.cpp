#include "measuring/report.hpp"

#include <fmt/format.h>

#include <cstddef>

#include "measuring/plan_drawing.hpp"
#include "xml_text.hpp"

namespace photile::measuring {
namespace {

constexpr std::size_t most_light_plans = 6;  ///< more do not fit on a page

constexpr const char* style = R"(<style>
body { font-family: sans-serif; font-size: 10pt; margin: 2em auto; max-width: 60em; color: #222; }
h1 { font-size: 16pt; } h2 { font-size: 12pt; margin-bottom: 0.3em; }
table { border-collapse: collapse; } th, td { padding: 0.15em 0.7em; text-align: right; }
th { border-bottom: 1px solid #222; } th:first-child, td:first-child { text-align: left; }
.error { color: #777; font-size: 85%; } .plan svg { max-width: 100%; height: auto; }
.lights { display: grid; grid-template-columns: repeat(3, 1fr); gap: 0.5em; }
@page { size: A4; margin: 15mm; } @media print { body { margin: 0; } }
</style>
)";

std::string cell(const Measured& measured, const char* format) {
  const std::string value = fmt::format(fmt::runtime(format), measured.value);
  return fmt::format("<td>{} <span class=\"error\">&#177; {:.2g}</span></td>", value,
                     measured.standard_error);
}

std::string table_row(const LightValues& light) {
  const GridStatistics& s = light.statistics;
  return fmt::format("<tr><td>{}</td>{}{}{}{}{}</tr>\n",
                     light.light.empty() ? "all lights" : escaped_xml(light.light),
                     cell(s.mean, "{:.4g}"), cell(s.minimum, "{:.4g}"), cell(s.maximum, "{:.4g}"),
                     cell(s.uniformity, "{:.3f}"), cell(s.diversity, "{:.3f}"));
}

std::string grid_heading(const SensorGrid& grid) {
  std::string text = fmt::format("{}: {} points", escaped_xml(grid.name), grid.sensors.size());
  if (!grid.layout) return text;
  const PlaneLayout& layout = *grid.layout;
  return text + fmt::format(", {:.2f} x {:.2f} m, {:.2f} m apart", glm::length(layout.u),
                            glm::length(layout.v), layout.spacing());
}

std::string section(const GridValues& values, const FalseColour& colours) {
  std::string text = fmt::format(
      "<h2>{}</h2>\n<table>\n<tr><th></th><th>E<sub>m</sub> lux</th><th>E<sub>min</sub></th>"
      "<th>E<sub>max</sub></th><th>U<sub>o</sub></th><th>U<sub>d</sub></th></tr>\n",
      grid_heading(values.grid));
  for (const LightValues& light : values.lights) text += table_row(light);
  const GridStatistics& s = values.total().statistics;
  text += fmt::format(
      "</table>\n<p class=\"error\">Noise pulls the least value down: the true E<sub>min</sub> is "
      "expected between {:.4g} and {:.4g} lux, up to the errors above.</p>\n",
      s.minimum.value, s.minimum_at_most);
  if (!values.grid.layout) return text;
  text += "<div class=\"plan\">\n" + plan_svg(values, values.total(), colours) + "</div>\n";
  if (values.lights.size() == 1 || values.lights.size() > most_light_plans + 1) return text;
  text += "<div class=\"lights\">\n";
  FalseColour each = colours;
  each.scale = 0;  // its own: a weak lamp would show nothing on the scale of all
  for (std::size_t i = 1; i < values.lights.size(); ++i) {
    text += "<div class=\"plan\">\n" + plan_svg(values, values.lights[i], each) + "</div>\n";
  }
  return text + "</div>\n";
}

}  // namespace

std::string report_html(const Measurement& measurement, const ReportText& text,
                        const FalseColour& colours) {
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{0}</title>\n"
      "{1}</head>\n<body>\n<h1>Illuminance: {0}</h1>\n",
      escaped_xml(text.title), style);
  for (const GridValues& values : measurement) page += section(values, colours);
  page += "<h2>How it was measured</h2>\n<table>\n";
  for (const auto& [name, value] : text.facts) {
    page += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escaped_xml(name), escaped_xml(value));
  }
  return page + "</table>\n</body>\n</html>\n";
}

}  // namespace photile::measuring
