// Names of others, such as none would give a lamp, in each kind of output.
#include "common/foreign_text.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace photile::test {
namespace {

/// Bytes at random, among which those that mean something are frequent.
std::string any_text(std::mt19937& dice) {
  std::vector<std::string> pieces{
      "]]>",          "<!--",         "</script>",        "\x1B[2J",  "\2332J",       "\xC2\x9B",
      "\xC3\xA9",     "\xE2\x82\xAC", "\xF0\x9F\x92\xA1", "\xE2\x82", "\xED\xA0\x80", "\xC0\xAF",
      "\xEF\xBF\xBF", "lamp"};
  // And of one byte each, with the 0 at their end.
  for (const char one : "=+-@\t\r\n\",;<>&' \\\x7F\xC3\xFF") pieces.emplace_back(1, one);
  std::string text;
  const int count = std::uniform_int_distribution(0, 8)(dice);
  for (int i = 0; i < count; ++i) {
    text += pieces[std::uniform_int_distribution<std::size_t>(0, pieces.size() - 1)(dice)];
  }
  return text;
}

/// The code points of UTF-8; fails where it is none. By the table of RFC 3629.
std::vector<char32_t> decoded(const std::string& text) {
  std::vector<char32_t> codes;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t at) {
      REQUIRE(at < text.size());
      return static_cast<unsigned char>(text[at]);
    };
    const int length = byte(i) < 0x80 ? 1 : byte(i) < 0xE0 ? 2 : byte(i) < 0xF0 ? 3 : 4;
    REQUIRE((byte(i) < 0x80 || byte(i) >= 0xC2));
    REQUIRE(byte(i) <= 0xF4);
    char32_t code = length == 1 ? byte(i) : byte(i) & (0xFF >> (length + 1));
    for (int k = 1; k < length; ++k) {
      REQUIRE((byte(i + static_cast<std::size_t>(k)) & 0xC0) == 0x80);
      code = code << 6 | (byte(i + static_cast<std::size_t>(k)) & 0x3F);
    }
    const char32_t least[] = {0, 0x80, 0x800, 0x10000};
    REQUIRE(code >= least[length - 1]);
    REQUIRE((code < 0xD800 || code > 0xDFFF));
    REQUIRE(code <= 0x10FFFF);
    codes.push_back(code);
    i += static_cast<std::size_t>(length);
  }
  return codes;
}

bool is_control(char32_t code) { return code < 0x20 || (code >= 0x7F && code < 0xA0); }

/// The fields of a line of RFC 4180.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      const bool doubled = quoted && i + 1 < line.size() && line[i + 1] == '"';
      if (doubled) fields.back() += line[++i];
      if (!doubled) quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      fields.emplace_back();
    } else {
      REQUIRE((quoted || (line[i] != '\n' && line[i] != '\r')));
      fields.back() += line[i];
    }
  }
  REQUIRE_FALSE(quoted);
  return fields;
}

}  // namespace

TEST_CASE("UTF-8 stays, and other bytes become U+FFFD each") {
  CHECK(utf8_of("caf\xC3\xA9 \xF0\x9F\x92\xA1") == "caf\xC3\xA9 \xF0\x9F\x92\xA1");
  CHECK(utf8_of("caf\xE9") == "caf\xEF\xBF\xBD");
  CHECK(utf8_of("\xED\xA0\x80") ==
        "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD");  // half a surrogate pair
}

TEST_CASE("whatever a name is, each kind of output holds it as text") {
  std::mt19937 dice(7);
  for (int turn = 0; turn < 20'000; ++turn) {
    const std::string text = any_text(dice);
    CAPTURE(text);
    for (const char32_t code : decoded(terminal_text(text))) {
      REQUIRE((!is_control(code) || code == '\n' || code == '\t'));
    }
    for (const char32_t code : decoded(one_line(text))) REQUIRE_FALSE(is_control(code));

    const std::string xml = escaped_xml(text);
    REQUIRE(xml.find_first_of("<>\"") == std::string::npos);
    for (const char32_t code : decoded(xml)) {
      REQUIRE_FALSE(is_control(code));
      REQUIRE((code != 0xFFFE && code != 0xFFFF));
    }
    for (std::size_t at = xml.find('&'); at != std::string::npos; at = xml.find('&', at + 1)) {
      const std::string entity = xml.substr(at, xml.find(';', at) - at);
      const bool known =
          entity == "&amp" || entity == "&lt" || entity == "&gt" || entity == "&quot";
      REQUIRE(known);
    }

    const std::vector<std::string> fields = fields_of("1," + csv_field(text) + ",2");
    REQUIRE(fields.size() == 3);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    const bool formula = text.starts_with('\t') || text.starts_with('\r') ||
                         (first < text.size() && std::string("=+-@").find(text[first]) < 4);
    REQUIRE(fields[1].ends_with(utf8_of(text)));
    if (formula) REQUIRE(fields[1] == "'" + utf8_of(text));

    const auto json = nlohmann::json::parse(json_text(nlohmann::json{{"name", text}}));
    decoded(json["name"]);
    if (utf8_of(text) == text) REQUIRE(json["name"] == text);

    const std::string cut = shortened(utf8_of(text), 10);
    decoded(cut);
    REQUIRE(cut.size() <= 10);
  }
}

TEST_CASE("no cell of a table begins as a formula does") {
  using namespace std::string_literals;
  for (const auto& blank :
       {""s, " "s, "\n"s, "\x01"s, "\xEF\xBB\xBF"s, "\xC2\xA0"s, "\xE3\x80\x80"s}) {
    for (const auto& sign : {"="s, "+"s, "-"s, "@"s, "\xEF\xBC\x9D"s, "\xEF\xBC\xA0"s}) {
      CAPTURE(blank, sign);
      CHECK(fields_of(csv_field(blank + sign + "1")).front() == "'" + blank + sign + "1");
    }
  }
  for (const auto& text : {"a=1"s, " lamp"s, "3 - 1"s, "caf\xC3\xA9"s, ""s})
    CHECK(csv_field(text) == text);
  CHECK(csv_field("a;=1") == "\"a;=1\"");  // where tables are separated so
}

TEST_CASE("a stream shows what it is given in whole lines, and the rest when it is flushed") {
  std::ostringstream terminal;
  {
    std::ostream output(terminal.rdbuf());
    const TerminalText filter(output);
    output << "lamp \x1B[31m" << 5 << "\n\tcaf\xC3";
    CHECK(terminal.str() == "lamp ?[31m5\n");
    output << "\xA9" << std::flush;
    CHECK(terminal.str() == "lamp ?[31m5\n\tcaf\xC3\xA9");
    output << "the end";
  }
  CHECK(terminal.str() == "lamp ?[31m5\n\tcaf\xC3\xA9the end");
}

}  // namespace photile::test
