// The sky over the scene at any hour of the year: patches whose luminances follow the sun.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "photile/defaults.hpp"
#include "photile/layered_picture.hpp"
#include "photile/load_scene.hpp"
#include "photile/scene.hpp"
#include "weather/perez_sky.hpp"
#include "weather/sky_patches.hpp"
#include "weather/weather_file.hpp"

namespace photile::view {

/// A moment of any year, in the site's standard time.
struct SkyMoment {
  int day = defaults::view_day;       ///< of a year without a leap day, from 1
  double hour = defaults::view_hour;  ///< from midnight, in [0, 24)

  static SkyMoment of(const LocalTime& time);
  LocalTime time() const;

  /// Hours later, or earlier: days follow, from the last of the year to the first.
  void add_hours(double hours);
  void add_days(int days);

  bool operator==(const SkyMoment&) const = default;
};

/// "21 March", and "12:00".
std::string day_text(const SkyMoment& moment);
std::string hour_text(const SkyMoment& moment);

/// Where options give a site or a weather file, or ask for patches, and for no other sky or sun:
/// puts patches into the scene that is to be loaded, and returns the site and the time that move
/// them. Without a site they are one group of lights.
SkySituation take_moving_sky(SceneLoadOptions& options);

class MovingSky {
 public:
  /// The patches that lights of a mix are; null where they are none, or where no place is given.
  /// The sky is that of the weather file's hour, or a clear one. Errors: those of read_weather.
  static std::shared_ptr<const MovingSky> of(const LightMix& mix, const SkySituation& situation);

  /// The lights of the mix that it is made of.
  const std::vector<std::size_t>& lights() const { return lights_; }

  /// The power of each of them, in its own unit.
  std::vector<double> powers(const SkyMoment& moment) const;

  weather::SunPosition sun(const SkyMoment& moment) const;
  weather::SkyIrradiance irradiance(const SkyMoment& moment) const;

  /// "sun 47 degrees high in the SW", or that it is night.
  std::string text(const SkyMoment& moment) const;

 private:
  MovingSky() = default;

  std::vector<weather::SkyPatch> patches_;
  std::vector<std::size_t> lights_;  ///< of each patch, and of the ground
  std::vector<double> unit_powers_;  ///< of each, at 1 cd/m2
  Site site_;
  std::optional<weather::WeatherYear> weather_;  ///< none: clear skies
};

}  // namespace photile::view
