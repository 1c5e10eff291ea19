#include "render/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "photile/defaults.hpp"
#include "photile/limits.hpp"

namespace photile {
namespace {

const auto& all_values(MapMode) { return all_map_modes; }
const auto& all_values(AreaMode) { return all_area_modes; }
const auto& all_values(DensityKernel) { return all_density_kernels; }
const auto& all_values(LightMapMode) { return all_light_map_modes; }
const auto& all_values(GlossMode) { return all_gloss_modes; }
const auto& all_values(PhotonQuota) { return all_photon_quotas; }

template <class Values>
Words words_of(const Values& values) {
  Words result;
  for (const auto value : values) result.words.push_back(name_of(value));
  return result;
}

template <class T>
SettingValue value_of(const T& field) {
  if constexpr (std::is_enum_v<T>) {
    return name_of(field);
  } else {
    return setting_value(field);
  }
}

template <class T>
void assign(T& field, const SettingValue& value) {
  if constexpr (std::is_enum_v<T>) {
    for (const T one : all_values(T{})) {
      if (name_of(one) == std::get<std::string_view>(value)) field = one;
    }
  } else if constexpr (std::integral<T>) {
    field = static_cast<T>(std::get<std::uint64_t>(value));
  } else {
    field = static_cast<T>(std::get<double>(value));
  }
}

using P = RenderParameters;

template <auto member, auto... of_member>
auto& field(auto& owner) {
  if constexpr (sizeof...(of_member) == 0) {
    return owner.*member;
  } else {
    return field<of_member...>(owner.*member);
  }
}

using Kept = decltype(Setting::kept);

/// A row whose value is a field of the parameters, or of one of their parts.
template <auto... members>
Setting row(std::string_view name, std::string_view reader, ValueRange range, std::string_view help,
            Kept kept, std::string otherwise = {}, std::string_view unit = {}) {
  return {.name = name,
          .unit = unit,
          .reader = reader,
          .help = help,
          .otherwise = std::move(otherwise),
          .range = std::move(range),
          .kept = kept,
          .value = [](const P& parameters) { return value_of(field<members...>(parameters)); },
          .set = [](P& parameters,
                    const SettingValue& value) { assign(field<members...>(parameters), value); }};
}

/// A row that qualities set.
template <class Number>
Setting by_quality(Setting setting, Number draft, Number good, Number best) {
  setting.by_quality = {setting_value(draft), setting_value(good), setting_value(best)};
  return setting;
}

/// A row that neighbour groups depend on, but no photons.
Setting of_groups(Setting setting) {
  setting.kept_for_groups = true;
  return setting;
}

constexpr Kept not_kept = nullptr;

std::string kept_as_it_is(const Setting& setting, const RenderParameters& parameters) {
  return fmt::format("{} {}", setting.name, text_with_unit(setting, parameters));
}

std::string kept_if_given(const Setting& setting, const RenderParameters& parameters) {
  return setting.is_given(parameters) ? kept_as_it_is(setting, parameters) : std::string();
}

/// The radius follows k where it is not given.
std::string kept_for_radius(const Setting& setting, const RenderParameters& parameters) {
  return parameters.radius > 0 ? std::string() : kept_as_it_is(setting, parameters);
}

/// Rays leave no direct light to photons, however many there are.
std::string kept_for_direct_light(const Setting& setting, const RenderParameters& parameters) {
  return setting.is_given(parameters) ? "direct light by rays" : std::string();
}

/// Options of the command, by the settings that they set. All other settings go by their names.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> options{
    {{"width", "size"},
     {"height", "size"},
     {"samples_per_pixel", "samples"},
     {"seed", "seed"},
     {"photons_emitted", "photons"},
     {"neighbours", "k,neighbours"}}};

constexpr std::uint64_t most_int = std::numeric_limits<int>::max();
constexpr std::uint64_t most_seed = std::numeric_limits<std::uint64_t>::max();

std::vector<Setting> picture_rows() {
  constexpr std::string_view hits = "primary hits";
  return {
      row<&P::film, &Film::width>("width", hits, WholeNumbers{1, limits::max_image_side},
                                  "width of the picture", not_kept, "", "pixels"),
      row<&P::film, &Film::height>("height", hits, WholeNumbers{1, limits::max_image_side},
                                   "height of the picture", not_kept, "", "pixels"),
      by_quality(row<&P::film, &Film::samples_per_pixel>(
                     "samples_per_pixel", hits, WholeNumbers{1, limits::max_samples_per_pixel},
                     "primary rays per pixel over all passes, at least one per pass; from 8 on, "
                     "pixels with edges get up to four times as many, at most 64",
                     not_kept),
                 8, 16, 64),
      row<&P::seed>("seed", "all", WholeNumbers{0, most_seed},
                    "the same seed gives the same picture", kept_as_it_is),
      row<&P::max_specular_depth>(
          "max_specular_depth", hits, WholeNumbers{0, limits::max_specular_depth},
          "maximum number of mirrors and glass surfaces that a ray from the eye follows", not_kept),
  };
}

std::vector<Setting> photon_rows() {
  constexpr std::string_view paths = "trace photons";
  return {
      by_quality(row<&P::photons, &PhotonPaths::emitted_photons>(
                     "photons_emitted", paths,
                     WholeNumbers{limits::min_photons, limits::max_emitted_photons},
                     "photon paths over all lights", kept_as_it_is),
                 150'000, 1'500'000, 6'000'000),
      row<&P::photons, &PhotonPaths::quota>(
          "quota", paths, words_of(all_photon_quotas),
          "how the lights share the paths: by power, equally, or balanced: half by each",
          kept_as_it_is),
      row<&P::photons, &PhotonPaths::max_path_length>(
          "max_path_length", paths, WholeNumbers{1, most_int},
          "maximum number of surfaces that a photon meets", kept_as_it_is),
      row<&P::photons, &PhotonPaths::roulette_start>(
          "roulette_start", paths, WholeNumbers{1, most_int},
          "first bounce at which Russian roulette may end a path", kept_as_it_is),
      row<&P::passes>("passes", "all", WholeNumbers{1, limits::max_passes},
                      "photon passes, each with a part of the paths; with light maps, each with a "
                      "part of all work",
                      not_kept, "as many as the host's memory needs"),
  };
}

std::vector<Setting> estimate_rows() {
  constexpr std::string_view estimate = "radiance estimate", groups = "neighbour groups",
                             build = "build photon maps";
  return {
      by_quality(of_groups(row<&P::neighbours>("neighbours", estimate,
                                               WholeNumbers{1, limits::max_neighbours},
                                               "photons in an estimate", kept_for_radius)),
                 25, 100, 100),
      of_groups(row<&P::radius>("radius", groups, PositiveNumbers{},
                                "largest distance of photons in an estimate", kept_if_given,
                                "twice the median distance to the k-th photon", "m")),
      of_groups(row<&P::angle_degrees>("angle_degrees", groups, Numbers{0, 180},
                                       "largest angle between the normals of a group",
                                       kept_as_it_is, "", "degrees")),
      row<&P::area>("area", "surface index", words_of(all_area_modes),
                    "area by which flux is divided; disc: darkens borders and corners, the only "
                    "one with naive maps",
                    not_kept),
      row<&P::kernel>("kernel", estimate, words_of(all_density_kernels),
                      "weights of photons; cone: less blur, more noise", not_kept),
      of_groups(row<&P::maps>(
          "maps", groups, words_of(all_map_modes),
          "kind of photon maps; naive: darkens edges; patch: triangles share maps", kept_as_it_is)),
      row<&P::photons_per_cell>("photons_per_cell", build, PositiveNumbers{},
                                "fineness of the search grids", not_kept),
      row<&P::direct_rays>(
          "direct_rays", "primary hits", WholeNumbers{1, limits::max_direct_rays},
          "light samples per hit, which replace photons that come directly from lights",
          kept_for_direct_light, "photons carry direct light"),
      row<&P::gloss>("gloss", "primary hits", words_of(all_gloss_modes),
                     "how glossy reflections are found; filtered: by rays, whose noise is averaged "
                     "over pixels; auto: filtered where light maps are read, otherwise photons",
                     not_kept),
      row<&P::light_maps>("light_maps", "light maps", words_of(all_light_map_modes),
                          "interpolate the light of matt surfaces between nodes; auto: except with "
                          "naive maps or several passes; off: an estimate at each hit",
                          not_kept),
      by_quality(row<&P::light_map_rays>("light_map_rays", "light maps",
                                         WholeNumbers{0, limits::max_gathering_rays},
                                         "rays, and light samples, by which a node of light maps "
                                         "gathers light; 0: nodes hold photon estimates",
                                         not_kept),
                 16, 64, 256),
      by_quality(row<&P::light_map_detail>(
                     "light_map_detail", "light maps", PositiveNumbers{},
                     "largest distance between the finest nodes of light maps", not_kept,
                     "an eighth of the coarsest, which follows from the photons", "m"),
                 defaults::no_detail, 0.0, 0.0),
  };
}

std::string kept_settings(const RenderParameters& parameters, bool for_groups) {
  std::string words;
  for (const Setting& setting : settings()) {
    if (!setting.kept || setting.kept_for_groups != for_groups) continue;
    const std::string kept = setting.kept(setting, parameters);
    if (!kept.empty()) words += (words.empty() ? "" : ", ") + kept;
  }
  return words;
}

}  // namespace

bool Setting::is_given(const RenderParameters& parameters) const {
  return otherwise.empty() || (value(parameters) != SettingValue{std::uint64_t{0}} &&
                               value(parameters) != SettingValue{0.0});
}

std::span<const Setting> settings() {
  static const std::vector<Setting> table = [] {
    std::vector<Setting> rows;
    const auto append = [&](std::string_view group, std::vector<Setting> more) {
      for (Setting& setting : more) setting.group = group;
      rows.insert(rows.end(), more.begin(), more.end());
    };
    append("Picture", picture_rows());
    append("Photons", photon_rows());
    append("Estimate", estimate_rows());
    for (Setting& setting : rows) {
      for (const auto& [name, option] : options) {
        if (setting.name == name) setting.option = option;
      }
    }
    return rows;
  }();
  return table;
}

const Setting& setting_named(std::string_view name) {
  return *std::find_if(settings().begin(), settings().end(),
                       [&](const Setting& setting) { return setting.name == name; });
}

SettingValue scaled(const Setting& setting, const RenderParameters& parameters, double factor) {
  const SettingValue value = setting.value(parameters);
  if (const auto* number = std::get_if<double>(&value)) return factor * *number;
  const auto& range = std::get<WholeNumbers>(setting.range);
  const double product = factor * static_cast<double>(std::get<std::uint64_t>(value));
  return static_cast<std::uint64_t>(std::clamp(
      std::round(product), static_cast<double>(range.least), static_cast<double>(range.most)));
}

std::string text_with_unit(const Setting& setting, const RenderParameters& parameters) {
  const std::string text = text_of(setting.value(parameters));
  return setting.unit.empty() ? text : fmt::format("{} {}", text, setting.unit);
}

std::string photon_settings(const RenderParameters& parameters) {
  return kept_settings(parameters, false);
}

std::string group_settings(const RenderParameters& parameters) {
  return kept_settings(parameters, true);
}

void check_setting(std::string_view name, const SettingValue& value) {
  const Setting& setting = setting_named(name);
  if (contains(setting.range, value)) return;
  throw SettingError(setting, out_of_range(text_of(value), setting.range));
}

void check(const RenderParameters& parameters) {
  for (const Setting& setting : settings()) {
    if (setting.is_given(parameters)) check_setting(setting.name, setting.value(parameters));
  }
}

}  // namespace photile
