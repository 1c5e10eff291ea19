#include "command_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>

#include "render/setting.hpp"
#include "weather_text.hpp"

namespace photile::test {
namespace {

/// Most that a setting may be in a command that takes no time.
const std::map<std::string_view, std::uint64_t>& cheap_counts() {
  static const std::map<std::string_view, std::uint64_t> most{
      {"samples_per_pixel", 4}, {"photons_emitted", 2'000}, {"passes", 2},      {"neighbours", 60},
      {"direct_rays", 3},       {"light_map_rays", 4},      {"seed", 1'000'000}};
  return most;
}

constexpr std::array<std::string_view, 4> compiled{"neighbours", "area", "kernel", "maps"};

bool changes_kernels(std::string_view setting) {
  return std::find(compiled.begin(), compiled.end(), setting) != compiled.end();
}

/// A value of one option. Some are outside its range, or no value at all.
std::string value_of(const Setting& setting, double scene_size, Dice& dice) {
  if (dice.chance(0.04)) {
    return dice.one_of({"", "nan", "inf", "-1", "0", "1e400", "-0", "0x10", "many", "1e-320",
                        "99999999999999999999", "1.5", " 1", "1 "});
  }
  if (const auto* words = std::get_if<Words>(&setting.range)) {
    return std::string(dice.one_of(words->words));
  }
  if (const auto* counts = std::get_if<WholeNumbers>(&setting.range)) {
    const auto cheap = cheap_counts().find(setting.name);
    const std::uint64_t most =
        cheap == cheap_counts().end() ? counts->least + 8 : std::min(counts->most, cheap->second);
    return std::to_string(
        counts->least +
        static_cast<std::uint64_t>(dice.unit() * static_cast<double>(most - counts->least)));
  }
  if (const auto* numbers = std::get_if<Numbers>(&setting.range)) {
    return fmt::format("{:.3g}", dice.between(numbers->least, numbers->most));
  }
  const bool metres = setting.unit == "m";
  if (setting.name == "light_map_detail") return fmt::format("{:g}", 0.1 * scene_size);
  return fmt::format(
      "{:g}", metres ? scene_size * dice.size_between(1e-9, 1e3) : dice.size_between(0.1, 100));
}

}  // namespace

void CommandBuilder::add(std::initializer_list<std::string> arguments) {
  command_.arguments.insert(command_.arguments.end(), arguments);
}

void CommandBuilder::maybe(double probability, std::initializer_list<std::string> arguments) {
  if (dice_.chance(probability)) add(arguments);
}

void CommandBuilder::output(const std::string& option, const std::string& name) {
  command_.outputs.push_back(place_.folder / name);
  add({option, (place_.folder / name).string()});
}

void CommandBuilder::scene() {
  add({place_.scene.file.string()});
  command_.inputs = place_.scene.inputs;
}

void CommandBuilder::settings(const std::vector<std::string_view>& without) {
  for (const Setting& setting : photile::settings()) {
    const bool cost = setting.name == "photons_emitted" || setting.name == "samples_per_pixel";
    if (setting.option == "size" || !dice_.chance(cost ? 1 : 0.12) ||
        std::find(without.begin(), without.end(), setting.name) != without.end() ||
        (changes_kernels(setting.name) && !place_.any_kernel)) {
      continue;
    }
    const std::string value = value_of(setting, place_.scene.size, dice_);
    if (setting.option.empty()) {
      add({"--set", fmt::format("{}={}", setting.name, value)});
    } else {
      const std::string_view option = setting.option.substr(setting.option.rfind(',') + 1);
      add({fmt::format("--{}={}", option, value)});
    }
  }
}

std::string CommandBuilder::light() {
  return place_.scene.lights.empty() || dice_.chance(0.05) ? "nobody"
                                                           : dice_.one_of(place_.scene.lights);
}

void CommandBuilder::light_changes(double probability) {
  while (dice_.chance(probability)) {
    const std::string change =
        dice_.one_of({"x2", "x0", "off", "#FFD8A0", "2700K", "100", "50lm", "3W", "x1e30", "-1",
                      "nan", "", "#000000", "x1e-30", "1e29", "0K"});
    add({"--light", light() + "=" + change});
  }
}

void CommandBuilder::lights() {
  maybe(0.04,
        {"--light-group", dice_.one_of({"*=all", "lamp*=lamps", "bulb*=bulbs", "[=x", "=y"})});
  maybe(0.05, {"--sun", dice_.one_of({"135,40,80000", "0,-10,5", "0,90,1e31", "1,2", "nan,1,1",
                                      "10,20,1000,5"})});
  sky();
  maybe(0.02, {"--environment", dice_.chance(0.5) ? place_.picture.string() : "/dev/null"});
  maybe(0.04, {"--set", "emissive_scale=" + dice_.one_of({"2", "683", "1e38", "0", "1e-30"})});
  maybe(0.03, {"--set", "lumen_per_watt=" + dice_.one_of({"683", "100", "0", "nan", "1e30"})});
  maybe(0.02, {"--set", "environment_scale=" + dice_.one_of({"2", "0", "1e30", "-1"})});
  maybe(0.02, {"--set", "environment_rotation=" + dice_.one_of({"90", "-720", "nan"})});
  maybe(0.02, {"--ies", light() + "=/dev/null"});
  scene_changes();
  maybe(0.02, {"--area-light", light() + dice_.one_of({"=1x0.5,800", "=1x,3", "=0x1,1"})});
}

void CommandBuilder::film() {
  add({"--size", dice_.chance(0.03) ? dice_.one_of({"0x4", "4", "20000x1", "x", "-1x3"})
                                    : fmt::format("{}x{}", dice_.whole(1, 9), dice_.whole(1, 9))});
  maybe(0.03, {"--camera", dice_.one_of({"0", "1", "default", "nobody"})});
  maybe(0.04, {"--set", "direct_rays=" + dice_.one_of({"1", "3", "0", "-1"})});
  add({"--quality", dice_.chance(0.7) ? "draft" : "good"});
}

void CommandBuilder::scale() {
  maybe(0.2, {"--scale", dice_.one_of({"auto", "100", "nan", "0", "1e-30", "1e30"})});
}

void CommandBuilder::false_colour() {
  scale();
  maybe(0.1, {"--steps", dice_.one_of({"1", "8", "100", "0"})});
  maybe(0.1, {"--log", dice_.one_of({"3", "0.1", "31"})});
  maybe(0.1, {"--pal", dice_.one_of({"turbo", "heat", "grey"})});
  maybe(0.1, {dice_.one_of({"--cl", "--cb", "--cp"})});
  maybe(0.1, {"--label", dice_.one_of({"lux", "", "\n", "a very long label of a legend"})});
}

void CommandBuilder::tone_mapping() {
  maybe(0.1, {"--exposure", dice_.one_of({"1", "-64", "64", "65", "nan"})});
  maybe(0.1, {"--set", "view=" + dice_.one_of({"neutral", "standard"})});
}

void CommandBuilder::run() {
  maybe(0.1, {"--threads", dice_.one_of({"1", "2", "3"})});
  maybe(0.1, {"-q"});
  maybe(0.05, {"--set", "device_memory=" + dice_.one_of({"0.001", "0.06", "1", "1e-9", "0"})});
  maybe(0.01, {"--device", "nowhere"});
}

void CommandBuilder::drawings(double probability) {
  if (dice_.chance(probability)) output("--illuminance", "lux.png");
  if (dice_.chance(probability)) output("--luminance", "luminance.png");
  tone_mapping();
  maybe(0.1, {"--set", "auto_exposure=off"});
}

std::filesystem::path CommandBuilder::input(const std::string& name, const std::string& content) {
  const std::filesystem::path file = place_.scene.file.parent_path() / name;
  std::ofstream(file, std::ios::binary) << content;
  command_.inputs.push_back(file);
  return file;
}

std::filesystem::path CommandBuilder::weather() {
  static const std::string year = weather_text(
      [](int, int, int hour) { return hour > 8 && hour < 16 ? 400 : 0; },
      [](int month, int, int hour) { return hour > 6 && hour < 18 ? 30 + 10 * month : 0; });
  return input("year.epw", dice_.chance(0.05) ? year.substr(0, 1000) : year);
}

void CommandBuilder::sky() {
  maybe(0.05, {"--sky", dice_.one_of({"uniform=1000", "overcast=10000", "clear=5000",
                                      "uniform=1e300", "grey=1", "uniform=-1", "perez=600,120",
                                      "perez=0,0", "perez=1e4,1e-9", "perez=1", "patches=145"})});
  if (dice_.chance(0.04)) {
    add({"--site", dice_.one_of({"52.5,13.4,1", "-90,180,14", "91,0,0", "0,0"}), "--time",
         dice_.one_of({"2026-06-21T14:00", "2024-02-29T00:00", "2026-02-29T12:00", "noon"})});
    maybe(0.5, {"--sky", dice_.one_of({"perez=700,100", "clear=9000", "overcast=8000"})});
    maybe(0.2, {"--sun", "60000"});
  } else if (dice_.chance(0.02)) {
    add({"--weather", weather().string()});
    maybe(0.9, {"--time", dice_.one_of({"2026-06-21T14:00", "2026-12-21T02:00"})});
  }
  maybe(0.03, {"--set", "north=" + dice_.one_of({"90", "-360", "361", "nan"})});
  maybe(0.03, {"--set", "portals=" + dice_.one_of({"off", "auto", "glass*", "*", "stuff*", "["})});
  maybe(0.02, {"--set", "units=" + dice_.one_of({"mm", "m", "ft", "yards"})});
}

void CommandBuilder::luminaires() {
  static const std::string lamp =
      "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 1 1 2 0.6 0.3 0\n1 1 40\n0 90 180\n0\n"
      "100 100 100\n";
  input("lamp.ies", dice_.chance(0.05) ? lamp.substr(0, 60) : lamp);
  const double s = place_.scene.size;
  const std::string position = dice_.chance(0.3)
                                   ? R"("ceiling")"
                                   : fmt::format("[{:g}, {:g}, {:g}]", dice_.between(-s, s),
                                                 dice_.between(0, s), dice_.between(-s, s));
  const std::string array = dice_.chance(0.5)
                                ? fmt::format(R"(, "count": [{}, 2], "spacing": [{:g}, {:g}])",
                                              dice_.whole(0, 3), 0.3 * s, 0.2 * s)
                                : "";
  const std::string more = dice_.one_of({"", R"(, "aim": [0.3, -1, 0])", R"(, "aim": [0, 0, 0])",
                                         R"(, "rotation": 30, "lumens": 1e30)"});
  add({"--luminaires",
       input("lamps.json",
             fmt::format(R"([{{"file": "lamp.ies", "position": {}, "size": [{:g}, {:g}]{}{}}}])",
                         position, 0.2 * s, 0.1 * s, array, more))
           .string()});
}

void CommandBuilder::mood() {
  const std::string setting = dice_.one_of(
      {R"("power": 200, "unit": "lm", "on": true)", R"("power": 3, "unit": "W", "kelvin": 2700)",
       R"("power": 0)", R"("power": 800, "color": "#ffd9a0")", R"("power": "much")"});
  add({"--moods",
       input("lamps.moods.json",
             fmt::format(R"({{"photile_moods": 1, "moods": {{"evening": {{"{}": {{{}}}}}}}}})",
                         light(), setting))
           .string()});
  maybe(0.95, {"--mood", dice_.chance(0.95) ? "evening" : "morning"});
}

void CommandBuilder::scene_changes() {
  maybe(0.05, {"--reflectance", dice_.one_of({"*=0.5", "wall=80%", "stuff*=0", "glow*=20%",
                                              "nobody=0.5", "*=2", "[=0.5"})});
  maybe(0.04, {"--set", "lambertian=on"});
  maybe(0.05, {"--set", "up=" + dice_.one_of({"y", "z", "x", "-y", "w"})});
  if (dice_.chance(0.05)) luminaires();
}

}  // namespace photile::test
