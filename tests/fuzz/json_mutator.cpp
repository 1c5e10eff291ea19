#include "json_mutator.hpp"

#include <nlohmann/json.hpp>
#include <random>
#include <vector>

namespace photile::test {
namespace {

using nlohmann::json;

/// Every value of a document. Those of one list are pointers that a change may leave dangling: one
/// change a list.
void collect(json& value, std::vector<json*>& values) {
  values.push_back(&value);
  if (value.is_structured()) {
    for (json& member : value) collect(member, values);
  }
}

/// Borders of types, of limits, and of what floats hold.
const json& wild_values() {
  static const json values =
      json::parse(R"([0, -1, 1, 2, 3, 255, 65536, 2147483647, -2147483648, 4294967295,
      18446744073709551615, 0.5, -0.0, 1e-320, 1e38, 1e39, 1e300, 5120, 5121, 5123, 5125, 5126, 33071, 33648,
      10497, "SCALAR", "VEC2", "VEC3", "VEC4", "spot", "", "../x", true, null, [], {}])");
  return values;
}

void change(json& document, std::mt19937& random) {
  std::vector<json*> values;
  collect(document, values);
  json& value = *values[random() % values.size()];
  const json other = *values[random() % values.size()];
  switch (random() % 7) {
    case 0:
    case 1:
      value = wild_values()[random() % wild_values().size()];
      return;
    case 2:
      value = other;
      return;
    case 3:
      if (value.is_number()) value = value.get<double>() * (random() % 2 == 0 ? -1.0 : 1e10);
      return;
    case 4:
      if (value.is_number_integer())
        value = value.get<std::int64_t>() + (random() % 2 == 0 ? 1 : -1);
      return;
    case 5:
      if (value.is_array()) value.push_back(value.empty() ? other : value[random() % value.size()]);
      return;
    default:
      if (!value.is_structured() || value.empty()) return;
      auto member = value.begin();
      std::advance(member, static_cast<std::ptrdiff_t>(random() % value.size()));
      value.erase(member);
  }
}

}  // namespace

std::string mutated_json(Bytes text, unsigned seed) {
  json document = json::parse(text.begin(), text.end(), nullptr, /*allow_exceptions=*/false);
  if (document.is_discarded()) return {};
  std::mt19937 random(seed);
  for (unsigned changes = 1 + random() % 4; changes > 0; --changes) change(document, random);
  return document.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace photile::test
