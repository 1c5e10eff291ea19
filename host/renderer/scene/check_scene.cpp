// Checks of a scene.
#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/scene_builder.hpp"
#include "scene/scene_queries.hpp"

namespace photile {
namespace {

/// `what` has gone wrong with a scene.
[[noreturn]] void refuse(const Scene& scene, const std::string& what) {
  const std::string name = scene.source.string();
  throw InputError(fmt::format("{}: {}", name.empty() ? "scene in memory" : name, what));
}

/// The first of `count` things that is wrong, or `count`.
template <class IsWrong>
std::size_t first_wrong(std::size_t count, const IsWrong& is_wrong) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count, 1 << 14), count,
      [&](const tbb::blocked_range<std::size_t>& range, std::size_t first) {
        for (std::size_t i = range.begin(); i < range.end() && i < first; ++i) {
          if (is_wrong(i)) return i;
        }
        return first;
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
}

class SceneCheck {
 public:
  explicit SceneCheck(const Scene& scene) : scene_(scene) {}

  void run() const {
    check_lengths();
    check_vertices();
    check_triangles();
    check_corners();
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) check_material(i);
    for (const MetallicRoughness& model : scene_.metallic_roughness) check_model(model);
    for (std::size_t i = 0; i < scene_.textures.size(); ++i) check_texture(i);
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) check_light(i);
    check_instances();
  }

 private:
  template <class Array>
  void check_length(std::string_view name, const Array& array, bool may_be_empty) const {
    if (array.size() == scene_.triangle_count() || (may_be_empty && array.empty())) return;
    refuse(scene_, fmt::format("{} has {} elements for {} triangles; fill it, or use SceneBuilder",
                               name, array.size(), scene_.triangle_count()));
  }

  void check_lengths() const {
    if (scene_.triangle_count() > limits::max_triangles) {
      refuse(scene_, fmt::format("{} triangles; at most {} can be numbered",
                                 scene_.triangle_count(), limits::max_triangles));
    }
    if (scene_.lights.size() > limits::max_lights) {
      refuse(scene_, fmt::format("{} lights; at most {} are possible", scene_.lights.size(),
                                 limits::max_lights));
    }
    check_length("front_side", scene_.front_side, false);
    check_length("triangle_material", scene_.triangle_material, false);
    check_length("triangle_light", scene_.triangle_light, false);
    check_length("corner_uv", scene_.corner_uv, true);
    check_length("corner_emission_uv", scene_.corner_emission_uv, true);
    check_length("corner_normal", scene_.corner_normal, true);
    check_length("corner_tangent", scene_.corner_tangent, true);
  }

  void check_vertices() const {
    const auto& vertices = scene_.vertices;
    const std::size_t vertex = first_wrong(vertices.size(), [&](std::size_t i) {
      return !scene::within_limit(glm::dvec3(vertices[i]));
    });
    if (vertex == vertices.size()) return;
    const glm::vec3& p = vertices[vertex];
    refuse(scene_, fmt::format("vertex {} lies at ({}, {}, {}); coordinates must be numbers up to "
                               "{:g} m",
                               vertex, p.x, p.y, p.z, limits::max_coordinate));
  }

  bool is_area_light(std::uint32_t light) const {
    return light < scene_.lights.size() && scene_.lights[light].kind == LightKind::area;
  }

  void check_triangles() const {
    const std::size_t count = scene_.triangle_count();
    const auto out_of_range = [&](std::size_t t) {
      const glm::uvec3& corners = scene_.triangles[t];
      return std::max({corners.x, corners.y, corners.z}) >= scene_.vertices.size();
    };
    const std::size_t t = first_wrong(count, [&](std::size_t i) {
      const std::uint32_t light = scene_.triangle_light[i];
      return out_of_range(i) || scene_.triangle_material[i] >= scene_.materials.size() ||
             scene_.front_side[i] > 1 || (light != none && !is_area_light(light));
    });
    if (t == count) return;
    const glm::uvec3& corners = scene_.triangles[t];
    if (out_of_range(t)) {
      refuse(scene_, fmt::format("triangle {} has the corners {}, {}, {} of {} vertices", t,
                                 corners.x, corners.y, corners.z, scene_.vertices.size()));
    }
    if (scene_.triangle_material[t] >= scene_.materials.size()) {
      refuse(scene_, fmt::format("triangle {} has material {} of {}", t,
                                 scene_.triangle_material[t], scene_.materials.size()));
    }
    if (scene_.front_side[t] > 1) {
      refuse(scene_, fmt::format("triangle {} has front side {}; there are 0 and 1", t,
                                 scene_.front_side[t]));
    }
    refuse(scene_, fmt::format("triangle {} has light {}, which is not an area light of {} lights",
                               t, scene_.triangle_light[t], scene_.lights.size()));
  }

  template <class Corners>
  void check_finite(std::string_view name, const std::vector<Corners>& corners) const {
    const std::size_t triangle = first_wrong(corners.size(), [&](std::size_t t) {
      float sum = 0;
      for (const auto& corner : corners[t]) sum += glm::dot(corner * 0.0f, corner * 0.0f);
      return !(sum == 0);  // 0 times NaN or infinity is NaN
    });
    if (triangle == corners.size()) return;
    refuse(scene_, fmt::format("{} of triangle {} is NaN or infinite", name, triangle));
  }

  void check_corners() const {
    check_finite("corner_normal", scene_.corner_normal);
    check_finite("corner_tangent", scene_.corner_tangent);
  }

  void check_index(std::uint32_t index, std::size_t size, std::string_view what,
                   const std::string& owner) const {
    if (index == none || index < size) return;
    refuse(scene_, fmt::format("{} has {} {} of {}", owner, what, index, size));
  }

  void check_material(std::size_t index) const {
    const Material& material = scene_.materials[index];
    const std::string owner = fmt::format("material {} '{}'", index, material.name);
    for (const std::uint32_t texture :
         {material.diffuse_texture, material.opacity_texture, material.normal_texture}) {
      check_index(texture, scene_.textures.size(), "texture", owner);
    }
    check_index(material.metallic_roughness, scene_.metallic_roughness.size(), "metallic_roughness",
                owner);
    const bool is_glass = material.interaction == Interaction::glass;
    for (const auto& [color, most] :
         {std::pair(material.diffuse, 1.0f), std::pair(material.specular, 1.0f),
          std::pair(material.transmission, std::numeric_limits<float>::max())}) {
      const auto lies_within = [most = most](float part) { return part >= 0 && part <= most; };
      if (lies_within(color.x) && lies_within(color.y) && lies_within(color.z)) {
        continue;
      }
      refuse(scene_, fmt::format("{} has the colour ({}, {}, {}); reflectances lie in [0, 1]",
                                 owner, color.x, color.y, color.z));
    }
    if (!std::isfinite(material.roughness + material.f90 + material.opacity +
                       material.opacity_cutoff + material.normal_scale) ||
        (is_glass &&
         !(material.index_of_refraction > 0 && std::isfinite(material.index_of_refraction)))) {
      refuse(scene_, owner + " has a factor that is not a number, or glass without a refraction");
    }
    if (material.roughness < 0 || material.roughness > 1) {
      refuse(scene_,
             fmt::format("{} has the roughness {}; it lies in [0, 1]", owner, material.roughness));
    }
    if (!material.textured() || !scene_.corner_uv.empty()) return;
    const auto user = std::find(scene_.triangle_material.begin(), scene_.triangle_material.end(),
                                static_cast<std::uint32_t>(index));
    if (user != scene_.triangle_material.end()) {
      refuse(scene_, owner + " has a texture, but corner_uv is empty");
    }
  }

  void check_model(const MetallicRoughness& model) const {
    for (const std::uint32_t texture :
         {model.texture, model.specular_texture, model.specular_color_texture}) {
      check_index(texture, scene_.textures.size(), "texture", "a metallic-roughness model");
    }
  }

  void check_texture(std::size_t index) const {
    const Texture& texture = scene_.textures[index];
    if (texture.width() > 0 && texture.height() > 0) return;
    refuse(scene_, fmt::format("texture {} '{}' has no texels", index, texture.name()));
  }

  void check_light(std::size_t index) const {
    const Light& light = scene_.lights[index];
    const std::string owner = fmt::format("light {} '{}'", index, light.name);
    if (!(light.power >= 0 && light.power <= limits::max_light_power)) {
      refuse(scene_, fmt::format("{} has the power {}; it must be a number from 0 to {}", owner,
                                 light.power, limits::max_light_power));
    }
    const float numbers = light.color.x + light.color.y + light.color.z + light.inner_cone_angle +
                          light.outer_cone_angle + light.angular_diameter + light.texel_radiance.x +
                          light.texel_radiance.y + light.texel_radiance.z + light.sky_patch.x +
                          light.sky_patch.y + light.sky_patch.z + light.sky_patch.w;
    const glm::dvec3 direction(light.direction);
    if (!std::isfinite(numbers) || !std::isfinite(glm::length(direction)) ||
        !std::isfinite(glm::length(glm::dvec3(light.x_axis))) ||
        !scene::within_limit(glm::dvec3(light.position))) {
      refuse(scene_, owner + " has a colour, position, direction or angle that is not a number");
    }
    check_index(light.emission_texture, scene_.textures.size(), "emission texture", owner);
    check_index(light.distribution, scene_.distributions.size(), "distribution", owner);
    check_index(light.environment, scene_.environments.size(), "environment", owner);
    if (light.kind == LightKind::environment && light.environment == none) {
      refuse(scene_, owner + " has no environment; set its index");
    }
    if (light.kind == LightKind::environment) {
      constexpr double least = 1e-6 * limits::min_illuminance;  // of lux that became watts
      const double sum = luminance(scene_.environments[light.environment].integral());
      if (!(sum >= least)) {
        refuse(scene_, fmt::format("{} is too dark: its radiance adds up to {:g} over all "
                                   "directions; the minimum is {:g}",
                                   owner, sum, least));
      }
    }
    if (light.emission_texture != none && scene_.corner_emission_uv.empty() &&
        !light.triangles.empty()) {
      refuse(scene_, owner + " has an emission texture, but corner_emission_uv is empty");
    }
    for (const std::uint32_t triangle : light.triangles) {
      if (triangle < scene_.triangle_count() && scene_.triangle_light[triangle] == index) continue;
      refuse(scene_, fmt::format("{} lists triangle {}, which is not its own by triangle_light",
                                 owner, triangle));
    }
  }

  void check_instances() const {
    std::uint64_t end = 0;
    for (const MeshInstance& instance : scene_.instances) {
      const bool known = instance.mesh < scene_.shared_meshes.size();
      const std::uint64_t size = known ? scene_.shared_meshes[instance.mesh].triangles.size() : 0;
      if (!known || instance.first_triangle < end ||
          instance.first_triangle + size > scene_.triangle_count()) {
        refuse(scene_, fmt::format("the instance of mesh {} at triangle {} is out of range or "
                                   "overlaps another",
                                   instance.mesh, instance.first_triangle));
      }
      end = instance.first_triangle + size;
    }
    for (const SharedMesh& mesh : scene_.shared_meshes) {
      for (const glm::uvec3& corners : mesh.triangles) {
        if (std::max({corners.x, corners.y, corners.z}) < mesh.vertices.size()) continue;
        refuse(scene_, "a shared mesh has a corner beyond its vertices");
      }
    }
  }

  const Scene& scene_;
};

}  // namespace

void check_scene(const Scene& scene) { SceneCheck(scene).run(); }

}  // namespace photile
