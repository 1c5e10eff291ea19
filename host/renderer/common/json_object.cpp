#include "common/json_object.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "common/files.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile {
namespace {

using nlohmann::json;

bool is_within(const json& value, double lowest, double highest) {
  return value.is_number() && value.get<double>() >= lowest && value.get<double>() <= highest;
}

}  // namespace

json read_input_json(const std::filesystem::path& file) {
  const std::string text = read_input_text(file);
  check_json_depth(text, file.string());
  json content = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (content.is_discarded())
    throw InputError(fmt::format("{}: this is not valid JSON", file.string()));
  return content;
}

void check_json_depth(std::string_view text, const std::string& file) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char letter = text[i];
    if (quoted) {
      if (letter == '\\') ++i;
      quoted = letter != '"';
    } else if (letter == '"') {
      quoted = true;
    } else if (letter == '[' || letter == '{') {
      ++depth;
    } else if (letter == ']' || letter == '}') {
      --depth;
    }
    if (depth > limits::max_json_depth) {
      throw InputError(
          fmt::format("{}: the JSON is nested more than {} levels deep; reduce the nesting", file,
                      limits::max_json_depth));
    }
  }
}

JsonObject::JsonObject(const json& object, std::string where,
                       std::initializer_list<const char*> known)
    : object_(object), where_(std::move(where)) {
  if (!object.is_object()) refuse("this is not an object {...}");
  for (const auto& [key, value] : object.items()) {
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      constexpr std::size_t most_told = 60;
      refuse(fmt::format("'{}' is not a known key; the keys are {}", key.substr(0, most_told),
                         fmt::join(known, ", ")));
    }
  }
}

double JsonObject::number(const char* key, double lowest, double highest) const {
  const json value = member(key);
  if (!is_within(value, lowest, highest)) {
    refuse(fmt::format("'{}' is not a number from {:g} to {:g}", key, lowest, highest));
  }
  return value.get<double>();
}

double JsonObject::metres(const char* key) const {
  const json value = member(key);
  if (!is_within(value, 0, limits::max_coordinate) || value.get<double>() == 0) {
    refuse(fmt::format("'{}' is not a number of metres above 0", key));
  }
  return value.get<double>();
}

int JsonObject::count(const char* key, int lowest, int highest) const {
  const json value = member(key);
  if (!value.is_number_integer() || !is_within(value, lowest, highest)) {
    refuse(fmt::format("'{}' is not a whole number from {} to {}", key, lowest, highest));
  }
  return value.get<int>();
}

glm::dvec3 JsonObject::vector(const char* key) const {
  const json value = member(key);
  if (!value.is_array() || value.size() != 3 ||
      !std::all_of(value.begin(), value.end(), [](const json& coordinate) {
        return is_within(coordinate, -limits::max_coordinate, limits::max_coordinate);
      })) {
    refuse(fmt::format("'{}' is not three numbers, in metres", key));
  }
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

std::string JsonObject::text(const char* key, const std::string& otherwise) const {
  const json value = object_.value(key, json(otherwise));
  if (!value.is_string() || value.get<std::string>().empty()) {
    refuse(fmt::format("'{}' must be a non-empty string", key));
  }
  return value.get<std::string>();
}

void JsonObject::refuse(const std::string& reason) const {
  throw InputError(fmt::format("{}: {}", where_, reason));
}

}  // namespace photile
