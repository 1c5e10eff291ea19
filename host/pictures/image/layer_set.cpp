#include "image/layer_set.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/ascii_text.hpp"
#include "photile/errors.hpp"

namespace photile::image {

namespace {

constexpr std::size_t absent = static_cast<std::size_t>(-1);

/// A channel's name, taken apart from the right as Blender does: view layer, pass, channel.
struct ChannelName {
  std::string view, pass, channel;

  explicit ChannelName(const std::string& name) {
    const std::size_t last = name.rfind('.');
    if (last == std::string::npos) {
      channel = name;
      return;
    }
    channel = name.substr(last + 1);
    const std::size_t before = name.rfind('.', last == 0 ? 0 : last - 1);
    const bool has_view = before != std::string::npos && before < last;
    view = has_view ? name.substr(0, before) : std::string();
    const std::size_t start = has_view ? before + 1 : 0;
    pass = name.substr(start, last - start);
  }
};

/// The light of a pass that starts with a prefix, or "".
std::string light_after(std::string_view prefix, const std::string& pass) {
  return pass.starts_with(prefix) ? pass.substr(prefix.size()) : std::string();
}

struct FoundLayer {
  std::string light, view;
  std::array<std::size_t, 3> rgb{absent, absent, absent};
};

/// Layers in the order in which their first channel stands in the picture.
class Finder {
 public:
  explicit Finder(const PictureHeader& image) {
    for (std::size_t i = 0; i < image.channel_names.size(); ++i) {
      const ChannelName name(image.channel_names[i]);
      const std::size_t component = std::string_view("RGB").find(name.channel);
      if (const std::string lit = light_after("Illuminance_", name.pass); !lit.empty()) {
        if (name.channel == "Y") illuminance_.emplace(lit, i);
        continue;
      }
      std::string light = light_after("Combined_", name.pass);
      if (light.empty()) light = light_after("RGBA_", name.pass);
      if (light.empty() || name.channel.size() != 1 || component == std::string_view::npos)
        continue;
      layer_of(light, name.view).rgb[component] = i;
    }
  }

  const std::vector<FoundLayer>& layers() const { return layers_; }

  LayerChannels channels_of(const FoundLayer& layer) const {
    const auto found = illuminance_.find(layer.light);
    return {layer.rgb, found == illuminance_.end() ? std::nullopt : std::optional(found->second)};
  }

 private:
  FoundLayer& layer_of(const std::string& light, const std::string& view) {
    if (!layers_.empty() && layers_.front().view != view) {
      throw InputError(fmt::format(
          "the picture holds light layers of several views ('{}' and '{}'); keep one of them",
          layers_.front().view, view));
    }
    const auto [found, is_new] = position_.try_emplace(light, layers_.size());
    if (is_new) layers_.push_back({light, view});
    return layers_[found->second];
  }

  std::vector<FoundLayer> layers_;
  std::map<std::string, std::size_t> position_;
  std::map<std::string, std::size_t> illuminance_;
};

}  // namespace

LayerSet find_layers(const PictureHeader& image) {
  const Finder finder(image);
  if (finder.layers().empty()) {
    throw InputError(
        "the picture has no light layers (channels such as Combined_lamp.R); render it with "
        "photile, or with light groups in Blender or Arnold");
  }
  std::map<std::string, const FoundLayer*> unplaced;
  for (const FoundLayer& layer : finder.layers()) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (layer.rgb[i] == absent) {
        throw InputError(
            fmt::format("the layer of light '{}' lacks its channel {}; write R, G and B",
                        layer.light, "RGB"[i]));
      }
    }
    unplaced.emplace(layer.light, &layer);
  }

  LightRecords recorded = read_light_records(image);
  const PowerUnit unit = recorded.mix.unit();
  LayerSet set;
  set.records.mix.lumen_per_watt = recorded.mix.lumen_per_watt;
  for (MixedLight& light : recorded.mix.lights) {
    const auto found = unplaced.find(light.name);
    if (found == unplaced.end()) continue;  // its layer was taken out of the file
    set.channels.push_back(finder.channels_of(*found->second));
    if (recorded.relative.contains(light.name)) set.records.relative.insert(light.name);
    set.records.mix.lights.push_back(std::move(light));
    unplaced.erase(found);
  }
  for (const FoundLayer& layer : finder.layers()) {
    if (!unplaced.contains(layer.light)) continue;
    MixedLight light;
    light.name = layer.light;
    light.power = 1.0;
    set.channels.push_back(finder.channels_of(layer));
    set.records.relative.insert(light.name);
    set.records.mix.lights.push_back(std::move(light));
  }
  // A picture in cd/m2 stays one where all that is left in it are lights of watts.
  if (set.records.mix.unit() != unit && set.records.relative.empty()) {
    for (MixedLight& light : set.records.mix.lights) {
      light.power = set.records.mix.lumens_of(light);
      light.unit = PowerUnit::lumen;
    }
  }
  return set;
}

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
    refuse(lights_attribute, fmt::format("a {} is not a number of 0 or more", what));
  }
  return amount;
}

glm::vec3 read_rgb(const Json& record, const char* key) {
  const auto found = record.find(key);
  if (found == record.end()) return glm::vec3(1.0f);
  if (!found->is_array() || found->size() != 3) {
    refuse(lights_attribute, fmt::format("a {} does not have three numbers", key));
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
  if (!found->is_array()) refuse(lights_attribute, "the lights of a group are not a list");
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
    refuse(efficacy_attribute, fmt::format("'{}' is not a number above 0", text));
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
      record["unit"] = symbol_of(light.unit);
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
  const bool watts = records.mix.unit() == PowerUnit::watt;
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
  if (!lights.is_array()) refuse(lights_attribute, "it is not a list of lights");
  for (const Json& record : lights) {
    records.mix.lights.push_back(read_record(record, records.relative));
  }
  return records;
}

}  // namespace photile::image
