#include "gltf/steps.hpp"

#include "gltf/accessor.hpp"
#include "gltf/document.hpp"
#include "gltf/lights.hpp"
#include "gltf/materials.hpp"
#include "gltf/meshes.hpp"
#include "gltf/nodes.hpp"

namespace photile::gltf {

void import_gltf(reading::ImportContext& context) {
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

}  // namespace photile::gltf
