#include "photile/scene_builder.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "common/ascii_text.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "scene/light_emission.hpp"
#include "scene/light_names.hpp"
#include "scene/mesh_builder.hpp"
#include "scene/scene_queries.hpp"
#include "scene/surface_models.hpp"
#include "trace/light_offset.hpp"
#include "trace/place_camera.hpp"

namespace photile {

std::string_view name_of(LightKind kind) {
  return name_in({"area", "point", "spot", "directional", "environment"}, kind);
}

using scene::Corner;
using scene::MeshBuilder;

struct SceneBuilder::Impl {
  /// What a light from beyond the scene gives to a surface: its flux follows from the scene's size.
  struct DistantLight {
    std::uint32_t light;
    double irradiance;
  };

  Scene scene;
  MeshBuilder mesh{scene, {}};
  std::vector<DistantLight> distant_lights;

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", scene.source.string(), what));
  }
  std::string light_name(std::uint32_t light) const {
    return fmt::format("light {} '{}'", light, scene.lights[light].name);
  }

  void check_length(std::string_view name, std::size_t length, std::size_t expected) const {
    if (length == 0 || length == expected) return;
    refuse(fmt::format("a mesh has {} {}; it must have none or {}", length, name, expected));
  }
  void check_numbers(std::string_view name, auto values) const {
    for (std::size_t i = 0; i < values.size(); ++i) {
      for (int c = 0; c < values[i].length(); ++c) {
        if (!std::isfinite(values[i][c])) {
          refuse(fmt::format("{} {} of a mesh is NaN or infinite", name, i));
        }
      }
    }
  }
  void check_surface(std::uint32_t material, std::uint32_t light) const;
  void check(const MeshArrays& arrays) const;
  std::uint32_t add_triangle(const std::array<Corner, 3>& corners, std::uint32_t material,
                             std::uint32_t light);
  void finish(Scene& built) const;
};

namespace {

/// The direction as a unit vector; zero where there is no direction.
glm::vec3 unit_or_zero(const glm::vec3& direction) {
  const double length = glm::length(glm::dvec3(direction));
  if (!(length > 0) || !std::isfinite(length)) return glm::vec3(0.0f);
  return glm::vec3(glm::dvec3(direction) / length);
}

}  // namespace

void SceneBuilder::Impl::check_surface(std::uint32_t material, std::uint32_t light) const {
  if (material >= scene.materials.size()) {
    refuse(fmt::format("a triangle has material {}, and there are {}; add the material first",
                       material, scene.materials.size()));
  }
  if (light == none) return;
  if (light >= scene.lights.size()) {
    refuse(fmt::format("a triangle has light {}, and there are {}; add the light first", light,
                       scene.lights.size()));
  }
  if (scene.lights[light].kind != LightKind::area) {
    refuse(fmt::format("a triangle has {}, which is not an area light", light_name(light)));
  }
}

void SceneBuilder::Impl::check(const MeshArrays& arrays) const {
  const std::size_t vertices = arrays.vertices.size(), triangles = arrays.triangles.size();
  check_length("normals", arrays.normals.size(), vertices);
  check_length("uv", arrays.uv.size(), vertices);
  check_length("emission_uv", arrays.emission_uv.size(), vertices);
  check_length("tangents", arrays.tangents.size(), vertices);
  check_length("materials", arrays.materials.size(), triangles);
  check_length("lights", arrays.lights.size(), triangles);
  for (std::size_t i = 0; i < vertices; ++i) {
    const glm::vec3& p = arrays.vertices[i];
    if (!scene::within_limit(glm::dvec3(p))) {
      refuse(
          fmt::format("vertex {} of a mesh lies at ({}, {}, {}); coordinates must be numbers up "
                      "to {:g} m",
                      i, p.x, p.y, p.z, limits::max_coordinate));
    }
  }
  check_numbers("the normal of vertex", arrays.normals);
  check_numbers("uv", arrays.uv);
  check_numbers("emission_uv", arrays.emission_uv);
  check_numbers("the tangent of vertex", arrays.tangents);
  for (std::size_t t = 0; t < triangles; ++t) {
    const glm::uvec3& corners = arrays.triangles[t];
    if (std::max({corners.x, corners.y, corners.z}) >= vertices) {
      refuse(fmt::format("triangle {} of a mesh has the corners {}, {}, {} of {} vertices", t,
                         corners.x, corners.y, corners.z, vertices));
    }
    const std::uint32_t material = arrays.materials.empty() ? arrays.material : arrays.materials[t];
    const std::uint32_t light = arrays.lights.empty() ? arrays.light : arrays.lights[t];
    check_surface(material, light);
    if (scene.materials[material].textured() && arrays.uv.empty()) {
      refuse(fmt::format("a mesh without uv has the material '{}', which has a texture",
                         scene.materials[material].name));
    }
    if (light != none && scene.lights[light].emission_texture != none &&
        arrays.emission_uv.empty()) {
      refuse(
          fmt::format("a mesh without emission_uv has {}, which has a texture", light_name(light)));
    }
  }
}

