#include "image/light_records.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/ascii_text.hpp"
#include "photile/errors.hpp"

namespace photile::image {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* lights_attribute = "photile.lights";
constexpr const char* efficacy_attribute = "photile.efficacy";

[[noreturn]] void refuse(const char* attribute, const std::string& reason) {
  throw InputError(fmt::format("the picture's attribute {} is damaged ({}); render it again",
                               attribute, reason));
}

Json rgb_to_json(const glm::vec3& rgb) { return Json::array({rgb.r, rgb.g, rgb.b}); }

double read_amount(const Json& value, const char* what) {
  const double amount = value.is_number() ? value.get<double>() : -1.0;
  if (!(amount >= 0.0) || !std::isfinite(amount)) {
    refuse(lights_attribute, fmt::format("a {} is no number of 0 or more", what));
  }
  return amount;
}

glm::vec3 read_rgb(const Json& record, const char* key) {
  const auto found = record.find(key);
  if (found == record.end()) return glm::vec3(1.0f);
  if (!found->is_array() || found->size() != 3) {
    refuse(lights_attribute, fmt::format("a {} has not three numbers", key));
  }
  glm::vec3 rgb;
  for (int channel = 0; channel < 3; ++channel) {
    rgb[channel] =
        static_cast<float>(read_amount((*found)[static_cast<std::size_t>(channel)], key));
  }
  return rgb;
}

std::vector<std::string> read_members(const Json& record) {
  const auto found = record.find("lights");
  if (found == record.end()) return {};
  if (!found->is_array()) refuse(lights_attribute, "the lights of a group are no list");
  std::vector<std::string> members;
  for (const Json& member : *found) {
    if (!member.is_string()) refuse(lights_attribute, "a light of a group has no name");
    members.push_back(member.get<std::string>());
  }
  return members;
}

/// One light; its name is added to `relative` where the record has no unit.
MixedLight read_record(const Json& record, std::set<std::string>& relative) {
  if (!record.is_object() || !record.contains("name") || !record["name"].is_string()) {
    refuse(lights_attribute, "a light has no name");
  }
  MixedLight light;
  light.name = record["name"].get<std::string>();
  light.power = record.contains("power") ? read_amount(record["power"], "power") : 1.0;
  light.color = read_rgb(record, "color");
  light.tint = read_rgb(record, "tint");
  light.members = read_members(record);
  const std::string unit = record.contains("unit") && record["unit"].is_string()
                               ? record["unit"].get<std::string>()
                               : std::string();
  if (unit.empty()) {
    relative.insert(light.name);
  } else if (unit != "lm" && unit != "W") {
    refuse(lights_attribute, fmt::format("unit '{}' is neither lm nor W", unit));
  }
  light.unit = unit == "W" ? PowerUnit::watt : PowerUnit::lumen;
  return light;
}

double read_efficacy(const PictureHeader& image) {
  const auto found = image.attributes.find(efficacy_attribute);
  if (found == image.attributes.end()) return defaults::lumen_per_watt;
  const std::string& text = found->second;
  const auto efficacy = parse_number<double>(text);
  if (!efficacy || *efficacy <= 0) {
    refuse(efficacy_attribute, fmt::format("'{}' is no number above 0", text));
  }
  return *efficacy;
}

/// An attribute has one type: one of the same name that another program left is replaced.
void set_attribute(PictureHeader& image, const std::string& name, std::string text) {
  image.numbers.erase(name);
  image.matrices.erase(name);
  image.attributes[name] = std::move(text);
}

void set_attribute(PictureHeader& image, const std::string& name, float number) {
  image.attributes.erase(name);
  image.matrices.erase(name);
  image.numbers[name] = number;
}

}  // namespace

void write_light_records(PictureHeader& image, const LightRecords& records) {
  Json lights = Json::array();
  for (const MixedLight& light : records.mix.lights) {
    Json record{{"name", light.name}, {"power", light.power}};
    if (!records.relative.contains(light.name)) {
      record["unit"] = light.unit == PowerUnit::lumen ? "lm" : "W";
    }
    if (!light.members.empty()) record["lights"] = light.members;
    record["color"] = rgb_to_json(light.color);
    record["tint"] = rgb_to_json(light.tint);
    lights.push_back(std::move(record));
  }
  // A name that is no UTF-8 must not stop the picture from being written.
  set_attribute(image, lights_attribute,
                lights.dump(-1, ' ', false, Json::error_handler_t::replace));
  if (!records.relative.empty()) return;

  const double lumen_per_watt = records.mix.lumen_per_watt;
  const bool watts =
      !records.mix.lights.empty() && records.mix.lights.front().unit == PowerUnit::watt;
  set_attribute(image, "photile.units", watts ? "W/(m2 sr)" : "cd/m2");
  set_attribute(image, "photile.illuminance.units", "lux");
  set_attribute(image, efficacy_attribute, fmt::format("{}", lumen_per_watt));
  set_attribute(image, "whiteLuminance", watts ? static_cast<float>(lumen_per_watt) : 1.0f);
}

LightRecords read_light_records(const PictureHeader& image) {
  LightRecords records;
  records.mix.lumen_per_watt = read_efficacy(image);
  const auto found = image.attributes.find(lights_attribute);
  if (found == image.attributes.end()) return records;
  const Json lights = Json::parse(found->second, nullptr, /*allow_exceptions=*/false);
  if (!lights.is_array()) refuse(lights_attribute, "it is no list of lights");
  for (const Json& record : lights) {
    records.mix.lights.push_back(read_record(record, records.relative));
  }
  return records;
}

}  // namespace photile::image
