#include "command/scene_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "command/terminal_progress.hpp"
#include "common/foreign_text.hpp"
#include "image/light_change.hpp"
#include "image/light_layers.hpp"
#include "loading/surroundings.hpp"
#include "measuring/measurement.hpp"
#include "measuring/rooms.hpp"
#include "photile/defaults.hpp"
#include "report/record.hpp"
#include "report/tables.hpp"
#include "scene/panes.hpp"
#include "scene/scene_queries.hpp"
#include "scene/surface_models.hpp"

namespace photile::app {
namespace {

using nlohmann::json;

/// "reflectance 0.52", and why it is not the colour that the file has; "" of glass.
std::string reflectance_text(const Scene& scene, const Material& material) {
  const auto reflectance = scene::reflectance_of(scene, material);
  if (!reflectance) return "";
  std::string text = fmt::format(", reflectance {:.3g}", reflectance->whole);
  if (const auto transmittance = scene::pane_transmittance(material)) {
    return fmt::format(", transmittance {:.3g}{}", luminance(*transmittance), text);
  }
  if (!material.glossy()) return text;
  const bool changed = std::abs(reflectance->whole - reflectance->matt) >= 0.005;
  if (!changed || !(reflectance->matt > 0)) return text;
  return text +
         fmt::format(" ({:.3g} entered, and {:.2g} specular; --set lambertian=on removes that)",
                     reflectance->matt, luminance(glm::dvec3(material.specular)));
}

constexpr std::size_t most_meshes_told = 20;

/// "1 camera", "2 cameras"
std::string counted(std::size_t count, const std::string& noun, const std::string& nouns = "") {
  return fmt::format("{} {}", count, count == 1 ? noun : nouns.empty() ? noun + "s" : nouns);
}

const char* interaction_name(const Material& material) {
  if (material.interaction != Interaction::glass && scene::is_pane(material)) return "pane";
  switch (material.interaction) {
    case Interaction::opaque:
      return material.glossy() ? "glossy" : "diffuse";
    case Interaction::mirror:
      return "mirror";
    case Interaction::glass:
      return material.thin ? "thin glass" : "glass";
  }
  return "";
}

template <class Vector>
json components(const Vector& vector) {
  return json::array({vector.x, vector.y, vector.z});
}

/// What a light of the scene emits, as its layer states it.
struct StatedPower {
  double power;
  PowerUnit unit;
  double lumens;
  double electrical_watts;  ///< that a luminaire takes; 0 = not known
};

std::vector<StatedPower> stated_powers(const Scene& scene, const LightMix& mix) {
  const LightGroups groups = light_groups_of(scene);
  const std::vector<double> powers = report::powers_of(scene, mix);
  std::vector<StatedPower> stated;
  for (std::size_t i = 0; i < powers.size(); ++i) {
    const PowerUnit unit = mix.lights[groups.group_of[i]].unit;
    const double lumens = in_unit(powers[i], unit, PowerUnit::lumen, mix.lumen_per_watt);
    const std::uint32_t file = scene.lights[i].distribution;
    stated.push_back({powers[i], unit, lumens,
                      file == none ? 0 : scene.distributions[file].electrical_watts(lumens)});
  }
  return stated;
}

/// ", 1200 lm", ", 80,000 lux" facing the sun, or "" of surroundings.
std::string emission_text(const Scene& scene, const Light& light, const StatedPower& stated,
                          double lumen_per_watt) {
  if (!light.is_distant()) {
    return ", " + format_power_in_lumens(stated.power, stated.unit, lumen_per_watt);
  }
  if (light.kind != LightKind::directional) return "";
  const double disc = std::numbers::pi * std::pow(bounding_sphere(scene).radius, 2);
  return ", " + report::grouped(stated.lumens / disc, 4) + " lux";
}

/// Radiant watts of luminaires with photometric files would be mistaken for electric power.
json power_json(const StatedPower& stated, bool photometric, double lumen_per_watt) {
  json entry{{"unit", symbol_of(stated.unit)}, {"lumens", stated.lumens}};
  if (!photometric)
    entry["watts"] = in_unit(stated.power, stated.unit, PowerUnit::watt, lumen_per_watt);
  if (stated.electrical_watts > 0) entry["electrical_watts"] = stated.electrical_watts;
  return entry;
}

/// The file that says where a light shines to, or "".
std::string source_of(const Scene& scene, const Light& light) {
  if (light.distribution != none) return scene.distributions[light.distribution].name();
  if (light.environment != none) return scene.environments[light.environment].name();
  return "";
}

json light_json(const Light& light, const std::string& source, const StatedPower& stated,
                double lumen_per_watt) {
  json entry{{"name", light.name},
             {"kind", report::kind_name(light)},
             {"color", components(light.color)},
             {"triangles", light.triangles.size()},
             {"two_sided", light.two_sided}};
  if (!light.group.empty()) entry["group"] = light.group;
  if (!source.empty()) entry["source"] = source;
  entry.update(power_json(stated, light.distribution != none, lumen_per_watt));
  return entry;
}

json group_json(const MixedLight& group, const StatedPower& stated, bool photometric,
                double lumen_per_watt) {
  json entry{{"name", group.name}, {"lights", group.members}, {"color", components(group.color)}};
  entry.update(power_json(stated, photometric, lumen_per_watt));
  return entry;
}

std::vector<std::size_t> triangles_of_materials(const Scene& scene) {
  std::vector<std::size_t> triangles(scene.materials.size(), 0);
  for (const std::uint32_t material : scene.triangle_material) ++triangles[material];
  return triangles;
}

json material_json(const Scene& scene, const Material& material, std::size_t triangles) {
  json entry{{"name", material.name},
             {"interaction", interaction_name(material)},
             {"triangles", triangles},
             {"diffuse", components(material.diffuse)},
             {"specular", components(material.specular)},
             {"f90", material.f90},
             {"roughness", material.roughness},
             {"opacity", material.opacity},
             {"opacity_cutoff", material.opacity_cutoff}};
  if (const auto reflectance = scene::reflectance_of(scene, material)) {
    entry["reflectance"] = reflectance->whole;
    entry["matt_reflectance"] = reflectance->matt;
  }
  if (const auto transmittance = scene::pane_transmittance(material)) {
    entry["transmittance"] = luminance(*transmittance);
  }
  const auto add_texture = [&](const char* member, std::uint32_t texture) {
    if (texture != none) entry[member] = scene.textures[texture].name();
  };
  add_texture("texture", material.diffuse_texture);
  add_texture("opacity_texture", material.opacity_texture);
  add_texture("normal_texture", material.normal_texture);
  if (material.metallic_roughness != none) {
    const MetallicRoughness& model = scene.metallic_roughness[material.metallic_roughness];
    add_texture("metallic_roughness_texture", model.texture);
    add_texture("specular_texture", model.specular_texture);
    add_texture("specular_color_texture", model.specular_color_texture);
  }
  return entry;
}

json camera_json(const Camera& camera) {
  return {{"name", camera.name},
          {"position", components(camera.position)},
          {"forward", components(camera.forward)},
          {"up", components(camera.up)},
          {"vertical_field_of_view_degrees", glm::degrees(camera.vertical_field_of_view)},
          {"aspect_ratio", camera.aspect_ratio}};
}

/// "room: Kitchen: 12.5 m2, 2.50 m high, floor at 0.00 m, --inside=1.00,1.20,3.00"
std::string room_text(const measuring::NamedRoom& room) {
  const auto fact = [&](const char* key) { return room.facts[key].get<double>(); };
  return fmt::format(
      "{}{}: {:.1f} m2, {:.2f} m high, floor at {:.2f} m, --inside={:.2f},{:.2f},{:.2f}",
      room.name.starts_with("room ") ? "" : "room: ", one_line(room.name), fact("area"),
      fact("height"), fact("floor"), room.inside.x, room.inside.y, room.inside.z);
}

}  // namespace

Extents extents_of(const Scene& scene) {
  Extents extents{glm::dvec3(std::numeric_limits<double>::infinity()),
                  glm::dvec3(-std::numeric_limits<double>::infinity())};
  for (const glm::vec3& vertex : scene.vertices) {
    const glm::dvec3 place = position_in_world(scene, glm::dvec3(vertex));
    extents.lowest = glm::min(extents.lowest, place);
    extents.highest = glm::max(extents.highest, place);
  }
  return extents;
}

std::vector<std::string> sky_summary(const LightMix& mix) {
  const std::size_t patches = loading::patches_of(mix).size();
  if (patches == 0) return {};
  return {fmt::format("sky: {} patches and the ground, a light each", patches)};
}

std::vector<std::string> sky_lines(const SceneLoadOptions& load) {
  std::vector<std::string> lines;
  for (const auto& [name, text] : loading::sky_facts(load)) lines.push_back(name + ": " + text);
  return lines;
}

std::vector<std::string> scene_summary(const Scene& scene, const LightMix& mix) {
  const Extents extents = extents_of(scene);
  const glm::dvec3 size = extents.size();
  std::vector<std::string> lines{
      fmt::format(
          "scene: {}: {}, {}, {}, {}", scene.source.string(),
          counted(scene.triangle_count(), "triangle"), counted(scene.materials.size(), "material"),
          counted(scene.textures.size(), "texture"), counted(scene.cameras.size(), "camera")),
      fmt::format("extents: {:.4g} x {:.4g} x {:.4g} m, from ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, "
                  "{:.4g}, {:.4g})",
                  size.x, size.y, size.z, extents.lowest.x, extents.lowest.y, extents.lowest.z,
                  extents.highest.x, extents.highest.y, extents.highest.z)};
  const std::vector<StatedPower> powers = stated_powers(scene, mix);
  const std::vector<std::uint32_t> patch_of = loading::patch_of_layers(mix);
  const LightGroups groups = light_groups_of(scene);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (patch_of[groups.group_of[i]] != none) continue;
    const std::string source = source_of(scene, light);
    const double watts = powers[i].electrical_watts;
    lines.push_back(fmt::format(
        "light: {}: {}{}{}{}{}", light.name, report::kind_name(light),
        emission_text(scene, light, powers[i], mix.lumen_per_watt),
        watts > 0 ? fmt::format(", takes {}", format_power(watts, PowerUnit::watt)) : "",
        light.group.empty() ? "" : ", of group " + light.group,
        source.empty() ? "" : ", from " + source));
  }
  for (const std::string& line : sky_summary(mix)) lines.push_back(line);
  for (const MixedLight& group : mix.lights) {
    if (group.members.empty()) continue;
    lines.push_back(
        fmt::format("group: {}: {}, {}", group.name, counted(group.members.size(), "light"),
                    format_power_in_lumens(group.power, group.unit, mix.lumen_per_watt)));
  }
  return lines;
}

