#include "loading/light_changes.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "files/scene_files.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photometry/photometric_file.hpp"
#include "scene/light_emission.hpp"
#include "scene/light_names.hpp"
#include "scene/surface_models.hpp"

namespace photile {

LightGrouping LightGrouping::parse(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw UsageError(
        fmt::format("'{}' is no group of lights; use GLOB=NAME, such as 'ceiling*=ceiling'", text));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

namespace loading {
namespace {

std::vector<std::string> names_of(const std::vector<Light>& lights) {
  std::vector<std::string> names;
  for (const Light& light : lights) names.push_back(light.name);
  return names;
}

void apply(const LightGrouping& grouping, std::vector<Light>& lights) {
  bool matched = false;
  for (Light& light : lights) {
    if (::fnmatch(grouping.glob.c_str(), light.name.c_str(), 0) != 0) continue;
    light.group = scene::clean_light_name(grouping.group, limits::max_light_name_bytes);
    matched = true;
  }
  if (!matched) {
    throw UsageError(fmt::format("light group {}={}: no light matches '{}'; there {}",
                                 grouping.glob, grouping.group, grouping.glob,
                                 scene::listed_names(names_of(lights))));
  }
}

/// Every layer has a different name.
void check_names(const std::vector<Light>& lights) {
  std::unordered_set<std::string_view> groups;
  for (const Light& light : lights) groups.insert(light.group);
  for (const Light& light : lights) {
    if (!light.group.empty() || !groups.contains(light.name)) continue;
    throw UsageError(
        fmt::format("light groups: the light '{}' is outside the group of that name; put it in or "
                    "choose another name",
                    light.name));
  }
}

}  // namespace

void group_lights(Scene& scene, std::span<const LightGrouping> groupings) {
  for (const LightGrouping& grouping : groupings) apply(grouping, scene.lights);
  check_names(scene.lights);
}

}  // namespace loading

}  // namespace photile

namespace photile::loading {

namespace {

/// The light called `name` that a `change` is for. Errors: UsageError that lists the lights there
/// are.
Light& light_named(const std::string& name, const char* change, Scene& scene) {
  const auto found = std::find_if(scene.lights.begin(), scene.lights.end(),
                                  [&](const Light& light) { return light.name == name; });
  if (found != scene.lights.end()) return *found;
  std::vector<std::string> names;
  for (const Light& light : scene.lights) names.push_back(light.name);
  throw UsageError(fmt::format("{} {}: there is no light '{}'; there {}", change, name, name,
                               scene::names_like(name, std::move(names))));
}

}  // namespace

IntensityDistribution read_user_photometry(const std::filesystem::path& file,
                                           files::Warnings& warnings) {
  std::vector<unsigned char> bytes;
  try {
    bytes = files::read_regular_file(file, limits::max_photometry_bytes);
  } catch (const files::ResourceError& error) {
    throw InputError(
        fmt::format("{}: cannot read the photometric file: {}; give an .ies or .ldt file",
                    file.string(), error.what()));
  }
  try {
    return photometry::read_photometry(file.string(), bytes, warnings);
  } catch (const files::ResourceError& error) {
    throw InputError(error.what());
  }
}

void apply_profiles(Scene& scene, std::span<const LightProfile> profiles,
                    files::Warnings& warnings) {
  for (const LightProfile& profile : profiles) {
    Light& light = light_named(profile.light, "photometric file for", scene);
    if (!light.has_position()) {
      throw UsageError(
          fmt::format("photometric file for {}: the light is neither a point nor a spot light; "
                      "name one of those",
                      profile.light));
    }
    IntensityDistribution distribution = read_user_photometry(profile.file, warnings);
    light.kind = LightKind::point;
    light.power = distribution.flux();
    light.distribution = static_cast<std::uint32_t>(scene.distributions.size());
    scene.distributions.push_back(std::move(distribution));
  }
}

void apply_temperatures(Scene& scene, std::span<const LightTemperature> temperatures) {
  for (const LightTemperature& temperature : temperatures) {
    Light& light = light_named(temperature.light, "temperature of", scene);
    if (light.kind == LightKind::environment || light.emission_texture != none) {
      throw UsageError(fmt::format(
          "temperature of {}: its colours come from a picture, which a light mix can tint",
          light.name));
    }
    light.color = glm::vec3(scene::color_of_temperature(temperature.kelvin));
  }
}

namespace {

std::string material_names(const Scene& scene) {
  constexpr std::size_t most = 20;
  std::string names;
  for (std::size_t i = 0; i < scene.materials.size() && i < most; ++i) {
    names += (i == 0 ? "'" : ", '") + scene.materials[i].name + "'";
  }
  return names + (scene.materials.size() > most ? " ..." : "");
}

/// The reflectance nearest to a fraction that a material cannot reflect, starting from `own`, which
/// it can.
double nearest_reflectance(Scene& scene, Material& material, double fraction, double own) {
  double possible = own, impossible = fraction;
  for (int step = 0; step < 20; ++step) {
    const double middle = 0.5 * (possible + impossible);
    (scene::set_reflectance(scene, material, middle) ? possible : impossible) = middle;
  }
  return possible;
}

void apply(Scene& scene, const ReflectanceChange& change) {
  bool found = false;
  for (Material& material : scene.materials) {
    if (::fnmatch(change.glob.c_str(), material.name.c_str(), 0) != 0) continue;
    found = true;
    const auto before = scene::reflectance_of(scene, material);
    if (scene::set_reflectance(scene, material, change.fraction)) continue;
    const std::string what =
        fmt::format("reflectance of '{}': {:g} cannot be had", material.name, change.fraction);
    if (!before) {
      throw UsageError(what + ": it is glass, whose colour is what it lets through");
    }
    const double own = before->whole;
    const double nearest = nearest_reflectance(scene, material, change.fraction, own);
    if (change.fraction < own) {
      throw UsageError(fmt::format(
          "{}: its gloss alone reflects {:.3g}; --set lambertian=on removes that", what, nearest));
    }
    throw UsageError(fmt::format(
        "{}: its colour exceeds 1 in a channel then; at its brightest it reflects {:.3g}, give "
        "that or less",
        what, nearest));
  }
  if (!found) {
    throw UsageError(fmt::format("reflectance of '{}': there is no such material; there are {}",
                                 change.glob, material_names(scene)));
  }
}

}  // namespace

void apply_reflectances(Scene& scene, std::span<const ReflectanceChange> changes) {
  for (const ReflectanceChange& change : changes) apply(scene, change);
}

}  // namespace photile::loading
