#include "common/letter_case.hpp"

namespace photile {

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

bool ends_in(std::string_view text, std::string_view ending) {
  return text.size() >= ending.size() &&
         lower(text.substr(text.size() - ending.size())) == lower(ending);
}

}  // namespace photile
