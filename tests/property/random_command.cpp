#include "random_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <map>
#include <string_view>

#include "render/setting.hpp"

namespace photile::test {
namespace {

/// Most that a setting may be in a command that takes no time.
const std::map<std::string_view, std::uint64_t>& cheap_counts() {
  static const std::map<std::string_view, std::uint64_t> most{
      {"samples_per_pixel", 4}, {"photons_emitted", 2'000}, {"passes", 2},
      {"neighbours", 60},       {"least_neighbours", 40},   {"direct_rays", 3},
      {"final_gather_rays", 4}, {"light_map_rays", 4},      {"seed", 1'000'000}};
  return most;
}

constexpr std::array<std::string_view, 7> compiled{
    "neighbours", "least_neighbours", "area", "kernel", "maps", "structure", "final_gather_rays"};

bool changes_kernels(std::string_view setting) {
  return std::find(compiled.begin(), compiled.end(), setting) != compiled.end();
}

/// Of one option. Some are outside its range, or no value at all.
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

class Generator {
 public:
  Generator(const Workplace& place, Dice& dice) : place_(place), dice_(dice) {}

  RandomCommand make() {
    const double kind = dice_.unit();
    if (kind < 0.45) {
      render();
    } else if (kind < 0.65) {
      relight();
    } else if (kind < 0.75) {
      measure();
    } else if (kind < 0.82) {
      walk();
    } else if (kind < 0.92) {
      info();
    } else if (kind < 0.97) {
      compare();
    } else {
      bake();
    }
    return std::move(command_);
  }

 private:
  void add(std::initializer_list<std::string> arguments) {
    command_.arguments.insert(command_.arguments.end(), arguments);
  }
  void maybe(double probability, std::initializer_list<std::string> arguments) {
    if (dice_.chance(probability)) add(arguments);
  }
  void output(const std::string& option, const std::string& name) {
    command_.outputs.push_back(place_.folder / name);
    add({option, (place_.folder / name).string()});
  }

  void scene() {
    add({place_.scene.file.string()});
    command_.inputs = place_.scene.inputs;
  }

  void settings(const std::vector<std::string_view>& without = {}) {
    for (const Setting& setting : photile::settings()) {
      const bool cost = setting.name == "photons_emitted" || setting.name == "samples_per_pixel";
      if (setting.option.empty() || !dice_.chance(cost ? 1 : 0.12) ||
          std::find(without.begin(), without.end(), setting.name) != without.end() ||
          (changes_kernels(setting.name) && !place_.any_kernel)) {
        continue;
      }
      const std::string_view option = setting.option.substr(setting.option.rfind(',') + 1);
      add({fmt::format("--{}={}", option, value_of(setting, place_.scene.size, dice_))});
    }
  }

  std::string light() {
    return place_.scene.lights.empty() || dice_.chance(0.05) ? "nobody"
                                                             : dice_.one_of(place_.scene.lights);
  }

  void light_changes(double probability) {
    while (dice_.chance(probability)) {
      const std::string change =
          dice_.one_of({"x2", "x0", "off", "#FFD8A0", "2700K", "100", "50lm", "3W", "x1e30", "-1",
                        "nan", "", "#000000", "x1e-30", "1e29", "0K"});
      add({"--light", light() + "=" + change});
    }
  }

  void lights() {
    light_changes(0.25);
    maybe(0.04,
          {"--light-group", dice_.one_of({"*=all", "lamp*=lamps", "bulb*=bulbs", "[=x", "=y"})});
    maybe(0.04, {"--light-temperature", light() + dice_.one_of({"=2700", "=1", "=nan", "=6500K"})});
    maybe(0.05, {"--sun", dice_.one_of({"135,40,80000", "0,-10,5", "0,90,1e31", "1,2", "nan,1,1",
                                        "10,20,1000,5"})});
    maybe(0.05, {"--sky", dice_.one_of({"uniform=1000", "overcast=10000", "clear=5000",
                                        "uniform=1e300", "grey=1", "uniform=-1"})});
    maybe(0.02, {"--environment", dice_.chance(0.5) ? place_.picture.string() : "/dev/null"});
    maybe(0.04, {"--emissive-scale", dice_.one_of({"2", "683", "1e38", "0", "1e-30"})});
    maybe(0.03, {"--lumen-per-watt", dice_.one_of({"683", "100", "0", "nan", "1e30"})});
    maybe(0.02, {"--environment-scale", dice_.one_of({"2", "0", "1e30", "-1"})});
    maybe(0.02, {"--environment-rotation", dice_.one_of({"90", "-720", "nan"})});
    maybe(0.02, {"--ies", light() + "=/dev/null"});
    maybe(0.02, {"--area-light", light() + dice_.one_of({"=1x0.5,800", "=1x,3", "=0x1,1"})});
  }

  void film() {
    add({"--size", dice_.chance(0.03)
                       ? dice_.one_of({"0x4", "4", "20000x1", "x", "-1x3"})
                       : fmt::format("{}x{}", dice_.whole(1, 9), dice_.whole(1, 9))});
    maybe(0.03, {"--camera", dice_.one_of({"0", "1", "default", "nobody"})});
    maybe(0.04, {"--direct", dice_.one_of({"rays", "photons"})});
    add({"--quality", dice_.chance(0.7) ? "draft" : "good"});
  }

  void false_colour() {
    maybe(0.2, {"--scale", dice_.one_of({"auto", "100", "nan", "0", "1e-30", "1e30"})});
    maybe(0.1, {"--steps", dice_.one_of({"1", "8", "100", "0"})});
    maybe(0.1, {"--log", dice_.one_of({"3", "0.1", "31"})});
    maybe(0.1, {"--pal", dice_.one_of({"turbo", "heat", "grey"})});
    maybe(0.1, {dice_.one_of({"--cl", "--cb", "--cp"})});
    maybe(0.1, {"--label", dice_.one_of({"lux", "", "\n", "a very long label of a legend"})});
  }

  void tone_mapping() {
    maybe(0.1, {"--exposure", dice_.one_of({"1", "-64", "64", "65", "nan"})});
    maybe(0.1, {"--view", dice_.one_of({"neutral", "standard"})});
  }

  void run() {
    maybe(0.1, {"--threads", dice_.one_of({"1", "2", "3"})});
    maybe(0.1, {"-q"});
    maybe(0.05, {"--memory", dice_.one_of({"1MiB", "64MiB", "1GiB", "1B"})});
    maybe(0.01, {"--device", "nowhere"});
  }

  void drawings(double probability) {
    if (dice_.chance(probability)) output("--illuminance", "lux.png");
    if (dice_.chance(probability)) output("--luminance", "luminance.png");
    false_colour();
    tone_mapping();
    maybe(0.1, {"--no-auto-exposure"});
  }

  void render() {
    add({"render"});
    scene();
    if (dice_.chance(0.97)) output("-o", "picture.exr");
    if (dice_.chance(0.3)) output("--png", "picture.png");
    if (dice_.chance(0.15)) output("--stats", "stats.json");
    if (dice_.chance(0.05)) output("--glare", "glare.png");
    if (dice_.chance(0.1)) output("--errors", "errors.exr");
    maybe(0.03, {"--glare-limit", dice_.one_of({"1000", "0", "nan"})});
    drawings(0.1);
    film();
    lights();
    if (dice_.chance(0.3)) {
      add({"--integrator", "path", "--samples", std::to_string(dice_.whole(1, 3))});
      return;
    }
    settings();
    if (dice_.chance(0.06)) output("--save-maps", "photons.maps");
    if (dice_.chance(0.04)) {  // as many passes as there is time for
      command_.timed = true;
      add({"--for", dice_.one_of({"300ms", "0.5s", "0", "-1s", "1ns"})});
      if (dice_.chance(0.3)) {  // which chooses photons and rays itself
        std::erase_if(command_.arguments, [](const std::string& argument) {
          return argument.starts_with("--photons") || argument == "draft" || argument == "good" ||
                 argument == "--quality";
        });
        add({"--target-error", dice_.one_of({"30%", "5%", "0.1", "0%", "nan", "1e30"})});
      }
    }
    maybe(0.02, {"--load-maps", "/dev/null"});
    maybe(0.02, {"--preview", dice_.one_of({"localhost:1", "localhost:99999", ":", "x"})});
    run();
  }

  void relight() {
    add({"relight", place_.picture.string()});
    command_.inputs = {place_.picture};
    light_changes(0.5);
    if (dice_.chance(0.9)) output("-o", dice_.one_of({"relit.exr", "relit.png"}));
    drawings(0.2);
  }

  void measure() {
    add({"measure"});
    scene();
    if (dice_.chance(0.9))
      output("-o", dice_.one_of({"lux.csv", "lux.json", "lux.svg", "lux.html"}));
    const double s = place_.scene.size;
    const std::string points = (place_.folder / "points.pts").string();
    std::ofstream(points) << fmt::format("0 {0} 0 0 1 0\n{0} {0} 0 0 1 0\n", 0.1 * s)
                          << (dice_.chance(0.1) ? "nan 0 0 0 0 0\n" : "");
    command_.inputs.emplace_back(points);
    if (dice_.chance(0.7)) {
      add({"--points", points});
    } else {
      add({"--plane", fmt::format("{:g}", dice_.between(-1, 1) * s), "--spacing",
           fmt::format("{:g}", s), "--wall-band", "0"});
    }
    add({"--rays", std::to_string(dice_.whole(1, 8)), "--repeats", dice_.one_of({"2", "3", "1"})});
    maybe(0.1, {"--maintenance", dice_.one_of({"0.8", "0", "2", "nan"})});
    maybe(0.1, {"--cylindrical"});
    maybe(0.1, {"--clearance", fmt::format("{:g}", 0.1 * s)});
    maybe(0.05, {"--up", dice_.one_of({"y", "z", "x", "-y"})});
    false_colour();
    lights();
    if (dice_.chance(0.3)) {
      add({"--integrator", "path"});
    } else {
      settings({"samples_per_pixel", "final_gather_rays", "gloss", "direct_rays"});
    }
  }

  void walk() {
    add({"walk"});
    scene();
    const int first = dice_.chance(0.9) ? 1 : dice_.whole(-1, 2);
    for (int frame = first; frame < first + 2; ++frame) {
      command_.outputs.push_back(place_.folder / fmt::format("frame.{}.exr", frame));
    }
    add({"-o", (place_.folder / "frame.#.exr").string()});
    if (dice_.chance(0.2)) output("--contact-sheet", "sheet.png");
    if (dice_.chance(0.2)) {
      for (int frame = first; frame < first + 2; ++frame) {
        command_.outputs.push_back(place_.folder / fmt::format("shown.{}.png", frame));
      }
      add({"--png", (place_.folder / "shown.#.png").string()});
    }
    if (dice_.chance(0.1)) output("--save-maps", "photons.maps");
    const double s = place_.scene.size;
    const std::string path = (place_.folder / "path.json").string();
    std::ofstream(path) << fmt::format(
        R"([{{"time": 0, "position": [0, 0, {0}], "look_at": [0, 0, 0], "fov": 60}},)"
        R"({{"time": 1, "position": [{0}, 0, {0}], "look_at": [0, 0, 0], "fov": {1}}}])",
        0.5 * s, dice_.chance(0.1) ? 300 : 60);
    command_.inputs.emplace_back(path);
    add({"--camera-path", path, "--fps", "1"});
    if (first != 1) add({"--first-number", std::to_string(first)});
    maybe(0.3, {"--quick"});
    film();
    light_changes(0.25);
    settings({"passes"});
    run();
  }

  void info() {
    add({"info"});
    scene();
    lights();
    maybe(0.5, {"--json"});
  }

  void compare() {
    const std::string other =
        dice_.chance(0.8) ? place_.picture.string() : place_.scene.inputs.back().string();
    add({"compare", place_.picture.string(), other});
    command_.inputs = place_.scene.inputs;
    command_.inputs.push_back(place_.picture);
    if (dice_.chance(0.7)) output("-o", "difference.png");
    if (dice_.chance(0.5)) output("--json", "errors.json");
    maybe(0.1, {"--scale", dice_.one_of({"auto", "10", "nan", "0"})});
    tone_mapping();
  }

  void bake() {
    add({"bake"});
    scene();
    add({"-o", (place_.folder / "baked.gltf").string(), "--most-texels", "64", "--texel",
         fmt::format("{:g}", 0.2 * place_.scene.size)});
    light_changes(0.2);
    settings({"samples_per_pixel", "passes", "direct_rays", "final_gather_rays", "light_maps"});
    if (dice_.chance(0.1)) output("--save-maps", "photons.maps");
  }

  const Workplace& place_;
  Dice& dice_;
  RandomCommand command_;
};

}  // namespace

RandomCommand random_command(const Workplace& place, Dice& dice) {
  return Generator(place, dice).make();
}

}  // namespace photile::test
