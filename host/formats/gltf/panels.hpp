// Luminous rectangles and discs at nodes of a glTF file: EXT_lights_area, the extras `photile_area`
// and `photile_lumens`, and --area-light.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "gltf/nodes.hpp"
#include "gltf/tiny_gltf.hpp"
#include "reading/import_context.hpp"

namespace photile::gltf {

/// A flat lamp around a node's origin, in its xy plane; it shines along -z. The node's scale does
/// not count.
struct Panel {
  double width = 0, height = 0;  ///< metres
  bool disc = false;             ///< `width` and `height` are its diameter
  glm::dvec3 radiance{0.0};      ///< cd/m2, linear RGB
};

/// The panel of a node, or nothing; --area-light comes before extras, extras before the extension.
/// One without a size or light is named in a warning. Errors: InputError for a light of the
/// extension that does not exist.
std::optional<Panel> panel_of(const tinygltf::Model& model, int node,
                              reading::ImportContext& context);

/// Whether a node's extras ask for a panel.
bool has_panel(const tinygltf::Node& node);

/// Triangles of a panel at a node, counter-clockwise as seen from its bright side.
std::vector<std::array<glm::dvec3, 3>> panel_triangles(const Panel& panel, const glm::dmat4& world);

/// Errors: UsageError for a --area-light whose node is not in the file; it lists those there are.
void check_panel_names(const tinygltf::Model& model, const std::vector<NodeVisit>& visits,
                       const reading::ImportContext& context);

}  // namespace photile::gltf
