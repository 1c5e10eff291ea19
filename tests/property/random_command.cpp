#include "random_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "command_builder.hpp"
#include "render/setting.hpp"

namespace photile::test {
namespace {

/// Settings that photons depend on.
constexpr std::array<std::string_view, 7> traced{
    "photons_emitted", "quota", "seed", "maps", "direct_rays", "light_maps", "light_map_rays"};

class Generator : CommandBuilder {
 public:
  using CommandBuilder::CommandBuilder;

  RandomCommand make() {
    using Make = void (Generator::*)();
    static constexpr std::pair<double, Make> kinds[] = {
        // in these shares
        {0.40, &Generator::render}, {0.14, &Generator::relight}, {0.09, &Generator::measure},
        {0.07, &Generator::walk},   {0.07, &Generator::info},    {0.05, &Generator::compare},
        {0.03, &Generator::bake},   {0.07, &Generator::glare},   {0.02, &Generator::daylight},
        {0.03, &Generator::ies},    {1.00, &Generator::trace}};  // all that are left
    double left = dice_.unit();
    for (const auto& [share, make] : kinds) {
      left -= share;
      if (left >= 0) continue;
      (this->*make)();
      break;
    }
    return std::move(command_);
  }

 private:
  void render() {
    add({"render"});
    scene();
    if (dice_.chance(0.97)) output("-o", "picture.exr");
    if (dice_.chance(0.3)) output("-o", "picture.png");
    if (dice_.chance(0.15)) output("--stats", "stats.json");
    if (dice_.chance(0.05)) output("--glare", "glare.png");
    if (dice_.chance(0.1)) output("--errors", "errors.exr");
    maybe(0.03, {"--set", "glare_limit=" + dice_.one_of({"1000", "0", "nan"})});
    drawings(0.1);
    scale();
    film();
    maybe(0.06, {"--projection", dice_.one_of({"fisheye", "angular", "equirectangular",
                                               "orthographic", "perspective", "mercator"})});
    maybe(0.04,
          {"--field-of-view", dice_.one_of({"60", "180", "360", "361", "0", "1e-30", "nan"})});
    light_changes(0.25);
    lights();
    if (dice_.chance(0.06)) mood();
    if (dice_.chance(0.3)) {
      add({"--integrator", "path", "--samples", std::to_string(dice_.whole(1, 3))});
      return;
    }
    settings();
    if (dice_.chance(0.06)) output("--save-maps", "photons.maps");
    if (dice_.chance(0.04)) {  // as many passes as there is time for
      command_.timed = true;
      add({"--for", dice_.one_of({"300ms", "0.5s", "0", "-1s", "1ns"})});
      maybe(0.3, {"--target-error", dice_.one_of({"30%", "5%", "0.1", "0%", "nan", "1e30"})});
    }
    maybe(0.02, {"--load-maps", "/dev/null"});
    run();
  }

  void relight() {
    add({"relight", place_.picture.string()});
    command_.inputs = {place_.picture};
    light_changes(0.5);
    if (dice_.chance(0.1)) mood();
    maybe(0.02, {"--time", "2026-06-21T14:00", "--site", "52.5,13.4,1", "--sky", "perez=600,120"});
    if (dice_.chance(0.9)) output("-o", dice_.one_of({"relit.exr", "relit.png"}));
    drawings(0.2);
    false_colour();
  }