std::uint32_t SceneBuilder::Impl::add_triangle(const std::array<Corner, 3>& corners,
                                               std::uint32_t material, std::uint32_t light) {
  const auto number = static_cast<std::uint32_t>(scene.triangle_count());
  if (!mesh.add(corners, material, light)) return none;
  if (light != none) scene.lights[light].triangles.push_back(number);
  return number;
}

/// Turns a copy of `scene`, or `scene` itself, into what stages take.
void SceneBuilder::Impl::finish(Scene& built) const {
  if (built.triangles.empty()) refuse("no triangle has an area; add a mesh");
  const SceneNeeds needs = scene::needs_of_materials(built.materials);
  if (!needs.textures) built.corner_uv.clear();
  scene::drop_flat_normals(built, needs);
  if (!needs.normal_maps) built.corner_tangent.clear();
  const double radius = bounding_sphere(built).radius;
  for (const auto& [light, irradiance] : distant_lights) {
    Light& distant = built.lights[light];
    distant.power =
        scene::distant_flux(irradiance, static_cast<double>(distant.angular_diameter), radius);
  }
  for (std::uint32_t i = 0; i < built.lights.size(); ++i) {
    Light& light = built.lights[i];
    if (light.kind == LightKind::area && light.triangles.empty()) {
      refuse(light_name(i) + " is an area light without triangles; add a mesh that has it");
    }
    if (light.emission_texture == none) continue;
    const double power = light.power;
    if (!scene::set_textured_emission(built, light)) {
      refuse(light_name(i) + " has a texture that is black where its triangles lie");
    }
    light.power = power;
  }
  scene::make_light_names_unique(built.lights);
  check_scene(built);
  trace::offset_lights(built);
  if (built.cameras.empty()) built.cameras.push_back(trace::place_camera(built));
}

SceneBuilder::SceneBuilder(std::string name, PowerUnit unit) : impl_(std::make_unique<Impl>()) {
  impl_->scene.source = std::move(name);
  impl_->scene.unit = unit;
}
SceneBuilder::~SceneBuilder() = default;
SceneBuilder::SceneBuilder(SceneBuilder&&) noexcept = default;
SceneBuilder& SceneBuilder::operator=(SceneBuilder&&) noexcept = default;

std::uint32_t SceneBuilder::add(Material material) {
  impl_->scene.materials.push_back(std::move(material));
  return static_cast<std::uint32_t>(impl_->scene.materials.size() - 1);
}

std::uint32_t SceneBuilder::add(const MetallicRoughness& model) {
  impl_->scene.metallic_roughness.push_back(model);
  return static_cast<std::uint32_t>(impl_->scene.metallic_roughness.size() - 1);
}

std::uint32_t SceneBuilder::add(Texture texture) {
  impl_->scene.textures.push_back(std::move(texture));
  return static_cast<std::uint32_t>(impl_->scene.textures.size() - 1);
}

