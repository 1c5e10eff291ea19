// What pages of a report are made of: its words in a language, headings, lists, tables, figures.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/foreign_text.hpp"
#include "measuring/measurement.hpp"
#include "report/report.hpp"

namespace photile::report {

/// "en", "de".
const std::vector<std::string>& languages();

/// A text of reports in one of the languages; one that no table has stays English.
std::string translated(std::string_view english, std::string_view language);

/// Writes HTML. English texts are translated.
class Page {
 public:
  explicit Page(std::string language) : language_(std::move(language)) {}

  std::string said(std::string_view english) const { return translated(english, language_); }
  /// As content of the page.
  std::string text(std::string_view english) const { return escaped_xml(said(english)); }
  template <class... T>
  std::string with(std::string_view english, const T&... values) const {
    return fmt::format(fmt::runtime(said(english)), values...);
  }

  std::string heading(std::string_view english) const {
    return fmt::format("<h2>{}</h2>\n", text(english));
  }

  /// Names and values, but those that are empty.
  std::string list(const std::vector<std::pair<std::string, std::string>>& pairs,
                   std::string_view kind = "facts") const;

  /// Cells are content of the page.
  ///   kind   its class in the style; "" = none
  ///   head   may be empty
  static std::string table(std::string_view kind, const std::vector<std::string>& head,
                           const std::vector<std::vector<std::string>>& rows);

  std::string figure(const ReportPicture& picture) const;

  /// Cells: a value with its standard error.
  static std::string lux(const Measured& lux);
  static std::string ratio(const Measured& ratio);

  /// The style of all pages, which bear a name at their feet.
  std::string style(const std::string& name) const;

 private:
  std::string language_;
};

/// The first page: the project, a picture, what is required and whether it is met, the room, its
/// energy and lines to sign on.
std::string title_page(const Page& page, const measuring::Measurement& measurement,
                       const ReportText& report);

}  // namespace photile::report
