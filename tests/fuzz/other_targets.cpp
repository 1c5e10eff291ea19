#include <array>
#include <cmath>

#include "command/setting_options.hpp"
#include "command/validators.hpp"
#include "daylight/daylight_metrics.hpp"
#include "daylight/sky_states.hpp"
#include "fuzz_files.hpp"
#include "glare/measure_glare.hpp"
#include "loading/light_changes.hpp"
#include "loading/load_scene.hpp"
#include "loading/surroundings.hpp"
#include "measuring/requirements.hpp"
#include "measuring/sensor_grid.hpp"
#include "measuring/working_plane.hpp"
#include "photile/layered_picture.hpp"
#include "photile/load_scene.hpp"
#include "render/setting.hpp"
#include "view/moods.hpp"
#include "walk/frames.hpp"
#include "weather/perez_sky.hpp"

namespace photile::test {
namespace {

void check_sensors(const measuring::SensorGrid& grid) {
  require(!grid.sensors.empty(), "a grid without points");
  for (const auto& sensor : grid.sensors) {
    require(std::isfinite(glm::length(sensor.position)), "a point is nowhere");
    require(std::abs(glm::length(sensor.normal) - 1) < 1e-6, "a direction is none");
  }
}

/// What a command that was given them has as lights.
void check_lights(const SceneLoadOptions& options) {
  Scene scene = lit_floor();
  loading::add_surroundings(scene, options);
  loading::apply_temperatures(scene, options.temperatures);
  loading::apply_reflectances(scene, options.reflectances);
  for (const Material& material : scene.materials) {
    require(std::isfinite(material.diffuse.x), "a colour that is no number");
  }
  loading::group_lights(scene, options.light_groups);
  for (const Light& light : scene.lights) {
    require(std::isfinite(light.power) && light.power >= 0, "a light without a power");
    require(!light.name.empty(), "a light without a name");
  }
}

constexpr Site berlin{52.5, 13.4, 1};

void check_sun(const Site& site, const LocalTime& time) {
  const weather::SunPosition sun = weather::sun_position(site, time);
  require(std::isfinite(sun.azimuth + sun.elevation), "a sun that is nowhere");
  const int day = weather::day_of_year(time);
  require(day >= 1 && day <= 366, "a day that no year has");
}

/// Errors: UsageError where the validator refuses the text. What it leaves of it is a number.
void validate(const CLI::Validator& validator, std::string text) {
  const std::string refusal = validator(text);
  if (!refusal.empty()) throw UsageError(refusal);
  require(!text.empty() && text.find("nan") == std::string::npos, "no number");
}

/// A pane with blinds.
void check_blinds(const std::string& text) {
  Scene scene = lit_floor();
  scene.materials.push_back(glass(1.5f));
  scene.materials.back().name = "Glass";
  scene.materials.back().thin = true;
  const std::array groups{daylight::BlindGroup::parse(text)};
  for (const Material& material : daylight::materials_with(scene, groups, 1)) {
    const float share = material.transmission.x;
    require(share >= 0 && share <= 1, "a pane that lets through more than there is");
  }
}

void check_occupancy(const std::string& hours, const std::string& days) {
  daylight::Occupancy occupancy;
  occupancy.set_hours(hours);
  require(occupancy.from >= 0 && occupancy.to <= 24 && occupancy.from < occupancy.to,
          "hours that no day has");
  occupancy.set_days(days);
  require(std::count(occupancy.days.begin(), occupancy.days.end(), true) > 0, "no day");
}

/// Parses as a command does; throws UsageError where it refuses.
void parse_option(unsigned char option, const std::string& text) {
  const auto finite = [](double value) { require(std::isfinite(value), "no number"); };
  SceneLoadOptions options;
  // The last bytes are those of options that came later, and 19 that of one that is gone, so that
  // older inputs keep their meaning.
  constexpr int last_options = 253;
  switch (option < last_options ? option % 23 : option) {
    case 0:
      validate(app::count_between(1, 1'000'000), text);
      break;
    case 1: {
      RenderParameters parameters;
      app::assign_named(app::rendering_settings(parameters), text);
      check(parameters);
      break;
    }
    case 2:
      validate(app::share_up_to(1), text);
      break;
    case 3:
      validate(app::duration(), text);
      break;
    case 4:
      validate(app::picture_size(), text);
      break;
    case 5:
      validate(app::positive_number(), text);
      validate(app::number_between(-1, 1), text);
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
      options.sun = Sun::parse(text);
      check_lights(options);
      break;
    case 8:
      options.sun = Sun{135, 40, 80'000};
      options.sky = Sky::parse(text);
      check_lights(options);
      break;
    case 9:
      finite(LuminousPanel::parse(text).lumens);
      break;
    case 10:
      options.temperatures.push_back(LightTemperature::parse(text));
      check_lights(options);
      break;
    case 11:
      walk::FrameNames(text).of(7);
      break;
    case 12:
      options.light_groups.push_back(LightGrouping::parse(text));
      check_lights(options);
      break;
    case 13:
      check_sun(Site::parse(text), LocalTime{});
      break;
    case 14:
      check_sun(berlin, LocalTime::parse(text));
      break;
    case 15:
      options.situation = {berlin, LocalTime{}};
      options.sun = Sun::parse(text);
      check_lights(options);
      break;
    case 16:
      options.situation = {berlin, LocalTime{}};
      options.sky = Sky::parse(text);
      check_lights(options);
      break;
    case 17:
      options.reflectances.push_back(MaterialShare::parse(text));
      check_lights(options);
      break;
    case 18: {
      const measuring::Requirement asked = measuring::parse_requirement(text);
      for (const double value : {asked.mean, asked.uniformity, asked.glare}) finite(value);
      break;
    }
    case 20:
      validate(app::frame_range(), text);
      break;
    case 21:
      finite(measuring::parse_working_plane(text).height);
      break;
    case last_options:
      check_occupancy(text, "mon-fri");
      break;
    case last_options + 1:
      check_occupancy("8-18", text);
      break;
    case last_options + 2:
      check_blinds(text);
      break;
    default:
      finite(glm::determinant(loading::turn_upright(text)));
      break;
  }
}

}  // namespace

bool fuzz_points(Bytes bytes) {
  const auto file = file_of("points.pts", bytes);
  const auto read = [&] {
    const measuring::SensorGrid points = measuring::read_points(file);
    check_sensors(points);
    for (const auto& observer : glare::observers_at(points, trace::PlanAxes())) {
      require(std::abs(glm::length(observer.up) - 1) < 1e-6, "an observer without an up");
      require(std::abs(glm::dot(observer.up, observer.forward)) < 1e-6, "an up that leans");
    }
  };
  return accepts(read, file);
}

bool fuzz_planes(Bytes bytes) {
  const auto file = file_of("planes.json", bytes);
  const auto read = [&] {
    for (const auto& grid : measuring::read_planes(file)) check_sensors(grid);
  };
  return accepts(read, file);
}

bool fuzz_moods(Bytes bytes) {
  const auto file = file_of("room.moods.json", bytes);
  return accepts([&] {
    view::LightBoard board(LightMix{{{.name = "ceiling", .members = {}, .power = 1}}});
    const view::Moods moods(file);
    for (const std::string& name : moods.names()) {
      LightMix mix{{{.name = "ceiling", .members = {}, .power = 1}}};
      accepts([&] {  // not those of lights that are not there
        moods.apply(name, board);
        change_lights(mix, moods.changes(name, mix));  // as relight --mood
      });
      require(std::isfinite(mix.lights[0].power), "a power is no number");
      require(std::isfinite(board.controls()[0].power), "a power is no number");
    }
    // What is kept of it is read again.
    view::Moods kept = moods;
    kept.keep("kept", board);
    kept.keep("gone", board);
    kept.remove("gone");
    require(view::Moods(file).names() == kept.names(), "a mood that is lost");
    view::LightBoard again(LightMix{{{.name = "ceiling", .members = {}, .power = 1}}});
    view::Moods(file).apply("kept", again);
    const double power = board.controls()[0].power;  // of which four digits are kept
    require(std::abs(again.controls()[0].power - power) <= 1e-3 * power,
            "a power that has changed");
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
                                                              {"luminaires", fuzz_luminaires},
                                                              {"moods", fuzz_moods},
                                                              {"obj", fuzz_obj},
                                                              {"options", fuzz_options},
                                                              {"picture", fuzz_picture},
                                                              {"planes", fuzz_planes},
                                                              {"points", fuzz_points},
                                                              {"radiance", fuzz_radiance},
                                                              {"relight", fuzz_relight},
                                                              {"saved_maps", fuzz_saved_maps},
                                                              {"schedules", fuzz_schedules},
                                                              {"texture", fuzz_texture},
                                                              {"weather", fuzz_weather}};
  return targets;
}

}  // namespace photile::test
