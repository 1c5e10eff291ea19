#include "publish/room_mesh.hpp"

#include <tsl/robin_map.h>

#include <map>
#include <tuple>

#include "common/content_hash.hpp"
#include "scene/panes.hpp"
#include "trace/surface.hpp"

namespace photile::publish {
namespace {

static_assert(sizeof(RoomVertex) == 12 * sizeof(float), "hashed by its bytes");

/// The light that shines from a side, or none.
std::uint32_t light_of(const Scene& scene, std::uint32_t side) {
  const std::uint32_t triangle = triangle_of(side), light = scene.triangle_light[triangle];
  const bool shines = light != none && (side_of(side) == scene.front_side[triangle] ||
                                        scene.lights[light].two_sided);
  return shines ? light : none;
}

RoomTextures textures_of(const Scene& scene, const Material& material, std::uint32_t light) {
  RoomTextures textures;
  if (!scene.corner_uv.empty()) {
    textures.colour = material.diffuse_texture;
    textures.opacity = material.opacity_texture;
  }
  const bool picture = light != none && scene.lights[light].emission_texture != none;
  // One set of coordinates: a luminous picture has no other.
  if (picture) textures = {none, none, scene.lights[light].emission_texture};
  return textures;
}

}  // namespace

RoomMesh mesh_of(const Scene& scene, const bake::LightAtlas& atlas) {
  std::map<std::tuple<bool, Interaction, RoomTextures>, std::vector<std::uint32_t>> sides;
  for (const std::uint32_t side : atlas.sides()) {
    const Material& material = scene.materials[scene.triangle_material[triangle_of(side)]];
    const bool clear = scene::is_glazing(material);
    sides[{clear, material.interaction, textures_of(scene, material, light_of(scene, side))}]
        .push_back(side);
  }
  RoomMesh mesh;
  tsl::robin_map<RoomVertex, std::uint32_t, BytesHash> number_of;
  for (const auto& [key, members] : sides) {
    const auto& [clear, interaction, textures] = key;
    RoomPart part{interaction, clear, textures, static_cast<std::uint32_t>(mesh.indices.size()), 0};
    const bool coordinates = textures != RoomTextures{};
    for (const std::uint32_t side : members) {
      const std::uint32_t triangle = triangle_of(side);
      const auto positions = scene.corners(triangle);
      const auto light_uv = atlas.corners(side);
      for (const bake::DrawnTriangle& drawn : atlas.drawn(side)) {
        for (const glm::vec3& weights : drawn) {
          RoomVertex vertex;
          vertex.position = bake::at_weights(positions, weights);
          vertex.normal = trace::shading_normal(scene, side, vertex.position);
          if (coordinates) {
            vertex.uv = bake::at_weights(
                (textures.emission != none ? scene.corner_emission_uv : scene.corner_uv)[triangle],
                weights);
          }
          vertex.light_uv = bake::at_weights(light_uv, weights);
          vertex.material = scene.triangle_material[triangle];
          vertex.light = light_of(scene, side);
          const auto [entry, is_new] =
              number_of.insert({vertex, static_cast<std::uint32_t>(mesh.vertices.size())});
          if (is_new) mesh.vertices.push_back(vertex);
          mesh.indices.push_back(entry->second);
        }
      }
    }
    part.count = static_cast<std::uint32_t>(mesh.indices.size()) - part.first;
    mesh.parts.push_back(part);
  }
  return mesh;
}

}  // namespace photile::publish
