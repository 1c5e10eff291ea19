#include "report/page.hpp"

#include "report/printing.hpp"
#include "report/tables.hpp"

namespace photile::report {

namespace {

constexpr const char* rules = R"(<style>
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
.sign tr:nth-child(even) td { border-top: 1px solid #222; color: #777; padding-top: 0.15em; }
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

/// Within a string of a style sheet within a page.
std::string css_text(const std::string& text) {
  std::string safe;
  for (const char c : utf8_of(text)) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = byte >= 0x20 && std::string_view("\"\\<>&").find(c) == std::string::npos;
    safe += plain ? std::string(1, c) : fmt::format("\\{:x} ", byte);
  }
  return safe;
}

std::string cell(const std::string& value, const Measured& measured) {
  return fmt::format("{} <span class=\"error\">&#177; {}</span>", value,
                     number_text(measured.standard_error, 2));
}

}  // namespace

std::string Page::list(const std::vector<std::pair<std::string, std::string>>& pairs,
                       std::string_view kind) const {
  std::string items;
  for (const auto& [name, value] : pairs) {
    if (!value.empty()) items += fmt::format("<dt>{}</dt><dd>{}</dd>\n", text(name), text(value));
  }
  return items.empty() ? items : fmt::format("<dl class=\"{}\">\n{}</dl>\n", kind, items);
}

std::string Page::table(std::string_view kind, const std::vector<std::string>& head,
                        const std::vector<std::vector<std::string>>& rows) {
  std::string html = kind.empty() ? "<table>\n" : fmt::format("<table class=\"{}\">\n", kind);
  const auto add = [&](const char* tag, const std::vector<std::string>& cells) {
    html += "<tr>";
    for (const std::string& content : cells) html += fmt::format("<{0}>{1}</{0}>", tag, content);
    html += "</tr>\n";
  };
  if (!head.empty()) add("th", head);
  for (const auto& row : rows) add("td", row);
  return html + "</table>\n";
}

std::string Page::figure(const ReportPicture& picture) const {
  return fmt::format(
      "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"/>"
      "<figcaption>{0}</figcaption></figure>\n",
      text(picture.caption) + (picture.values.empty() ? "" : ": " + text(picture.values)),
      base64(picture.png));
}

std::string Page::lux(const Measured& lux) { return cell(number_text(lux.value, 4), lux); }

std::string Page::ratio(const Measured& ratio) {
  return cell(fmt::format("{:.3f}", ratio.value), ratio);
}

std::string Page::style(const std::string& name) const {
  return rules + fmt::format(
                     "@page {{ size: A4; margin: 15mm 15mm 18mm 15mm;\n"
                     "  @bottom-left {{ content: \"{}\"; font: 8pt sans-serif; color: #777; }}\n"
                     "  @bottom-right {{ content: \"{} \" counter(page) \" {} \" counter(pages);\n"
                     "    font: 8pt sans-serif; color: #777; }} }}\n</style>\n",
                     css_text(name), said("page"), said("of"));
}

}  // namespace photile::report
