#include "loading/light_changes.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photometry/photometric_file.hpp"
#include "scene/light_emission.hpp"
#include "scene/light_names.hpp"
#include "scene/panes.hpp"
#include "scene/surface_models.hpp"

namespace photile {

LightGrouping LightGrouping::parse(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw UsageError(fmt::format(
        "'{}' is not a group of lights; use GLOB=NAME, such as 'ceiling*=ceiling'", text));
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
        fmt::format("light groups: the light '{}' is not in the group of the same name; add it to "
                    "the group or choose another name",
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
          fmt::format("photometric file for {}: the light is neither a point light nor a spot "
                      "light; name one of those",
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
      throw UsageError(
          fmt::format("temperature of {}: its colours come from a picture; tint it by --light "
                      "NAME=#RRGGBB instead",
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

/// Calls visit(number) for each material that the pattern matches. Errors: UsageError without any.
///   what   is said of it
template <class Visit>
void for_each_match(const Scene& scene, const MaterialShare& change, const char* what,
                    const Visit& visit) {
  bool found = false;
  for (std::uint32_t i = 0; i < scene.materials.size(); ++i) {
    if (::fnmatch(change.glob.c_str(), scene.materials[i].name.c_str(), 0) != 0) continue;
    found = true;
    visit(i);
  }
  if (!found) {
    throw UsageError(fmt::format("{} '{}': there is no such material; there are {}", what,
                                 change.glob, material_names(scene)));
  }
}

void apply(Scene& scene, const MaterialShare& change) {
  for_each_match(scene, change, "reflectance of", [&](std::uint32_t number) {
    Material& material = scene.materials[number];
    const auto before = scene::reflectance_of(scene, material);
    if (scene::set_reflectance(scene, material, change.fraction)) return;
    const std::string what =
        fmt::format("reflectance of '{}': {:g} cannot be reached", material.name, change.fraction);
    if (!before) {
      throw UsageError(
          what + ": it is glass, which has no diffuse colour; --set glass sets what it transmits");
    }
    const double own = before->whole;
    const double nearest = nearest_reflectance(scene, material, change.fraction, own);
    if (change.fraction < own) {
      throw UsageError(
          fmt::format("{}: its gloss alone reflects {:.3g}; --set lambertian=on removes the gloss",
                      what, nearest));
    }
    throw UsageError(fmt::format("{}: its colour would exceed 1 in a channel; give {:.3g} or less",
                                 what, nearest));
  });
}

/// Metres between the two faces of a pane of a window, double or triple glazing included.
constexpr double thinnest_pane = 1e-4, thickest_pane = 0.1;
/// Cosine of the angle within which faces count as parallel.
constexpr double parallel_faces = 0.99;

/// Whether a line along the normal of a triangle from its middle meets another face of the pane.
bool has_other_face(const Scene& scene, std::uint32_t triangle,
                    std::span<const std::uint32_t> others) {
  const auto corners = scene.corners(triangle);
  const glm::dvec3 normal = face_normal(scene, oriented(triangle, 0));
  const glm::dvec3 middle =
      (glm::dvec3(corners[0]) + glm::dvec3(corners[1]) + glm::dvec3(corners[2])) / 3.0;
  return std::any_of(others.begin(), others.end(), [&](std::uint32_t other) {
    const auto at = scene.corners(other);
    const glm::dvec3 n = face_normal(scene, oriented(other, 0));
    const double height = glm::dot(glm::dvec3(at[0]) - middle, normal);
    if (std::abs(glm::dot(n, normal)) < parallel_faces || std::abs(height) < thinnest_pane ||
        std::abs(height) > thickest_pane) {
      return false;
    }
    const glm::dvec3 foot = middle + height * normal;
    double side = 0;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 from(at[i]), to(at[(i + 1) % 3]);
      const double now = glm::dot(glm::cross(to - from, foot - from), n);
      if (now * side < 0) return false;
      side = now;
    }
    return true;
  });
}

/// Whether panes of a material are bodies, or pairs of sheets: light passes two faces of it.
bool has_two_faces(const Scene& scene, std::uint32_t material) {
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < scene.triangle_count(); ++i) {
    if (scene.triangle_material[i] == material) triangles.push_back(i);
  }
  constexpr std::size_t most_asked = 256;
  const std::size_t step = (triangles.size() + most_asked - 1) / most_asked;
  double all = 0, doubled = 0;
  for (std::size_t i = 0; i < triangles.size(); i += step) {
    const double area = triangle_area(scene, triangles[i]);
    all += area;
    if (has_other_face(scene, triangles[i], triangles)) doubled += area;
  }
  return doubled > all / 2;
}

}  // namespace

void apply_reflectances(Scene& scene, std::span<const MaterialShare> changes) {
  for (const MaterialShare& change : changes) apply(scene, change);
}

void apply_glasses(Scene& scene, std::span<const MaterialShare> glasses) {
  for (const MaterialShare& change : glasses) {
    for_each_match(scene, change, "glass of", [&](std::uint32_t number) {
      Material glass;
      glass.name = scene.materials[number].name;
      glass.interaction = Interaction::glass;
      glass.thin = true;
      // Coated glass lets more through than it could if it reflected as plain glass does.
      double reflects = std::min(scene::glass_reflectance(glass), 1 - change.fraction),
             passes = change.fraction;
      if (has_two_faces(scene, number)) {
        // Light bounces between two sheets of R and T as between the faces of one pane:
        // R + T^2 R / (1 - R^2) without absorption, and T^2 / (1 - R^2).
        reflects /= 2 - reflects;
        passes = std::sqrt(passes * (1 - reflects * reflects));
      }
      glass.transmission = glm::vec3(0.0f);
      scene::set_glass_reflectance(glass, reflects);
      scene::set_transmittance(glass, passes);
      scene.materials[number] = glass;
    });
  }
}

}  // namespace photile::loading