std::vector<std::string> material_summary(const Scene& scene) {
  const std::vector<std::size_t> triangles = triangles_of_materials(scene);
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& material = scene.materials[i];
    const bool textured = material.diffuse_texture != none;
    lines.push_back(fmt::format(
        "material: {}: {}, {}{}{}", material.name, interaction_name(material),
        counted(triangles[i], "triangle"), reflectance_text(scene, material),
        textured ? ", texture " + scene.textures[material.diffuse_texture].name() : ""));
  }
  return lines;
}

std::vector<std::string> mesh_summary(const Scene& scene) {
  std::vector<ImportedMesh> meshes = scene.report.meshes;
  std::stable_sort(meshes.begin(), meshes.end(), [](const ImportedMesh& a, const ImportedMesh& b) {
    return a.triangles > b.triangles;
  });
  std::vector<std::string> lines;
  for (const ImportedMesh& mesh : meshes) {
    if (lines.size() == most_meshes_told) {
      lines.push_back(fmt::format("{} smaller ones: --json lists all",
                                  counted(meshes.size() - most_meshes_told, "mesh", "meshes")));
      break;
    }
    lines.push_back(fmt::format("mesh: {}: {}", mesh.name, counted(mesh.triangles, "triangle")));
  }
  return lines;
}

std::vector<std::string> doubts_of(const Scene& scene, const LightMix& mix) {
  std::vector<std::string> lines;
  const std::vector<std::size_t> triangles = triangles_of_materials(scene);
  std::string brightest;
  double most = 0;
  std::size_t materials = 0, covered = 0;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& material = scene.materials[i];
    if (material.interaction != Interaction::opaque || triangles[i] == 0) continue;
    const double reflectance = scene::reflectance_of(scene, material)->whole;
    if (reflectance < defaults::doubtful_reflectance) continue;
    ++materials;
    covered += triangles[i];
    if (reflectance > most) most = reflectance, brightest = material.name;
  }
  if (materials > 0) {
    lines.push_back(fmt::format(
        "{} on {} reflect {:.0f}% of light and more, '{}' {:.0f}%; white paint reflects 85%: set "
        "lower values with --reflectance",
        counted(materials, "material"), counted(covered, "triangle"),
        100 * defaults::doubtful_reflectance, brightest, 100 * most));
  }
  const std::vector<StatedPower> powers = stated_powers(scene, mix);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const double flux = powers[i].lumens;
    if (scene.lights[i].is_distant() || !(flux > 0) || flux >= defaults::doubtful_lumens) continue;
    lines.push_back(
        fmt::format("light '{}' emits {:.2g} lm, less than a candle (12 lm); --light NAME=FLUX "
                    "changes it",
                    scene.lights[i].name, flux));
  }
  return lines;
}

