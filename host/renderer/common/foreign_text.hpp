// Text from outside, such as names in scenes and of files, converted for the output that it is
// written to: all such conversions of photile, one function for each kind of output.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>

namespace photile {

/// The length in bytes of the UTF-8 sequence at the start of a non-empty text, or 0 where there is
/// no valid one.
std::size_t utf8_sequence_length(std::string_view text);

/// Bytes that are not UTF-8 become U+FFFD.
std::string utf8_of(std::string_view text);

/// UTF-8 without commands for a terminal: control characters except tabs and line ends become '?'.
std::string terminal_text(std::string_view text);

/// The same in one line: control characters become blanks, and line ends at its end are removed.
std::string one_line(std::string_view text);

/// Bytes of a name, or of other text of a file, that a message quotes.
inline constexpr std::size_t longest_quote = 80;

/// Text of at most this many bytes: longer text is cut between characters, and ends in "...".
std::string shortened(std::string_view text, std::size_t most);

/// Content of XML and HTML, or an attribute's value in double quotes, in UTF-8. Characters that XML
/// cannot hold become '?'.
std::string escaped_xml(std::string_view text);

/// A field as in RFC 4180: quoted where necessary, also for other separators. What a
/// spreadsheet would take for a formula, after blanks of any kind, begins with an apostrophe.
std::string csv_field(std::string_view text);

/// JSON and a line end; bytes that are not UTF-8 become U+FFFD.
///   indent   blanks a level; -1 = all in one line
template <class Json>
std::string json_text(const Json& json, int indent = 1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// While it lives, everything written to a stream passes through terminal_text.
class TerminalText : public std::streambuf {
 public:
  explicit TerminalText(std::ostream& stream) : stream_(stream), sink_(stream.rdbuf(this)) {}
  TerminalText(const TerminalText&) = delete;
  TerminalText& operator=(const TerminalText&) = delete;
  ~TerminalText() override;

 protected:
  int_type overflow(int_type c) override;
  std::streamsize xsputn(const char* text, std::streamsize count) override;
  int sync() override;

 private:
  bool put(std::string_view text);

  std::ostream& stream_;
  std::streambuf* const sink_;
  std::string line_;  ///< the line that has no end yet
};

}  // namespace photile
