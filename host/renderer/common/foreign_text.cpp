#include "common/foreign_text.hpp"

namespace photile {

namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";  // U+FFFD

/// Calls visit(sequence, code) for each character; those that are no UTF-8 count as U+FFFD.
template <class Visit>
void for_each_character(std::string_view text, const Visit& visit) {
  while (!text.empty()) {
    const std::size_t length = utf8_sequence_length(text);
    const std::string_view sequence = length == 0 ? replacement : text.substr(0, length);
    char32_t code = static_cast<unsigned char>(sequence.front());
    if (sequence.size() > 1) code &= 0x7Fu >> sequence.size();
    for (const char c : sequence.substr(1))
      code = code << 6 | (static_cast<unsigned char>(c) & 0x3F);
    visit(sequence, code);
    text.remove_prefix(length == 0 ? 1 : length);
  }
}

/// C0, DEL and C1.
bool is_control(char32_t code) { return code < 0x20 || (code >= 0x7F && code < 0xA0); }

/// Blanks of any width, with ink or without, that spreadsheets pass over.
bool is_blank(char32_t code) {
  return code <= ' ' || is_control(code) || code == 0xA0 || code == 0xAD || code == 0x1680 ||
         (code >= 0x2000 && code <= 0x200F) || (code >= 0x2028 && code <= 0x202F) ||
         (code >= 0x205F && code <= 0x206F) || code == 0x3000 || code == 0xFEFF;
}

/// Whether the first character that is no blank is one of =+-@, also in full width.
bool begins_formula(std::string_view text) {
  constexpr char32_t full_width = 0xFEE0;  // more than ASCII
  char32_t first = 0;
  for_each_character(text, [&](std::string_view, char32_t code) {
    if (first == 0 && !is_blank(code)) first = code > full_width ? code - full_width : code;
  });
  return first == '=' || first == '+' || first == '-' || first == '@';
}

}  // namespace

std::size_t utf8_sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  std::size_t length = 0;
  unsigned lowest = 0x80, highest = 0xBF;  // of the second byte: none too long, no surrogates
  if (byte(0) < 0x80) return 1;
  if (byte(0) >= 0xC2 && byte(0) <= 0xDF) length = 2;
  if (byte(0) >= 0xE0 && byte(0) <= 0xEF) length = 3;
  if (byte(0) >= 0xF0 && byte(0) <= 0xF4) length = 4;
  if (byte(0) == 0xE0) lowest = 0xA0;
  if (byte(0) == 0xED) highest = 0x9F;
  if (byte(0) == 0xF0) lowest = 0x90;
  if (byte(0) == 0xF4) highest = 0x8F;
  if (length == 0 || length > text.size()) return 0;
  if (byte(1) < lowest || byte(1) > highest) return 0;
  for (std::size_t i = 2; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  return length;
}

std::string utf8_of(std::string_view text) {
  std::string result;
  for_each_character(text, [&](std::string_view sequence, char32_t) { result += sequence; });
  return result;
}

std::string terminal_text(std::string_view text) {
  std::string result;
  for_each_character(text, [&](std::string_view sequence, char32_t code) {
    const bool allowed = !is_control(code) || code == '\n' || code == '\t';
    result += allowed ? sequence : "?";
  });
  return result;
}

std::string one_line(std::string_view text) {
  while (text.ends_with('\n') || text.ends_with('\r')) text.remove_suffix(1);
  std::string result;
  for_each_character(text, [&](std::string_view sequence, char32_t code) {
    result += is_control(code) ? " " : sequence;
  });
  return result;
}

std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  constexpr std::string_view rest = "...";
  std::string result;
  bool full = false;
  for_each_character(text, [&](std::string_view sequence, char32_t) {
    full = full || result.size() + sequence.size() + rest.size() > most;
    if (!full) result += sequence;
  });
  return result += rest;
}

std::string escaped_xml(std::string_view text) {
  std::string result;
  for_each_character(text, [&](std::string_view sequence, char32_t code) {
    const bool no_character = code == 0xFFFE || code == 0xFFFF;
    if (code == '&') {
      result += "&amp;";
    } else if (code == '<') {
      result += "&lt;";
    } else if (code == '>') {
      result += "&gt;";
    } else if (code == '"') {
      result += "&quot;";
    } else {
      result += is_control(code) || no_character ? "?" : sequence;
    }
  });
  return result;
}

std::string csv_field(std::string_view text) {
  std::string field = utf8_of(text);
  if (text.starts_with('\t') || text.starts_with('\r') || begins_formula(text)) {
    field.insert(field.begin(), '\'');
  }
  if (field.find_first_of(",;\"\t\r\n") == std::string::npos) return field;
  std::string quoted = "\"";
  for (const char c : field) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

TerminalText::~TerminalText() {
  TerminalText::sync();
  stream_.rdbuf(sink_);
}

bool TerminalText::put(std::string_view text) {
  line_ += text;
  const std::size_t end = line_.rfind('\n') + 1;
  if (end == 0) return true;
  const std::string lines = terminal_text(std::string_view(line_).substr(0, end));
  line_.erase(0, end);
  const auto count = static_cast<std::streamsize>(lines.size());
  return sink_->sputn(lines.data(), count) == count;
}

TerminalText::int_type TerminalText::overflow(int_type c) {
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  const char character = traits_type::to_char_type(c);
  return put({&character, 1}) ? c : traits_type::eof();
}

std::streamsize TerminalText::xsputn(const char* text, std::streamsize count) {
  return put({text, static_cast<std::size_t>(count)}) ? count : 0;
}

int TerminalText::sync() {
  const std::string rest = terminal_text(line_);
  line_.clear();
  const auto count = static_cast<std::streamsize>(rest.size());
  const bool done = sink_->sputn(rest.data(), count) == count;
  return done && sink_->pubsync() == 0 ? 0 : -1;
}

}  // namespace photile
