// The surfaces of a room as a graphics processor draws them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/light_atlas.hpp"
#include "photile/scene.hpp"

namespace photile::publish {

/// A corner of triangles that share it.
struct RoomVertex {
  glm::vec3 position{0.0f};  ///< metres
  glm::vec3 normal{0.0f};    ///< unit, for reflections
  glm::vec2 uv{0.0f};        ///< of the texture
  glm::vec2 light_uv{0.0f};  ///< of the light maps
  std::uint32_t material = 0;
  std::uint32_t light = none;  ///< that shines from here, into Scene::lights

  friend bool operator==(const RoomVertex&, const RoomVertex&) = default;
};

/// Textures of a draw call, into Scene::textures.
struct RoomTextures {
  std::uint32_t colour = none, opacity = none;
  std::uint32_t emission = none;  ///< of the light, in place of the colour

  friend auto operator<=>(const RoomTextures&, const RoomTextures&) = default;
};

/// Triangles that are drawn by one call.
struct RoomPart {
  Interaction interaction = Interaction::opaque;
  bool clear = false;  ///< drawn over what lies behind: glass, and panes of any kind
  RoomTextures textures;
  std::uint32_t first = 0, count = 0;  ///< of the indices
};

struct RoomMesh {
  std::vector<RoomVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< three a triangle, counterclockwise from where it is seen
  std::vector<RoomPart> parts;         ///< clear ones last
};

/// The baked sides, each as seen from its own side.
RoomMesh mesh_of(const Scene& scene, const bake::LightAtlas& atlas);

}  // namespace photile::publish