void warn_of_dark_lights(const Scene& scene, const LightMix& mix, const std::vector<bool>& reaches,
                         const std::string& what, Progress& progress) {
  const std::vector<std::string> layers = image::layer_names(scene);
  std::vector<MixedLight> lights;
  for (const std::string& name : layers) lights.push_back(mix.lights[image::index_of(mix, name)]);
  for (const auto& line : measuring::lights_that_reach_nothing(lights, reaches, what)) {
    progress.warn(line);
  }
}

std::vector<std::string> info_warnings(const Scene& scene, const LightMix& mix) {
  std::vector<std::string> lines = scene.report.warnings;
  for (std::string& line : doubts_of(scene, mix)) lines.push_back(std::move(line));
  const std::vector<std::uint32_t> open = scene::open_edges_of_glass(scene);
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (open[i] == 0) continue;
    lines.push_back(fmt::format(
        "material {}: solid glass is open at {}: all that lies behind counts as glass, unless "
        "other surfaces close it (water in a basin); make a pane of one sheet thin glass",
        scene.materials[i].name, counted(open[i], "edge")));
  }
  return lines;
}

std::vector<std::string> room_summary(const Scene& scene) {
  std::vector<std::string> lines;
  for (const auto& room : measuring::rooms_of(scene)) lines.push_back(room_text(room));
  if (lines.empty()) lines.emplace_back("room: none found with walls and a ceiling");
  return lines;
}

