#include "scene/gltf_import.hpp"

#include "scene/gltf_accessor.hpp"
#include "scene/gltf_cameras.hpp"
#include "scene/gltf_document.hpp"
#include "scene/gltf_lights.hpp"
#include "scene/gltf_materials.hpp"
#include "scene/gltf_meshes.hpp"
#include "scene/gltf_nodes.hpp"
#include "scene/gltf_origin.hpp"
#include "scene/gltf_size.hpp"
#include "scene/gltf_surroundings.hpp"

namespace photile::scene_io {

void import_gltf(ImportContext& context) {
  const tinygltf::Model model = read_gltf(context);
  const AccessorReader accessors(model, context);
  context.scene.unit = PowerUnit::lumen;
  const std::vector<MaterialCoordinates> coordinates =
      add_gltf_materials(model, accessors, context);
  std::vector<NodeVisit> visits = visit_nodes(model, context);
  for (const NodeVisit& visit : visits) {
    context.visited_nodes.push_back(static_cast<std::uint32_t>(visit.node));
  }
  check_scene_size(model, accessors, visits, context);
  move_to_origin(model, accessors, visits, context);
  add_gltf_cameras(model, visits, context);
  add_gltf_lights(model, accessors, visits, context);
  add_gltf_meshes(model, accessors, visits, coordinates, context);
  add_gltf_surroundings(model, accessors, context);
}

}  // namespace photile::scene_io
