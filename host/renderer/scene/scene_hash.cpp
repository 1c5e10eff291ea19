#include "scene/scene_queries.hpp"

namespace photile::scene {
namespace {

/// Each function names all members, so that it does not compile once there is another.
void add_material(const Material& material, ContentHash& hash) {
  const auto& [name, interaction, diffuse, diffuse_texture, specular, f90, roughness, transmission,
               index_of_refraction, thin, metallic_roughness, opacity, opacity_texture,
               opacity_cutoff, normal_texture, normal_scale] = material;
  hash.add(interaction);
  hash.add(diffuse);
  hash.add(diffuse_texture);
  hash.add(specular);
  hash.add(f90);
  hash.add(roughness);
  hash.add(transmission);
  hash.add(index_of_refraction);
  hash.add(thin);
  hash.add(metallic_roughness);
  hash.add(opacity);
  hash.add(opacity_texture);
  hash.add(opacity_cutoff);
  hash.add(normal_texture);
  hash.add(normal_scale);
}

void add_metallic_roughness(const MetallicRoughness& model, ContentHash& hash) {
  const auto& [base_color, metallic, roughness, index_of_refraction, specular_factor,
               specular_color, texture, specular_texture, specular_color_texture] = model;
  hash.add(base_color);
  hash.add(metallic);
  hash.add(roughness);
  hash.add(index_of_refraction);
  hash.add(specular_factor);
  hash.add(specular_color);
  hash.add(texture);
  hash.add(specular_texture);
  hash.add(specular_color_texture);
}

void add_light(const Light& light, ContentHash& hash) {
  const auto& [name, group, kind, color, power, triangles, two_sided, emission_texture,
               texel_radiance, position, direction, inner_cone_angle, outer_cone_angle,
               distribution, x_axis, angular_diameter, sky_patch, environment] = light;
  hash.add(name);
  hash.add(group);
  hash.add(kind);
  hash.add(color);
  hash.add(power);  // quotas and fractions of groups follow it
  hash.add(triangles);
  hash.add(two_sided);
  hash.add(emission_texture);
  hash.add(texel_radiance);
  hash.add(position);
  hash.add(direction);
  hash.add(inner_cone_angle);
  hash.add(outer_cone_angle);
  hash.add(distribution);
  hash.add(x_axis);
  hash.add(angular_diameter);
  hash.add(sky_patch);
  hash.add(environment);
}

void add_distribution(const IntensityDistribution& distribution, ContentHash& hash) {
  hash.add(std::uint64_t{distribution.columns()});
  hash.add(std::uint64_t{distribution.rows()});
  for (std::size_t column = 0; column < distribution.columns(); ++column) {
    for (std::size_t row = 0; row < distribution.rows(); ++row) {
      for (const double u : {0.0, 1.0}) {
        for (const double v : {0.0, 1.0}) {
          const auto corner = distribution.in_cell(column, row, u, v);
          hash.add(corner.direction);
          hash.add(corner.intensity);
        }
      }
    }
  }
}

void add_environment(const EnvironmentMap& map, ContentHash& hash) {
  hash.add(map.width());
  hash.add(map.height());
  hash.add(map.direction_at(0.0, 0, 0.5));  // its rotation
  for (int row = 0; row < map.height(); ++row) {
    for (int column = 0; column < map.width(); ++column) hash.add(map.texel(column, row));
  }
}

}  // namespace

void add_surfaces(const Scene& scene, ContentHash& hash) {
  hash.add(scene.vertices);
  hash.add(scene.triangles);
  hash.add(scene.front_side);
  hash.add(scene.triangle_material);
  hash.add(scene.triangle_light);
  hash.add(scene.corner_uv);
  hash.add(scene.corner_emission_uv);
  hash.add(scene.corner_normal);
  hash.add(scene.corner_tangent);
  hash.add(std::uint64_t{scene.materials.size()});
  for (const Material& material : scene.materials) add_material(material, hash);
  hash.add(std::uint64_t{scene.metallic_roughness.size()});
  for (const MetallicRoughness& model : scene.metallic_roughness) {
    add_metallic_roughness(model, hash);
  }
}

void add_scene(const Scene& scene, ContentHash& hash) {
  const auto& [source, unit, origin, turn, vertices, triangles, front_side, triangle_material,
               triangle_light, corner_uv, corner_emission_uv, corner_normal, corner_tangent,
               shared_meshes, instances, materials, metallic_roughness, textures, lights,
               distributions, environments, portals, cameras, report] = scene;
  hash.add(unit);
  hash.add(origin);
  for (int axis = 0; axis < 3; ++axis) hash.add(turn[axis]);
  add_surfaces(scene, hash);
  hash.add(std::uint64_t{textures.size()});
  for (const Texture& texture : textures) {
    hash.add(texture.width());
    hash.add(texture.height());
    const glm::vec2 size(texture.width(), texture.height());
    for (int y = 0; y < texture.height(); ++y) {
      for (int x = 0; x < texture.width(); ++x) {
        // In its middle: the texel itself.
        hash.add(texture.sample_data((glm::vec2(x, y) + 0.5f) / size));
      }
    }
  }
  hash.add(std::uint64_t{lights.size()});
  for (const Light& light : lights) add_light(light, hash);
  hash.add(std::uint64_t{distributions.size()});
  for (const IntensityDistribution& distribution : distributions) {
    add_distribution(distribution, hash);
  }
  hash.add(std::uint64_t{environments.size()});
  for (const EnvironmentMap& map : environments) add_environment(map, hash);
  for (const auto& [corner, u, v] : portals) {
    hash.add(corner);
    hash.add(u);
    hash.add(v);
  }
}

}  // namespace photile::scene