  void measure() {
    add({"measure"});
    scene();
    if (dice_.chance(0.9))
      output("-o", dice_.one_of({"lux.csv", "lux.json", "lux.svg", "lux.html"}));
    // Plans of several have numbers in their names.
    const bool any_grids = command_.outputs.empty() || command_.outputs[0].extension() != ".svg";
    const double s = place_.scene.size;
    if (dice_.chance(0.7)) {
      add({"--points", points().string()});
    } else {
      add({"--plane", fmt::format("{:g}", dice_.between(-1, 1) * s), "--spacing",
           fmt::format("{:g}", s), "--wall-band", "0"});
    }
    add({"--rays", std::to_string(dice_.whole(1, 8)), "--repeats",
         dice_.one_of({"2", "3", "2", "3", "2", "3", "2", "1"})});
    maybe(0.1, {"--maintenance", dice_.one_of({"0.8", "0", "2", "nan"})});
    maybe(0.1, {"--cylindrical"});
    if (any_grids) {
      maybe(0.05, {"--walls"});
      maybe(0.05, {"--ceiling"});
      maybe(0.05, {"--cylindrical-at", dice_.one_of({"floor+1.2", "0", "roof"})});
      maybe(0.03, {"--semi-cylindrical-at", "floor+1.2"});
    }
    maybe(0.05, {"--inside", dice_.one_of({"0,0,0", "1e9,0,0", "1,2"})});
    maybe(0.1, {"--daylight-factor"});
    maybe(0.2, {"--target", dice_.one_of({"office-desk", "Em=500,Uo=0.6", "Em=0", "UGR=19"})});
    if (dice_.chance(0.1)) output("--honeybee", "honeybee");
    maybe(0.1, {"--clearance", fmt::format("{:g}", 0.1 * s)});
    false_colour();
    sensor_light();
  }

  /// What lights the sensors, by photons or by paths.
  void sensor_light() {
    light_changes(0.25);
    lights();
    if (dice_.chance(0.3)) {
      add({"--integrator", "path"});
    } else {
      settings({"samples_per_pixel", "gloss", "direct_rays"});
    }
  }

  /// All two frames of a walk, or one of them by number.
  std::vector<int> frames_of(int first) {
    const int one = dice_.whole(0, 1);
    if (dice_.chance(0.1)) {
      add({"--frames", std::to_string(first + one)});
    } else {
      maybe(0.05, {"--frames", dice_.one_of({"9", "2-1", "1-2x0", "x"})});
      return {first, first + 1};
    }
    return {first + one};
  }

  void walk() {
    add({"walk"});
    scene();
    const int first = dice_.chance(0.9) ? 1 : dice_.whole(-1, 2);
    const std::vector<int> frames = frames_of(first);
    for (const int frame : frames) {
      command_.outputs.push_back(place_.folder / fmt::format("frame.{}.exr", frame));
    }
    add({"-o", (place_.folder / "frame.#.exr").string()});
    if (dice_.chance(0.2)) output("--contact-sheet", "sheet.png");
    if (dice_.chance(0.2)) {
      for (const int frame : frames) {
        command_.outputs.push_back(place_.folder / fmt::format("shown.{}.png", frame));
      }
      add({"--png", (place_.folder / "shown.#.png").string()});
    }
    if (dice_.chance(0.1)) output("--save-maps", "photons.maps");
    const double s = place_.scene.size;
    const std::string document = fmt::format(
        R"([{{"time": 0, "position": [0, 0, {0}], "look_at": [0, 0, 0], "fov": 60}},)"
        R"({{"time": 1, "position": [{0}, 0, {0}], "look_at": [0, 0, 0], "fov": {1}}}])",
        0.5 * s, dice_.chance(0.1) ? 300 : 60);
    add({"--camera-path", input("path.json", document).string(), "--fps", "1"});
    if (first != 1) add({"--first-number", std::to_string(first)});
    maybe(0.3, {"--quick"});
    film();
    if (dice_.chance(0.06)) mood();
    scene_changes();
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
    if (dice_.chance(0.1)) mood();
    maybe(0.1, {"--scale", dice_.one_of({"auto", "10", "nan", "0"})});
    tone_mapping();
  }

  void bake() {
    add({"bake"});
    scene();
    add({"-o", (place_.folder / "baked.gltf").string(), "--most-texels", "64", "--texel",
         fmt::format("{:g}", 0.2 * place_.scene.size)});
    light_changes(0.2);
    settings({"samples_per_pixel", "passes", "direct_rays", "light_maps"});
    if (dice_.chance(0.1)) output("--save-maps", "photons.maps");
  }

