#include "daylight/sky_states.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <utility>

#include "common/ascii_text.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "scene/panes.hpp"
#include "trace/random_stream.hpp"

namespace photile::daylight {

namespace {

// IES LM-83-12.
constexpr float glaring_lux = 1'000;
constexpr double most_points = 0.02;

void close(const BlindGroup& group, Material& material) {
  const auto transmittance = scene::pane_transmittance(material);
  if (!transmittance) {
    throw UsageError(fmt::format(
        "--blinds {}: '{}' is not thin glass; give the scene with closed blinds as a file",
        group.glob, material.name));
  }
  const double now = luminance(*transmittance);
  if (group.transmittance > now + 1e-6) {
    throw UsageError(
        fmt::format("--blinds {}={:g}: '{}' transmits {:.3g} without blinds; give less", group.glob,
                    group.transmittance, material.name, now));
  }
  scene::set_transmittance(material, group.transmittance);
}

}  // namespace

BlindGroup BlindGroup::parse(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  const auto value = equals == std::string::npos || equals == 0
                         ? std::nullopt
                         : parse_signed(text.substr(equals + 1));
  if (!value || !(*value >= 0) || *value > 1) {
    throw UsageError(fmt::format(
        "--blinds {}: use MATERIAL=TRANSMITTANCE, such as 'Glass*=0.05', or a scene file", text));
  }
  return {text.substr(0, equals), *value};
}

std::vector<Material> materials_with(const Scene& scene, std::span<const BlindGroup> groups,
                                     BlindState state) {
  std::vector<Material> materials = scene.materials;
  for (std::size_t group = 0; group < groups.size(); ++group) {
    bool found = false;
    for (Material& material : materials) {
      if (::fnmatch(groups[group].glob.c_str(), material.name.c_str(), 0) != 0) continue;
      found = true;
      if ((state >> group & 1) != 0) close(groups[group], material);
    }
    if (!found) {
      throw UsageError(fmt::format(
          "--blinds {}: there is no such material; photile info lists them", groups[group].glob));
    }
  }
  return materials;
}

std::vector<std::size_t> blind_schedule(std::span<const std::vector<float>> sun,
                                        std::span<const int> closed, std::size_t sensors,
                                        std::size_t hours) {
  std::vector<std::size_t> order(sun.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return closed[a] < closed[b]; });
  std::vector<std::size_t> chosen(hours, order.back());
  for (std::size_t hour = 0; hour < hours; ++hour) {
    for (const std::size_t state : order) {
      std::size_t bright = 0;
      for (std::size_t sensor = 0; sensor < sensors; ++sensor)
        bright += sun[state][sensor * hours + hour] >= glaring_lux ? 1 : 0;
      if (static_cast<double>(bright) > most_points * static_cast<double>(sensors)) continue;
      chosen[hour] = state;
      break;
    }
  }
  return chosen;
}

namespace {

std::string name_of(std::span<const BlindGroup> groups, BlindState state) {
  if (state == 0) return "open";
  if (std::cmp_equal(std::popcount(state), groups.size())) return "closed";
  std::string name;
  for (std::size_t group = 0; group < groups.size(); ++group) {
    if ((state >> group & 1) != 0) name += (name.empty() ? "closed: " : ", ") + groups[group].glob;
  }
  return name;
}

}  // namespace

SkyState sky_state(const Year& year, const Scene& scene, std::string name, int closed,
                   Progress& progress) {
  SkyState state{std::move(name), closed, {}, {}, {}};
  state.matrix = daylight_matrix(scene, year.sensors, year.patches, year.parameters, progress);
  if (year.suns_by_rays) {
    state.sun = sun_profile(DirectLight(scene, year.sensors), year.hours, year.parameters.north,
                            year.parameters.measuring.maintenance);
  }
  return state;
}

void light_hours(const Year& year, std::vector<SkyState>& states) {
  for (SkyState& state : states) {
    state.lux = annual_profile(state.matrix, year.hours, year.patches, state.sun);
  }
}

Year SkyRounds::year_of_next(const Year& year) const {
  Year next = year;
  if (count_ == 0) return next;
  next.suns_by_rays = false;
  std::uint64_t& seed = next.parameters.measuring.photons.seed;
  // A round's own repeats have the numbers below.
  seed = trace::seed_of_repeat(seed, static_cast<std::uint32_t>(limits::max_repeats + count_));
  return next;
}

void SkyRounds::add(std::vector<SkyState> round) {
  const std::size_t part = count_ % most_parts, before = count_++ / most_parts;
  if (before == 0) {
    parts_.push_back(std::move(round));
    return;
  }
  const double share = 1 / (1 + static_cast<double>(before));
  for (std::size_t state = 0; state < round.size(); ++state) {
    DaylightMatrix& mean = parts_[part][state].matrix;
    mean =
        DaylightMatrix::mean(std::array{&std::as_const(mean), &std::as_const(round[state].matrix)},
                             std::array{1 - share, share});
  }
}

std::vector<double> SkyRounds::part_fractions() const {
  std::vector<double> fractions;
  for (std::size_t part = 0; part < parts_.size(); ++part) {
    const std::size_t rounds = (count_ - part + most_parts - 1) / most_parts;
    fractions.push_back(static_cast<double>(rounds) / static_cast<double>(count_));
  }
  return fractions;
}

std::vector<SkyState> SkyRounds::mean(std::optional<std::size_t> without) const {
  const std::vector<double> fractions = part_fractions();
  const double all = without ? 1 - fractions[*without] : 1;
  std::vector<SkyState> states;
  for (std::size_t state = 0; state < parts_.front().size(); ++state) {
    std::vector<const DaylightMatrix*> matrices;
    std::vector<double> shares;
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      if (part == without) continue;
      matrices.push_back(&parts_[part][state].matrix);
      shares.push_back(fractions[part] / all);
    }
    const SkyState& first = parts_.front()[state];
    states.push_back(
        {first.name, first.closed, DaylightMatrix::mean(matrices, shares), first.sun, {}});
  }
  return states;
}

std::vector<SkyState> sky_states(const Year& year, Scene& scene, std::span<const BlindGroup> groups,
                                 Progress& progress) {
  const std::vector<Material> open = scene.materials;
  const BlindState all = (BlindState{1} << groups.size()) - 1;
  std::vector<SkyState> states;
  for (BlindState state = 0; state <= all; ++state) {
    std::vector<Material> materials = materials_with(scene, groups, state);
    std::swap(scene.materials, materials);
    states.push_back(
        sky_state(year, scene, name_of(groups, state), std::popcount(state), progress));
    scene.materials = open;
  }
  return states;
}

ScheduledSky scheduled_sky(const Year& year, const std::vector<SkyState>& states) {
  const std::size_t hours = year.hours.size(), sensors = year.sensors.size();
  std::vector<std::vector<float>> sun;
  std::vector<int> closed;
  for (const SkyState& state : states) {
    sun.push_back(state.sun);
    closed.push_back(state.closed);
  }
  ScheduledSky scheduled{blind_schedule(sun, closed, sensors, hours), {}};
  scheduled.lux.resize(sensors * hours);
  for (std::size_t i = 0; i < scheduled.lux.size(); ++i)
    scheduled.lux[i] = states[scheduled.state_of_hour[i % hours]].lux[i];
  return scheduled;
}

}  // namespace photile::daylight
