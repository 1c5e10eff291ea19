#include "view/moving_sky.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <utility>

#include "loading/surroundings.hpp"
#include "weather/perez_sky.hpp"
#include "weather/sky_patches.hpp"

namespace photile::view {
namespace {

constexpr double degrees = 180 / std::numbers::pi;
constexpr int days_in_year = 365;
constexpr int year = LocalTime{}.year;
static_assert(!std::chrono::year(year).is_leap());

}  // namespace

SkyMoment SkyMoment::of(const LocalTime& time) {
  LocalTime same = time;
  same.year = year;
  if (same.month == 2 && same.day == 29) same.day = 28;
  return {weather::day_of_year(same), time.hour};
}

LocalTime SkyMoment::time() const {
  using namespace std::chrono;
  const year_month_day date(sys_days(std::chrono::year(year) / 1 / 1) + days(day - 1));
  return {year, static_cast<int>(static_cast<unsigned>(date.month())),
          static_cast<int>(static_cast<unsigned>(date.day())), hour};
}

void SkyMoment::add_hours(double hours) {
  const double later = hour + hours;
  const double whole = std::floor(later / 24);
  hour = later - 24 * whole;
  add_days(static_cast<int>(whole));
}

void SkyMoment::add_days(int days) {
  day = ((day - 1 + days) % days_in_year + days_in_year) % days_in_year + 1;
}

std::string day_text(const SkyMoment& moment) {
  constexpr std::array months{"January",   "February", "March",    "April",
                              "May",       "June",     "July",     "August",
                              "September", "October",  "November", "December"};
  const LocalTime time = moment.time();
  return fmt::format("{} {}", time.day, months[static_cast<std::size_t>(time.month - 1)]);
}

std::string hour_text(const SkyMoment& moment) {
  const int minutes = std::min(24 * 60 - 1, static_cast<int>(std::lround(60 * moment.hour)));
  return fmt::format("{:02}:{:02}", minutes / 60, minutes % 60);
}

SkySituation take_moving_sky(SceneLoadOptions& options) {
  SkySituation& situation = options.situation;
  const bool placed = situation.site || !situation.weather.empty();
  const bool asked = options.sky ? options.sky->kind == SkyKind::patches : placed;
  if (!asked || options.sun || (situation.time && !placed)) return {};
  if (!placed) {  // nothing moves its patches: they are one line of the lights
    for (const char* const glob : {"sky_[0-9]*", "ground"}) {
      options.light_groups.insert(options.light_groups.begin(), {glob, "sky"});
    }
  }
  if (!options.sky) options.sky = Sky{SkyKind::patches, 0, 0, 0, defaults::view_sky_patches};
  SkySituation taken;
  taken.north_degrees = situation.north_degrees;  // the patches know it
  std::swap(taken, situation);
  return taken;
}

std::shared_ptr<const MovingSky> MovingSky::of(const LightMix& mix, const SkySituation& situation) {
  const std::shared_ptr<MovingSky> sky(new MovingSky);
  sky->patches_ = loading::patches_of(mix);
  if (sky->patches_.empty()) return nullptr;
  if (!situation.weather.empty()) sky->weather_ = weather::read_weather(situation.weather);
  if (!situation.site && !sky->weather_) return nullptr;
  sky->site_ = situation.site ? *situation.site : sky->weather_->site;
  for (std::size_t i = 0; i <= sky->patches_.size(); ++i) {
    const std::string name = loading::sky_light_name(i, sky->patches_.size());
    const auto found = std::find_if(mix.lights.begin(), mix.lights.end(),
                                    [&](const MixedLight& light) { return light.name == name; });
    if (found == mix.lights.end()) return nullptr;  // the ground may have been put into a group
    const double of_unit = found->unit == PowerUnit::lumen ? 1.0 : 1.0 / mix.lumen_per_watt;
    sky->lights_.push_back(static_cast<std::size_t>(found - mix.lights.begin()));
    sky->unit_powers_.push_back(of_unit * found->power);
  }
  return sky;
}

weather::SunPosition MovingSky::sun(const SkyMoment& moment) const {
  const LocalTime time = moment.time();
  return weather::sun_position(
      site_, weather_ ? weather::middle_of(weather::hour_at(*weather_, time), time) : time);
}

weather::SkyIrradiance MovingSky::irradiance(const SkyMoment& moment) const {
  if (weather_) return weather::hour_at(*weather_, moment.time()).irradiance;
  return weather::clear_sky(sun(moment).elevation, moment.day);
}

std::vector<double> MovingSky::powers(const SkyMoment& moment) const {
  std::vector<double> powers =
      weather::sky_luminances(patches_, sun(moment), irradiance(moment), moment.day);
  for (std::size_t i = 0; i < powers.size(); ++i) powers[i] *= unit_powers_[i];
  return powers;
}

std::string MovingSky::text(const SkyMoment& moment) const {
  const weather::SunPosition place = sun(moment);
  const double height = degrees * place.elevation;
  if (!(height > 0)) {
    return fmt::format("night: the sun is {:.0f} degrees below the horizon", -height);
  }
  const weather::SkyIrradiance light = irradiance(moment);
  return fmt::format("the sun is {:.0f} degrees high in the {}; direct {:.0f}, diffuse {:.0f} W/m2",
                     height, weather::compass_point(degrees * place.azimuth), light.direct_normal,
                     light.diffuse_horizontal);
}

}  // namespace photile::view