std::uint32_t SceneBuilder::add(IntensityDistribution distribution) {
  impl_->scene.distributions.push_back(std::move(distribution));
  return static_cast<std::uint32_t>(impl_->scene.distributions.size() - 1);
}

std::uint32_t SceneBuilder::add(Light light) {
  Scene& scene = impl_->scene;
  const auto refuse = [&](const std::string& what) {
    impl_->refuse(fmt::format("light '{}' {}", light.name, what));
  };
  if (scene.lights.size() >= limits::max_lights) {
    impl_->refuse(fmt::format("more than {} lights", limits::max_lights));
  }
  if (!(light.power > 0) || !std::isfinite(light.power)) {
    refuse(fmt::format("has the power {}; it must be above 0", light.power));
  }
  const glm::vec3 tint = light.color;
  double bright = 0;
  if (std::min({tint.x, tint.y, tint.z}) < 0 ||
      !scene::set_light_color(glm::dvec3(tint), light, bright)) {
    refuse("has no colour; it must be positive in a channel and negative in none");
  }
  if (light.emission_texture != none) {
    if (light.kind != LightKind::area || light.emission_texture >= scene.textures.size()) {
      refuse(fmt::format("has emission texture {} of {}; area lights may have one",
                         light.emission_texture, scene.textures.size()));
    }
    light.texel_radiance = light.color;
  }
  light.direction = unit_or_zero(light.direction);
  if (light.kind != LightKind::area && light.direction == glm::vec3(0.0f)) {
    refuse("has no direction");
  }
  if (light.distribution != none) {
    if (light.kind != LightKind::point || light.distribution >= scene.distributions.size()) {
      refuse(fmt::format("has distribution {} of {}; point lights may have one", light.distribution,
                         scene.distributions.size()));
    }
    light.x_axis -= glm::dot(light.x_axis, light.direction) * light.direction;
    light.x_axis = unit_or_zero(light.x_axis);
    if (light.x_axis == glm::vec3(0.0f)) refuse("has an x axis along its direction");
  }
  constexpr float half_pi = 1.5707964f;
  if (light.kind == LightKind::spot &&
      !(light.inner_cone_angle >= 0 && light.inner_cone_angle <= light.outer_cone_angle &&
        light.outer_cone_angle > 0 && light.outer_cone_angle <= half_pi)) {
    refuse(fmt::format("has the cone angles {} and {}; 0 <= inner <= outer <= pi/2",
                       light.inner_cone_angle, light.outer_cone_angle));
  }
  light.triangles.clear();
  scene.lights.push_back(std::move(light));
  return static_cast<std::uint32_t>(scene.lights.size() - 1);
}

std::uint32_t SceneBuilder::add_distant(Light light, double irradiance) {
  light.kind = LightKind::directional;
  light.power = irradiance;
  constexpr double degrees = 57.29577951308232;
  constexpr double rounding = 1e-5;  // of 90 degrees in a float of radians
  if (!(light.angular_diameter >= 0) ||
      light.angular_diameter * degrees > limits::max_sun_diameter_degrees + rounding) {
    impl_->refuse(fmt::format("light '{}' has a disc of {} degrees; at most {} are possible",
                              light.name, light.angular_diameter * degrees,
                              limits::max_sun_diameter_degrees));
  }
  const std::uint32_t number = add(std::move(light));
  impl_->distant_lights.push_back({number, irradiance});
  return number;
}

std::uint32_t SceneBuilder::add_surroundings(std::string name, EnvironmentMap map) {
  Light light;
  light.name = std::move(name);
  light.kind = LightKind::environment;
  light.color = glm::vec3(map.integral());
  light.power = luminance(map.integral());
  light.environment = static_cast<std::uint32_t>(impl_->scene.environments.size());
  const double irradiance = light.power;
  const std::uint32_t number = add(std::move(light));
  impl_->scene.environments.push_back(std::move(map));
  impl_->distant_lights.push_back({number, irradiance});
  return number;
}