  /// Two points that look somewhere.
  std::filesystem::path points() {
    const double s = place_.scene.size;
    return input("points.pts", fmt::format("0 {0} 0 0 1 0\n{0} {0} 0 0 1 0.1\n", 0.1 * s) +
                                   (dice_.chance(0.1) ? "nan 0 0 0 0 0\n" : ""));
  }

  void glare() {
    add({"glare"});
    scene();
    add({"--observers", points().string(), "--rays", std::to_string(dice_.whole(1, 8)), "--repeats",
         "2", "--picture-size", std::to_string(dice_.chance(0.03) ? 15 : dice_.whole(16, 20))});
    if (dice_.chance(0.9)) output("-o", dice_.one_of({"glare.csv", "glare.json"}));
    if (dice_.chance(0.2)) output("--pictures", "views");
    maybe(0.5, {"--ratings", dice_.one_of({"ugr", "dgp", "dgi", "ugr,dgi", "ugr,dgp,dgi"})});
    maybe(0.05, {"--ratings", dice_.one_of({"", "vcp"})});
    maybe(0.1, {"--camera", dice_.one_of({"0", "default", "0", "nobody"})});
    maybe(0.1, {"--source-luminance", dice_.one_of({"5", "1000", "1e30", "0"})});
    maybe(0.2, {"--target", dice_.one_of({"office-desk", "UGR=19", "UGR=22", "UGR=-1", "hall"})});
    sensor_light();
  }

  void daylight() {
    add({"daylight"});
    scene();
    add({"--weather", weather().string(), "--points", points().string(), "--patches",
         dice_.one_of({"145", "145", "146"}), "--rays", std::to_string(dice_.whole(1, 8)),
         "--repeats", "2"});
    if (dice_.chance(0.9)) output("-o", dice_.one_of({"year.csv", "year.json"}));
    if (dice_.chance(0.2)) output("--honeybee", "hours");
    maybe(0.3, {"--suns", dice_.one_of({"rays", "patches"})});
    maybe(0.1, {"--set", dice_.one_of({"ground=0", "ground=1", "ground=1.1"})});
    maybe(0.2, {"--occupied", dice_.one_of({"8-18", "0-24", "18-8", "x"})});
    maybe(0.2, {"--lamps-to", dice_.one_of({"500", "0"})});
    maybe(0.1, {"--lux", dice_.one_of({"300", "-1", "1e30"})});
    settings({"samples_per_pixel", "gloss", "direct_rays", "quota"});
  }

  void ies() {
    const std::string candela =
        dice_.one_of({"100 100 100", "100 50 0", "1e9 1 1", "80 90 60", "0 0 0", "1 2"});
    const std::string opening =
        dice_.one_of({"0.6 0.3 0", "-0.2 -0.2 0.1", "0.6 0.3 2", "0.1 0.1 0", "0 0 0"});
    add({"ies", input("lamp.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 1 1 2 " + opening +
                                      "\n1 1 40\n0 90 180\n0\n" + candela + "\n")
                    .string()});
    if (dice_.chance(0.2)) return;
    add({"--ugr-table"});
    maybe(0.1, {"--spacing", dice_.one_of({"0.25", "2", "0", "nan"})});
    maybe(0.2, {"--per-1000-lm"});
    if (dice_.chance(0.7)) output("-o", dice_.one_of({"ugr.csv", "ugr.json"}));
  }

  void trace() {
    add({"trace"});
    scene();
    lights();
    std::vector<std::string_view> others;
    for (const Setting& setting : photile::settings()) {
      if (std::find(traced.begin(), traced.end(), setting.name) == traced.end()) {
        others.push_back(setting.name);
      }
    }
    settings(others);
    output("-o", "photons.maps");
  }
};

}  // namespace

RandomCommand random_command(const Workplace& place, Dice& dice) {
  return Generator(place, dice).make();
}

}  // namespace photile::test
