#include "scene/area_lights.hpp"

#include <fmt/format.h>

#include <cmath>

#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "scene/photometry.hpp"

namespace photile::scene_io {

bool set_light_color(const glm::dvec3& rgb, Light& light, double& luminance_of_rgb) {
  const glm::dvec3 positive = glm::max(rgb, glm::dvec3(0.0));
  luminance_of_rgb = luminance(positive);
  if (!std::isfinite(luminance_of_rgb) || luminance_of_rgb <= 0.0) return false;
  light.color = glm::vec3(positive / luminance_of_rgb);
  return true;
}

std::uint32_t AreaLights::find_or_add(std::uint64_t object, const std::string& object_name,
                                      std::uint32_t material, const Emission& emission,
                                      const std::string& group) {
  if (luminance(glm::max(emission.radiance, glm::dvec3(0.0))) <= 0.0) return none;
  const auto [entry, inserted] =
      index_.try_emplace(std::pair(object, material), static_cast<std::uint32_t>(pending_.size()));
  if (inserted) {
    if (pending_.size() >= limits::max_lights) {
      throw InputError(fmt::format("{}: more than {} lights; join emissive objects",
                                   scene_.source.string(), limits::max_lights));
    }
    pending_.push_back({object, object_name, material, emission, group});
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

void AreaLights::finish(Warnings& warnings) {
  std::vector<double> area(pending_.size(), 0.0);
  std::vector<std::vector<std::uint32_t>> triangles(pending_.size());
  for (std::uint32_t triangle = 0; triangle < scene_.triangles.size(); ++triangle) {
    const std::uint32_t light = scene_.triangle_light[triangle];
    if (light == none) continue;
    triangles[light].push_back(triangle);
    area[light] += triangle_area(scene_, triangle);
  }
  std::vector<std::uint32_t> final_index(pending_.size(), none);
  for (std::size_t i = 0; i < pending_.size(); ++i) {
    const Pending& pending = pending_[i];
    Light light;
    light.name = name_of(pending);
    light.group = pending.group;
    double radiance = 0;
    if (triangles[i].empty() || !set_light_color(pending.emission.radiance, light, radiance)) {
      warnings.add("light", light.name, "emits nothing (no area or no finite radiance); dropped");
      continue;
    }
    light.kind = LightKind::area;
    light.two_sided = pending.emission.two_sided;
    light.power = area_flux(radiance, area[i], light.two_sided);
    light.triangles = std::move(triangles[i]);
    final_index[i] = static_cast<std::uint32_t>(scene_.lights.size());
    scene_.lights.push_back(std::move(light));
  }
  for (std::uint32_t& light : scene_.triangle_light) {
    if (light != none) light = final_index[light];
  }
}

}  // namespace photile::scene_io
