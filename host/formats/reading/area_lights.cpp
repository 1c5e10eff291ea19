#include "reading/area_lights.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "photile/errors.hpp"
#include "scene/coincident_faces.hpp"
#include "scene/light_emission.hpp"

namespace photile::reading {
namespace {

/// Whether other faces are the backs of all these triangles.
bool have_other_backs(const Scene& scene, const scene::CoincidentFaces& coincident,
                      const std::vector<std::uint32_t>& triangles) {
  return std::all_of(triangles.begin(), triangles.end(), [&](std::uint32_t triangle) {
    const std::uint32_t back = oriented(triangle, 1 - scene.front_side[triangle]);
    return !coincident.before(back).empty() && coincident.parts_of(scene, back).counted.empty();
  });
}

}  // namespace

std::uint32_t AreaLights::find_or_add(std::uint64_t object, const std::string& object_name,
                                      std::uint32_t material, const Emission& emission,
                                      const LightTraits& traits) {
  if (luminance(glm::max(emission.radiance, glm::dvec3(0.0))) <= 0.0) return none;
  const auto [entry, inserted] = index_.try_emplace(std::tuple(object, material, emission.texture),
                                                    static_cast<std::uint32_t>(pending_.size()));
  if (inserted) {
    if (pending_.size() >= limits::max_lights) {
      throw InputError(fmt::format("{}: more than {} lights; merge emissive objects",
                                   scene_.source.string(), limits::max_lights));
    }
    pending_.push_back({object, object_name, material, emission, traits});
    ++materials_of_object_[object];
  }
  return entry->second;
}

std::string AreaLights::name_of(const Pending& light) const {
  const std::string& material = scene_.materials[light.material].name;
  if (light.object_name.empty()) return material;
  const bool alone = materials_of_object_.at(light.object) == 1;
  return alone ? light.object_name : fmt::format("{}_{}", light.object_name, material);
}

std::vector<AreaLights::Origin> AreaLights::finish(files::Warnings& warnings) {
  std::vector<double> area(pending_.size(), 0.0);
  std::vector<std::vector<std::uint32_t>> triangles(pending_.size());
  for (std::uint32_t triangle = 0; triangle < scene_.triangles.size(); ++triangle) {
    const std::uint32_t light = scene_.triangle_light[triangle];
    if (light == none) continue;
    triangles[light].push_back(triangle);
    area[light] += triangle_area(scene_, triangle);
  }
  const bool any_two_sided =
      std::any_of(pending_.begin(), pending_.end(),
                  [](const Pending& pending) { return pending.emission.two_sided; });
  const auto coincident = any_two_sided ? scene::CoincidentFaces(scene_) : scene::CoincidentFaces();
  std::vector<std::uint32_t> final_index(pending_.size(), none);
  const std::size_t first_light = scene_.lights.size();
  std::vector<const Pending*> sources;  // of the lights
  for (std::size_t i = 0; i < pending_.size(); ++i) {
    const Pending& pending = pending_[i];
    Light light;
    light.name = name_of(pending);
    light.group = pending.traits.group;
    light.triangles = std::move(triangles[i]);
    light.two_sided =
        pending.emission.two_sided && !have_other_backs(scene_, coincident, light.triangles);
    if (!set_emission(pending, area[i], light, warnings)) {
      warnings.add("light", light.name,
                   "emits nothing (it has no area or no finite radiance); dropped");
      continue;
    }
    sources.push_back(&pending);
    final_index[i] = static_cast<std::uint32_t>(scene_.lights.size());
    scene_.lights.push_back(std::move(light));
  }
  for (std::uint32_t& light : scene_.triangle_light) {
    if (light != none) light = final_index[light];
  }
  apply_lumens(first_light, sources);
  std::vector<Origin> origins;
  for (const Pending* pending : sources) {
    origins.push_back({pending->object, pending->material, pending->traits.lamp});
  }
  return origins;
}

/// Colour, power and texture; false where nothing is emitted.
bool AreaLights::set_emission(const Pending& pending, double area, Light& light,
                              files::Warnings& warnings) const {
  const Emission& emission = pending.emission;
  double bright = 0;
  if (light.triangles.empty()) return false;
  if (emission.texture == none) {
    if (!scene::set_light_color(emission.radiance, light, bright)) return false;
    light.power = scene::area_flux(bright, area, light.two_sided);
    if (pending.traits.kelvin > 0) {
      light.color = glm::vec3(scene::color_of_temperature(pending.traits.kelvin));
    }
    return true;
  }
  if (pending.traits.kelvin > 0) {
    warnings.add("light", light.name, "photile_kelvin of a textured light is ignored");
  }
  light.emission_texture = emission.texture;
  light.texel_radiance = glm::vec3(glm::max(emission.radiance, glm::dvec3(0.0)));
  return scene::set_textured_emission(scene_, light);
}

/// An object's lumens are shared by its lights as their materials say.
void AreaLights::apply_lumens(std::size_t first_light, const std::vector<const Pending*>& sources) {
  std::map<std::uint64_t, double> power_of_object;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    power_of_object[sources[i]->object] += scene_.lights[first_light + i].power;
  }
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const double lumens = sources[i]->traits.lumens;
    if (lumens > 0) {
      scene_.lights[first_light + i].power *= lumens / power_of_object[sources[i]->object];
    }
  }
}

}  // namespace photile::reading