json scene_json(const Scene& scene, const LightMix& mix, const SceneLoadOptions& load) {
  const Extents extents = extents_of(scene);
  json result{{"scene", scene.source.string()},
              {"unit", symbol_of(mix.unit())},
              {"lumen_per_watt", mix.lumen_per_watt},
              {"triangles", scene.triangle_count()},
              {"vertices", scene.vertices.size()},
              {"polygons_triangulated", scene.report.polygons_triangulated},
              {"degenerate_triangles", scene.report.degenerate_triangles},
              {"non_finite_triangles", scene.report.non_finite_triangles},
              {"duplicate_triangles", scene.report.duplicate_triangles},
              {"extents",
               {{"lowest", components(extents.lowest)},
                {"highest", components(extents.highest)},
                {"size", components(extents.size())}}},
              {"origin", components(scene.origin)},
              {"meshes", json::array()},
              {"materials", json::array()},
              {"lights", json::array()},
              {"groups", json::array()},
              {"cameras", json::array()},
              {"rooms", json::array()},
              {"warnings", info_warnings(scene, mix)}};
  if (const auto ground = loading::ground_reflectance(load)) result["ground_reflectance"] = *ground;
  const std::vector<std::size_t> triangles = triangles_of_materials(scene);
  for (const ImportedMesh& mesh : scene.report.meshes) {
    result["meshes"].push_back({{"name", mesh.name}, {"triangles", mesh.triangles}});
  }
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    result["materials"].push_back(material_json(scene, scene.materials[i], triangles[i]));
  }
  const std::vector<StatedPower> powers = stated_powers(scene, mix);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    result["lights"].push_back(light_json(scene.lights[i], source_of(scene, scene.lights[i]),
                                          powers[i], mix.lumen_per_watt));
  }
  const LightGroups groups = light_groups_of(scene);
  for (std::size_t i = 0; i < mix.lights.size(); ++i) {
    const MixedLight& group = mix.lights[i];
    if (group.members.empty()) continue;
    StatedPower stated{group.power, group.unit, mix.lumens_of(group), 0};
    bool photometric = true, known = true;
    for (const std::uint32_t light : groups.groups[i].lights) {
      photometric = photometric && scene.lights[light].distribution != none;
      known = known && powers[light].electrical_watts > 0;
      stated.electrical_watts += powers[light].electrical_watts;
    }
    if (!known) stated.electrical_watts = 0;
    result["groups"].push_back(group_json(group, stated, photometric, mix.lumen_per_watt));
  }
  for (const auto& room : measuring::rooms_of(scene)) result["rooms"].push_back(room.facts);
  for (const Camera& camera : scene.cameras) {
    result["cameras"].push_back(camera_json(in_world(scene, camera)));
  }
  return result;
}

}  // namespace photile::app
