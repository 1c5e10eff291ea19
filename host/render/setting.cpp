#include "render/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <concepts>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "photile/limits.hpp"

namespace photile {
namespace {

const auto& all_values(MapMode) { return all_map_modes; }
const auto& all_values(MapStructure) { return all_map_structures; }
const auto& all_values(AreaMode) { return all_area_modes; }
const auto& all_values(DensityKernel) { return all_density_kernels; }
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
  } else if constexpr (std::integral<T>) {
    // What is below zero is in no range of whole numbers, as a number that is none.
    if (field < T{0}) return static_cast<double>(field);
    return static_cast<std::uint64_t>(field);
  } else {
    return std::stod(fmt::format("{}", field));  // 0.1 of a float, too
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

/// A row whose value is a field of the parameters, or of one of their parts.
template <auto... members>
Setting row(Setting setting) {
  setting.value = [](const P& parameters) { return value_of(field<members...>(parameters)); };
  setting.set = [](P& parameters, const SettingValue& value) {
    assign(field<members...>(parameters), value);
  };
  return setting;
}

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

/// One tree has other groups than all other structures.
std::string kept_for_tree(const Setting& setting, const RenderParameters& parameters) {
  const bool global = parameters.structure == MapStructure::kdtree_global;
  return global ? kept_as_it_is(setting, parameters) : std::string();
}

/// Rays leave no direct light to photons, however many there are.
std::string kept_for_direct_light(const Setting& setting, const RenderParameters& parameters) {
  return setting.is_given(parameters) ? "direct light by rays" : std::string();
}

constexpr std::uint64_t most_int = std::numeric_limits<int>::max();

std::vector<Setting> picture_settings() {
  constexpr std::string_view group = "Picture", hits = "primary hits";
  return {
      row<&P::film, &Film::width>({.name = "width",
                                   .unit = "pixels",
                                   .group = group,
                                   .reader = hits,
                                   .help = "of the picture",
                                   .range = WholeNumbers{1, limits::max_image_side}}),
      row<&P::film, &Film::height>({.name = "height",
                                    .unit = "pixels",
                                    .group = group,
                                    .reader = hits,
                                    .help = "of the picture",
                                    .range = WholeNumbers{1, limits::max_image_side}}),
      row<&P::film, &Film::samples_per_pixel>(
          {.name = "samples_per_pixel",
           .option = "samples",
           .group = group,
           .reader = hits,
           .help = "primary rays per pixel, over all passes; at least one in each",
           .range = WholeNumbers{1, limits::max_samples_per_pixel}}),
      row<&P::seed>({.name = "seed",
                     .option = "seed",
                     .group = group,
                     .reader = "all",
                     .help = "the same seed gives the same picture",
                     .range = WholeNumbers{0, std::numeric_limits<std::uint64_t>::max()},
                     .kept = kept_as_it_is}),
      row<&P::max_specular_depth>({.name = "max_specular_depth",
                                   .group = group,
                                   .reader = hits,
                                   .help = "mirrors and glass that a ray from the eye follows",
                                   .range = WholeNumbers{0, 1'000'000}}),
  };
}

std::vector<Setting> photon_rows() {
  constexpr std::string_view group = "Photons", paths = "trace photons";
  return {
      row<&P::photons, &PhotonPaths::emitted_photons>(
          {.name = "photons_emitted",
           .option = "photons",
           .group = group,
           .reader = paths,
           .help = "paths over all lights",
           .range = WholeNumbers{limits::min_photons, limits::max_emitted_photons},
           .kept = kept_as_it_is}),
      row<&P::photons, &PhotonPaths::quota>(
          {.name = "quota",
           .option = "quota",
           .group = group,
           .reader = paths,
           .help = "how the lights share the paths: by power, equally, or half by each",
           .range = words_of(all_photon_quotas),
           .kept = kept_as_it_is}),
      row<&P::photons, &PhotonPaths::max_path_length>(
          {.name = "max_path_length",
           .group = group,
           .reader = paths,
           .help = "surfaces that a photon meets at most",
           .range = WholeNumbers{1, most_int},
           .kept = kept_as_it_is}),
      row<&P::photons, &PhotonPaths::roulette_start>(
          {.name = "roulette_start",
           .group = group,
           .reader = paths,
           .help = "first bounce at which a path may end by chance",
           .range = WholeNumbers{1, most_int},
           .kept = kept_as_it_is}),
      row<&P::passes>({.name = "passes",
                       .option = "passes",
                       .group = group,
                       .reader = "all",
                       .help = "photon passes, each of its share of the paths",
                       .otherwise = "as many as the host's memory asks for",
                       .range = WholeNumbers{1, limits::max_passes}}),
  };
}

std::vector<Setting> estimate_rows() {
  constexpr std::string_view group = "Estimate", estimate = "radiance estimate";
  return {
      row<&P::neighbours>({.name = "neighbours",
                           .option = "k,neighbours",
                           .group = group,
                           .reader = estimate,
                           .help = "photons of an estimate",
                           .range = WholeNumbers{1, limits::max_neighbours},
                           .kept = kept_for_radius}),
      row<&P::least_neighbours>(
          {.name = "least_neighbours",
           .option = "least-neighbours",
           .group = group,
           .reader = estimate,
           .help =
               "each hit has its own number of neighbours, from this one up, as its bias allows",
           .otherwise = "all hits have the same",
           .range = WholeNumbers{1, limits::max_neighbours}}),
      row<&P::radius>({.name = "radius",
                       .unit = "m",
                       .option = "radius",
                       .group = group,
                       .reader = "neighbour groups",
                       .help = "no photon farther away counts",
                       .otherwise = "twice the median distance to the k-th photon",
                       .range = PositiveNumbers{},
                       .kept = kept_if_given}),
      row<&P::angle_degrees>({.name = "angle_degrees",
                              .unit = "degrees",
                              .option = "angle",
                              .group = group,
                              .reader = "neighbour groups",
                              .help = "largest angle between the normals of a group",
                              .range = Numbers{0, 180},
                              .kept = kept_as_it_is}),
      row<&P::area>(
          {.name = "area",
           .option = "area",
           .group = group,
           .reader = "surface index",
           .help = "that photons are divided by; disc: dark borders and corners, all that naive "
                   "maps have",
           .range = words_of(all_area_modes)}),
      row<&P::kernel>(
          {.name = "kernel",
           .option = "kernel",
           .group = group,
           .reader = estimate,
           .help = "that photons are weighted by; cone, epanechnikov: less blur, more noise",
           .range = words_of(all_density_kernels)}),
      row<&P::maps>({.name = "maps",
                     .option = "maps",
                     .group = group,
                     .reader = "neighbour groups",
                     .help = "naive: dark edges; patch: triangles share maps",
                     .range = words_of(all_map_modes),
                     .kept = kept_as_it_is}),
      row<&P::structure>({.name = "structure",
                          .option = "structure",
                          .group = group,
                          .reader = "build photon maps",
                          .help = "how photons are found; same neighbours",
                          .range = words_of(all_map_structures),
                          .kept = kept_for_tree}),
      row<&P::photons_per_cell>({.name = "photons_per_cell",
                                 .option = "photons-per-cell",
                                 .group = group,
                                 .reader = "build photon maps",
                                 .help = "fineness of the grids",
                                 .range = PositiveNumbers{}}),
      row<&P::direct_rays>(
          {.name = "direct_rays",
           .option = "direct-rays",
           .group = group,
           .reader = "primary hits",
           .help = "looks at lamps from a hit, which leave light straight from lamps to rays",
           .otherwise = "photons bring it; one look where rays gather",
           .range = WholeNumbers{1, limits::max_direct_rays},
           .kept = kept_for_direct_light}),
      row<&P::final_gather_rays>(
          {.name = "final_gather_rays",
           .option = "final-gather",
           .group = group,
           .reader = "final gather",
           .help = "rays from each hit that gather the light of other surfaces; direct light by "
                   "rays",
           .range = WholeNumbers{0, limits::max_final_gather_rays}}),
  };
}

}  // namespace

bool Setting::is_given(const RenderParameters& parameters) const {
  return otherwise.empty() || (value(parameters) != SettingValue{std::uint64_t{0}} &&
                               value(parameters) != SettingValue{0.0});
}

std::span<const Setting> settings() {
  static const std::vector<Setting> table = [] {
    std::vector<Setting> rows = picture_settings();
    for (const auto& more : {photon_rows(), estimate_rows()}) {
      rows.insert(rows.end(), more.begin(), more.end());
    }
    return rows;
  }();
  return table;
}

const Setting& setting_named(std::string_view name) {
  return *std::find_if(settings().begin(), settings().end(),
                       [&](const Setting& setting) { return setting.name == name; });
}

std::string text_with_unit(const Setting& setting, const RenderParameters& parameters) {
  const std::string text = text_of(setting.value(parameters));
  return setting.unit.empty() ? text : fmt::format("{} {}", text, setting.unit);
}

std::string photon_settings(const RenderParameters& parameters) {
  std::string words;
  for (const Setting& setting : settings()) {
    const std::string kept = setting.kept ? setting.kept(setting, parameters) : std::string();
    if (!kept.empty()) words += (words.empty() ? "" : ", ") + kept;
  }
  return words;
}

void check(const RenderParameters& parameters) {
  for (const Setting& setting : settings()) {
    if (!setting.is_given(parameters)) continue;
    const SettingValue value = setting.value(parameters);
    if (!contains(setting.range, value)) {
      throw SettingError(setting, out_of_range(text_of(value), setting.range));
    }
    if (setting.name == "least_neighbours" && parameters.least_neighbours > parameters.neighbours) {
      throw SettingError(setting, fmt::format("{} is more than the {} neighbours",
                                              parameters.least_neighbours, parameters.neighbours));
    }
    if (setting.name == "structure" && parameters.structure == MapStructure::kdtree_global &&
        parameters.maps == MapMode::naive) {
      throw SettingError(setting,
                         "a global kd-tree knows no triangles' maps, and so no naive ones");
    }
  }
}

}  // namespace photile
