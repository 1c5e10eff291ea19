// What is placed in and around a scene: luminaires, and the weather.
#include <cmath>
#include <string_view>
#include <vector>

#include "daylight/daylight_metrics.hpp"
#include "files/scene_files.hpp"
#include "fuzz_files.hpp"
#include "loading/luminaires.hpp"
#include "photile/scene.hpp"
#include "scene/light_names.hpp"
#include "weather/sky_patches.hpp"
#include "weather/weather_file.hpp"

namespace photile::test {
namespace {

/// Half of its light goes down, evenly; the opening is a rectangle.
constexpr std::string_view sound_lamp =
    "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 1 1 2 0.6 0.3 0\n1 1 40\n0 90 180\n0\n100 100 100\n";

/// A room with y up, with a camera in it.
const Scene& room() {
  static const Scene scene = [] {
    SceneBuilder builder("room");
    builder.box(glm::vec3(0.0f), {4, 2.5f, 3}, builder.add(diffuse(0.5f)), true);
    builder.add(point_light("lamp", {2, 2, 1}));
    Scene built = builder.build();
    Camera camera;
    camera.position = {2, 1.5, 2.5};
    built.cameras = {camera};
    return built;
  }();
  return scene;
}

/// Its sky and sun, as renderings and years of daylight take them.
void check_hour(const Site& site, const weather::WeatherHour& hour) {
  static const auto patches = weather::sky_patches(145);
  static const weather::SkyInPatches in_patches(patches);
  const LocalTime time{2024, hour.month, hour.day, hour.hour};  // a leap year
  const weather::SunPosition sun = weather::sun_position(site, time);
  require(std::isfinite(sun.azimuth + sun.elevation), "a sun that is nowhere");
  const weather::PerezSky sky(sun.elevation, hour.irradiance, weather::day_of_year(time));
  const auto lux = [](double value) { return std::isfinite(value) && value >= 0; };
  require(lux(sky.direct_illuminance()), "a sun of no lux");
  require(lux(sky.diffuse_illuminance()), "a sky of no lux");
  for (const double luminance : in_patches.luminances(sky, sun)) {
    require(lux(luminance), "a patch of the sky of no luminance");
  }
  double all = 0;
  for (const auto& [patch, share] : in_patches.sun(sun)) {
    require(patch < patches.size(), "a patch that is not there");
    all += share;
  }
  require(std::abs(all - 1) < 1e-9, "shares of the sun that are not all of it");
}

}  // namespace

bool fuzz_luminaires(Bytes bytes) {
  const auto end = std::find(bytes.begin(), bytes.end(), 0);
  const auto json = static_cast<std::size_t>(end - bytes.begin());
  const Bytes rest = bytes.subspan(std::min(json + 1, bytes.size()));
  const Bytes sound(reinterpret_cast<const unsigned char*>(sound_lamp.data()), sound_lamp.size());
  file_of("lamp.ies", rest.empty() ? sound : rest);
  file_of("lamp.ldt", rest);
  const auto file = file_of("luminaires.json", bytes.first(json));
  return accepts([&] {
    Scene scene = room();
    files::Warnings warnings;
    const loading::LuminaireList list = loading::read_luminaires(file);
    const auto written = loading::LuminaireList::parse(list.text(), "written");
    require(written == list, "written they are others");
    loading::add_luminaires(list, file, false, 683, scene, warnings);
    scene::make_light_names_unique(scene.lights);
    try {
      check_scene(scene);
    } catch (const Error& error) {
      throw std::logic_error(std::string("placed, but no scene: ") + error.what());
    }
  });
}

bool fuzz_weather(Bytes bytes) {
  const auto file = file_of("weather.epw", bytes);
  return accepts([&] {
    // The file may have fewer hours than a year, whose text has a megabyte.
    const weather::WeatherYear year = weather::read_weather_hours(file);
    constexpr std::size_t most_checked = 8;
    for (std::size_t i = 0; i < std::min(most_checked, year.hours.size()); ++i) {
      check_hour(year.site, year.hours[i]);
    }
  });
}

bool fuzz_schedules(Bytes bytes) {
  daylight::Occupancy occupancy;
  occupancy.schedule = file_of("schedule.csv", bytes);
  static const std::vector<daylight::SkyHour> hours(24);
  return accepts([&] {
    require(daylight::occupied_hours(hours, occupancy).size() == hours.size(), "hours that lack");
  });
}

}  // namespace photile::test
