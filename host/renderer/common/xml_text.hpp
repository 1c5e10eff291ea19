// Text within XML: SVG and HTML.
#pragma once

#include <string>
#include <string_view>

namespace photile {

/// `text` as content or as an attribute's value in double quotes. Control characters, which XML
/// cannot hold, become question marks.
inline std::string escaped_xml(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += static_cast<unsigned char>(c) < ' ' ? '?' : c;
    }
  }
  return result;
}

}  // namespace photile
