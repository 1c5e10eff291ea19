#include "render/quality.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "common/ascii_text.hpp"
#include "photile/defaults.hpp"
#include "photile/renderer.hpp"
#include "render/render_plan.hpp"
#include "render/setting.hpp"

namespace photile {
namespace {

bool is_work(const Setting& setting) {
  return setting.is_of_quality() &&
         setting.by_quality[index_of(Quality::best)] > setting.by_quality[index_of(Quality::good)];
}

}  // namespace

std::string_view name_of(Quality quality) { return name_in({"draft", "good", "final"}, quality); }

std::string_view description_of(Quality quality) {
  return name_in({"quick, and soft: nodes of light maps lie far apart", "clean to the eye",
                  "more photons, samples and rays, for stills"},
                 quality);
}

void set_quality(RenderParameters& parameters, Quality quality) {
  for (const Setting& setting : settings()) {
    if (setting.is_of_quality()) setting.set(parameters, setting.by_quality[index_of(quality)]);
  }
}

std::vector<std::string_view> setting_names() {
  std::vector<std::string_view> names;
  for (const Setting& setting : settings()) names.push_back(setting.name);
  return names;
}

void set_by_name(RenderParameters& parameters, std::string_view name,
                 const std::variant<std::uint64_t, double, std::string_view>& value) {
  const auto all = settings();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Setting& setting) { return setting.name == name; });
  if (found == all.end()) {
    throw UsageError(fmt::format("{}: there is no such setting; there are {}", name,
                                 fmt::join(setting_names(), ", ")));
  }
  SettingValue fitting = value;
  const bool any_number = std::holds_alternative<Numbers>(found->range) ||
                          std::holds_alternative<PositiveNumbers>(found->range);
  if (const auto* whole = std::get_if<std::uint64_t>(&value); whole && any_number) {
    fitting = static_cast<double>(*whole);
  }
  if (!contains(found->range, fitting)) {
    throw SettingError(*found, out_of_range(text_of(fitting), found->range));
  }
  found->set(parameters, fitting);
}

RenderParameters with_work(RenderParameters parameters, double factor) {
  for (const Setting& setting : settings()) {
    if (is_work(setting)) setting.set(parameters, scaled(setting, parameters, factor));
  }
  return parameters;
}

int most_work(const RenderParameters& parameters) {
  std::uint64_t most = std::numeric_limits<int>::max();
  for (const Setting& setting : settings()) {
    const SettingValue value = setting.value(parameters);
    const auto* const whole = std::get_if<std::uint64_t>(&value);
    if (!is_work(setting) || !whole || *whole == 0) continue;
    most = std::min(most, std::get<WholeNumbers>(setting.range).most / *whole);
  }
  return static_cast<int>(most);
}

RenderParameters first_picture_parameters(const RenderParameters& asked) {
  RenderParameters first = asked;
  first.photons.emitted_photons =
      std::min(asked.photons.emitted_photons, defaults::view_first_photons);
  first.passes = 1;
  first.radius = 0;
  first.light_maps = LightMapMode::on;
  first.counts_hidden_photons = true;
  if (nodes_gather(asked)) {
    first.neighbours = defaults::view_first_neighbours;
    first.light_map_rays = (asked.light_map_rays + 3) / 4;
    first.light_map_spacing = defaults::view_first_spacing;
    first.light_map_detail = defaults::view_first_spacing / 4;
  } else {
    first.direct_rays = first.light_map_rays = 0;
    first.light_map_detail = defaults::no_detail;
  }
  if (asked.maps == MapMode::naive) first.maps = MapMode::automatic;
  return first;
}

}  // namespace photile
