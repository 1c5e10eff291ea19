#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "fuzz_files.hpp"
#include "measuring/sensor_files.hpp"
#include "photile/light_mix.hpp"
#include "photile/light_options.hpp"
#include "tools/command/validators.hpp"
#include "tools/view/moods.hpp"
#include "tools/walk/frame_names.hpp"

namespace photile::test {
namespace {

void check_sensors(const measuring::SensorGrid& grid) {
  require(!grid.sensors.empty(), "a grid without points");
  for (const auto& sensor : grid.sensors) {
    require(std::isfinite(glm::length(sensor.position)), "a point is nowhere");
    require(std::abs(glm::length(sensor.normal) - 1) < 1e-6, "a direction is none");
  }
}

/// Parses as a command does; throws UsageError where it refuses.
void parse_option(unsigned char option, const std::string& text) {
  const auto finite = [](double value) { require(std::isfinite(value), "no number"); };
  switch (option % 12) {
    case 0:
      app::parse_count(text);
      break;
    case 1:
      app::parse_bytes(text);
      break;
    case 2:
      if (const auto share = app::parse_share(text)) finite(*share);
      break;
    case 3:
      if (const auto seconds = app::parse_duration(text)) finite(*seconds);
      break;
    case 4:
      app::parse_size(text);
      break;
    case 5:
      app::parse_value(text, PositiveNumbers{});
      break;
    case 6: {
      LightMix mix;
      mix.lights.push_back({.name = "lamp", .members = {}, .power = 1});
      change_lights(mix, {LightChange::parse(text)});
      finite(mix.lights[0].power);
      finite(static_cast<double>(mix.lights[0].tint.x));
      break;
    }
    case 7:
      finite(Sun::parse(text).illuminance);
      break;
    case 8:
      finite(Sky::parse(text).illuminance);
      break;
    case 9:
      finite(LuminousPanel::parse(text).lumens);
      break;
    case 10:
      finite(LightTemperature::parse(text).kelvin);
      break;
    default:
      walk::FrameNames(text).of(7);
      break;
  }
}

}  // namespace

bool fuzz_points(Bytes bytes) {
  const auto file = file_of("points.pts", bytes);
  return accepts([&] { check_sensors(measuring::read_points(file)); });
}

bool fuzz_planes(Bytes bytes) {
  const auto file = file_of("planes.json", bytes);
  return accepts([&] {
    for (const auto& grid : measuring::read_planes(file)) check_sensors(grid);
  });
}

bool fuzz_moods(Bytes bytes) {
  const auto file = file_of("room.moods.json", bytes);
  return accepts([&] {
    view::LightBoard board(LightMix{{{.name = "ceiling", .members = {}, .power = 1}}});
    const view::Moods moods(file);
    for (const std::string& name : moods.names()) {
      moods.apply(name, board);
      require(std::isfinite(board.controls()[0].power), "a power is no number");
    }
  });
}

bool fuzz_options(Bytes bytes) {
  if (bytes.empty()) return false;
  std::string text(bytes.begin() + 1, bytes.end());
  std::replace(text.begin(), text.end(), '\n', ' ');  // as the command does where it tells one
  std::replace(text.begin(), text.end(), '\0', ' ');  // no argument has one
  return accepts([&] { parse_option(bytes[0], text); });
}

const std::map<std::string_view, FuzzTarget>& fuzz_targets() {
  static const std::map<std::string_view, FuzzTarget> targets{{"camera_path", fuzz_camera_path},
                                                              {"glb", fuzz_glb},
                                                              {"gltf", fuzz_gltf},
                                                              {"ies", fuzz_ies},
                                                              {"ldt", fuzz_ldt},
                                                              {"moods", fuzz_moods},
                                                              {"obj", fuzz_obj},
                                                              {"options", fuzz_options},
                                                              {"picture", fuzz_picture},
                                                              {"planes", fuzz_planes},
                                                              {"points", fuzz_points},
                                                              {"radiance", fuzz_radiance},
                                                              {"relight", fuzz_relight},
                                                              {"saved_maps", fuzz_saved_maps},
                                                              {"texture", fuzz_texture}};
  return targets;
}

}  // namespace photile::test