void SceneBuilder::add(Camera camera) {
  const double sum = glm::length(camera.position) + glm::length(camera.forward) +
                     glm::length(camera.up) + glm::length(camera.right) +
                     camera.vertical_field_of_view;
  if (!std::isfinite(sum)) {
    impl_->refuse(
        fmt::format("camera '{}' has a position or an axis that is not a number", camera.name));
  }
  impl_->scene.cameras.push_back(std::move(camera));
}

std::vector<std::uint32_t> SceneBuilder::add(const MeshArrays& arrays) {
  impl_->check(arrays);
  impl_->mesh.also_need({.uv = !arrays.uv.empty(),
                         .emission_uv = !arrays.emission_uv.empty(),
                         .normals = !arrays.normals.empty(),
                         .tangents = !arrays.tangents.empty()});
  const auto corner_at = [&](std::uint32_t vertex) {
    Corner corner;
    corner.position = glm::dvec3(arrays.vertices[vertex]);
    if (!arrays.uv.empty()) corner.uv = glm::dvec2(arrays.uv[vertex]);
    if (!arrays.normals.empty()) corner.normal = glm::dvec3(arrays.normals[vertex]);
    if (!arrays.emission_uv.empty()) corner.emission_uv = glm::dvec2(arrays.emission_uv[vertex]);
    if (!arrays.tangents.empty()) {
      corner.tangent = glm::dvec3(arrays.tangents[vertex]);
      corner.handedness = static_cast<double>(arrays.tangents[vertex].w);
    }
    return corner;
  };
  std::vector<std::uint32_t> numbers;
  numbers.reserve(arrays.triangles.size());
  for (std::size_t t = 0; t < arrays.triangles.size(); ++t) {
    const glm::uvec3& corners = arrays.triangles[t];
    numbers.push_back(
        impl_->add_triangle({corner_at(corners.x), corner_at(corners.y), corner_at(corners.z)},
                            arrays.materials.empty() ? arrays.material : arrays.materials[t],
                            arrays.lights.empty() ? arrays.light : arrays.lights[t]));
  }
  return numbers;
}

std::uint32_t SceneBuilder::triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                                     std::uint32_t material, std::uint32_t light) {
  const std::array vertices{a, b, c};
  const glm::uvec3 corners(0, 1, 2);
  return add(MeshArrays{.vertices = vertices,
                        .triangles = {&corners, 1},
                        .material = material,
                        .light = light})
      .front();
}

void SceneBuilder::quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                        const glm::vec3& d, std::uint32_t material, std::uint32_t light) {
  triangle(a, b, c, material, light);
  triangle(a, c, d, material, light);
}

void SceneBuilder::grid(const glm::vec3& origin, const glm::vec3& u, const glm::vec3& v, int cells,
                        std::uint32_t material, std::uint32_t light) {
  const auto at = [&](int i, int j) {
    const auto n = static_cast<float>(cells);
    return origin + (static_cast<float>(i) / n) * u + (static_cast<float>(j) / n) * v;
  };
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), material, light);
    }
  }
}

void SceneBuilder::box(const glm::vec3& low, const glm::vec3& high, std::uint32_t material,
                       bool inwards, int cells, std::uint32_t light) {
  const glm::vec3 size = high - low;
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 u(0.0f), v(0.0f), across(0.0f);
    u[(axis + 1) % 3] = size[(axis + 1) % 3];
    v[(axis + 2) % 3] = size[(axis + 2) % 3];
    across[axis] = size[axis];
    // u x v points along +axis: into the box on the low face.
    grid(low, inwards ? u : v, inwards ? v : u, cells, material, light);
    grid(low + across, inwards ? v : u, inwards ? u : v, cells, material, light);
  }
}

Scene SceneBuilder::build() const& {
  Scene built = impl_->scene;
  impl_->finish(built);
  return built;
}

Scene SceneBuilder::build() && {
  impl_->finish(impl_->scene);
  return std::move(impl_->scene);
}

}  // namespace photile
