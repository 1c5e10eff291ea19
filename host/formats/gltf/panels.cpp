#include "gltf/panels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

#include "gltf/document.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photometry/photometric_file.hpp"
#include "scene/light_names.hpp"

namespace photile::gltf {
namespace {

using std::numbers::pi;

constexpr const char* area_extension = "EXT_lights_area";
constexpr const char* area_extra = "photile_area";
constexpr int disc_corners = 64;

double area_of(const Panel& panel) {
  return panel.width * panel.height * (panel.disc ? pi / 4.0 : 1.0);
}

/// White light of `lumens` from one side.
glm::dvec3 radiance_of(double lumens, const Panel& panel) {
  return glm::dvec3(lumens / (pi * area_of(panel)));
}

/// `photile_area`: [width, height], or the text "WxH".
std::optional<Panel> size_of(const tinygltf::Value& extras) {
  Panel panel;
  const tinygltf::Value& value = extras.Get(area_extra);
  if (value.IsString()) {
    const std::string text = value.Get<std::string>();
    const std::size_t cross = text.find('x');
    if (cross == std::string::npos) return std::nullopt;
    const std::string_view view = text;
    panel.width = parse_signed(trimmed(view.substr(0, cross))).value_or(0.0);
    panel.height = parse_signed(trimmed(view.substr(cross + 1))).value_or(0.0);
  } else {
    const glm::dvec3 size = vector_member(extras, area_extra, glm::dvec3(0.0));
    panel.width = size.x;
    panel.height = size.y;
  }
  return panel.width > 0.0 && panel.height > 0.0 ? std::optional(panel) : std::nullopt;
}

std::optional<Panel> panel_of_extras(const tinygltf::Node& node, const std::string& name,
                                     files::Warnings& warnings) {
  std::optional<Panel> panel = size_of(node.extras);
  const double lumens = number_member(node.extras, "photile_lumens", 0.0);
  if (!panel || !(lumens > 0.0)) {
    warnings.add("node", name,
                 "an area light needs photile_area, [width, height] in metres, and photile_lumens, "
                 "each above 0; left out");
    return std::nullopt;
  }
  panel->radiance = radiance_of(lumens, *panel);
  return panel;
}

std::optional<Panel> panel_of_extension(const tinygltf::Model& model,
                                        const tinygltf::Value& reference, const std::string& name,
                                        reading::ImportContext& context) {
  const double index = number_member(reference, "light", -1.0);
  const tinygltf::Value* const found = light_of_extension(model, area_extension, index);
  if (found == nullptr) {
    throw context.error(fmt::format("node '{}': there is no light {} of {}; export the file again",
                                    name, index, area_extension));
  }
  const tinygltf::Value& light = *found;
  const std::string type = string_member(light, "type");
  Panel panel;
  panel.disc = type == "disk" || type == "disc";
  panel.height = number_member(light, "size", 1.0);
  panel.width = panel.height;
  if (type == "rect" && light.Has("rect")) {
    panel.width *= number_member(light.Get("rect"), "aspect", 1.0);
  }
  panel.radiance = number_member(light, "intensity", 1.0) *
                   glm::max(vector_member(light, "color", glm::dvec3(1.0)), glm::dvec3(0.0));
  if ((type != "rect" && !panel.disc) || !(area_of(panel) > 0.0) ||
      !(luminance(panel.radiance) > 0.0)) {
    context.warnings.add(
        "node", name,
        fmt::format("its light of {} has no size, no intensity or an unknown type '{}'; left out",
                    area_extension, type));
    return std::nullopt;
  }
  return panel;
}

}  // namespace

bool has_panel(const tinygltf::Node& node) { return node.extras.Has(area_extra); }

std::optional<Panel> panel_of(const tinygltf::Model& model, int number,
                              reading::ImportContext& context) {
  const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(number)];
  for (const LuminousPanel& asked : context.options.panels) {
    if (asked.node != node.name) continue;
    if (asked.lumens > limits::max_light_power) {
      throw UsageError(fmt::format("area light '{}' of {:g} lm: the limit is {:g} lm; reduce it",
                                   asked.node, asked.lumens, limits::max_light_power));
    }
    Panel panel{asked.width, asked.height};
    panel.radiance = radiance_of(asked.lumens, panel);
    return panel;
  }
  const std::string name = node_name(model, number);
  if (has_panel(node)) return panel_of_extras(node, name, context.warnings);
  if (const auto* reference = find_extension(node.extensions, area_extension)) {
    return panel_of_extension(model, *reference, name, context);
  }
  return std::nullopt;
}

std::vector<std::array<glm::dvec3, 3>> panel_triangles(const Panel& panel,
                                                       const glm::dmat4& world) {
  const glm::dvec3 x = glm::normalize(glm::dvec3(world[0]));
  const glm::dvec3 y = glm::normalize(glm::cross(glm::dvec3(world[2]), x));
  const glm::dvec3 center(world[3]);
  const auto at = [&](double u, double v) {
    return center + 0.5 * panel.width * u * x + 0.5 * panel.height * v * y;
  };
  // From y towards x: the front looks along -z.
  if (!panel.disc) {
    return {{at(-1, -1), at(-1, 1), at(1, 1)}, {at(-1, -1), at(1, 1), at(1, -1)}};
  }
  // A polygon of the disc's area.
  const double step = 2.0 * pi / disc_corners, out = std::sqrt(step / std::sin(step));
  std::vector<std::array<glm::dvec3, 3>> triangles;
  for (int i = 0; i < disc_corners; ++i) {
    const auto corner = [&](int k) {
      return at(out * std::sin(step * k), out * std::cos(step * k));
    };
    triangles.push_back({at(0, 0), corner(i), corner((i + 1) % disc_corners)});
  }
  return triangles;
}

void check_panel_names(const tinygltf::Model& model, const std::vector<NodeVisit>& visits,
                       const reading::ImportContext& context) {
  for (const LuminousPanel& panel : context.options.panels) {
    std::vector<std::string> names;
    for (const NodeVisit& visit : visits) names.push_back(node_name(model, visit.node));
    if (std::find(names.begin(), names.end(), panel.node) == names.end()) {
      throw UsageError(fmt::format("area light at node {}: there is no node '{}'; there {}",
                                   panel.node, panel.node, scene::listed_names(names)));
    }
  }
}

}  // namespace photile::gltf
