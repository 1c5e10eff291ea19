#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>

#include "files/scene_files.hpp"
#include "obj/obj_reader.hpp"
#include "photile/limits.hpp"
#include "pictures/textures.hpp"
#include "reading/import_context.hpp"
#include "reading/triangles.hpp"
#include "scene/mesh_builder.hpp"
#include "scene/scene_queries.hpp"
#include "scene/surface_models.hpp"

namespace photile::obj {

namespace {

constexpr double default_index_of_refraction = 1.5;  // where MTL asks for glass without an Ni

/// Of what a material says, or black.
glm::vec3 reflectance(const std::optional<glm::dvec3>& color) {
  return glm::vec3(color.value_or(glm::dvec3(0.0)));
}

bool emits(const MtlMaterial& source) {
  return source.Ke.value_or(glm::dvec3(0.0)) != glm::dvec3(0.0);
}

/// Kd, or the factor of a texture without one, or what a material without any has.
glm::vec3 diffuse_of(const MtlMaterial& source, files::Warnings& warnings) {
  if (source.Kd) {
    if (*source.Kd == glm::dvec3(0.0) && !source.map_Kd.empty()) {
      warnings.add("material", source.name, "its Kd of 0 makes its map_Kd black");
    }
    return glm::vec3(*source.Kd);
  }
  if (!source.map_Kd.empty()) return glm::vec3(1.0f);
  if (emits(source)) return glm::vec3(0.0f);
  warnings.add("material", source.name, "has no Kd; mid grey (0.5) is used");
  return glm::vec3(scene::missing_albedo);
}

bool is_glass(const MtlMaterial& source) {
  constexpr std::array<int, 4> models{4, 6, 7, 9};
  if (std::find(models.begin(), models.end(), source.illum) != models.end()) return true;
  return source.d.value_or(1) < 1 && source.Ni.value_or(1) > 1 && source.map_d.empty();
}

void set_glass(const MtlMaterial& source, Material& material, files::Warnings& warnings) {
  // MTL files have an Ns of 0 or 1 where it was not chosen.
  const double exponent = source.Ns.value_or(0);
  if (exponent > 1 && exponent < scene::mirror_phong_exponent) {
    warnings.add("material", source.name,
                 fmt::format("rough glass (Ns {:.4g}) is treated as smooth", exponent));
  }
  material.interaction = Interaction::glass;
  material.specular = glm::vec3(1.0f);
  const double index = source.Ni.value_or(default_index_of_refraction);
  material.index_of_refraction = static_cast<float>(
      index > 1 ? std::min(index, limits::max_index_of_refraction) : default_index_of_refraction);
  material.transmission = glm::vec3(source.Tf.value_or(glm::dvec3(1.0)));
  if (material.transmission == glm::vec3(0.0f)) {
    warnings.add("material", source.name, "its Tf of 0 lets no light through");
  }
}

void set_mirror(const glm::vec3& specular, Material& material) {
  material.interaction = Interaction::mirror;
  material.specular = specular;
}

void set_surface(const MtlMaterial& source, bool lambertian, Material& material,
                 files::Warnings& warnings) {
  if (source.Pr.value_or(0) > 0 || source.Pm.value_or(0) > 0) {
    MetallicRoughness model;
    model.base_color = diffuse_of(source, warnings);
    model.metallic = source.Pm.value_or(0);
    model.roughness = source.Pr.value_or(0);
    if (lambertian) model.specular_factor = 0;
    scene::set_metallic_roughness(model, material);
    return;
  }
  if (is_glass(source)) return set_glass(source, material, warnings);
  const glm::vec3 specular = reflectance(source.Ks);
  const double exponent = source.Ns.value_or(0);
  const bool reflective_model = source.illum == 3 || source.illum == 5;
  const bool specular_model = source.illum == 2 || reflective_model;
  const bool black_diffuse = reflectance(source.Kd) == glm::vec3(0.0f) && source.map_Kd.empty();
  if (reflective_model && specular != glm::vec3(0.0f) &&
      (exponent >= scene::mirror_phong_exponent || black_diffuse)) {
    return set_mirror(specular, material);
  }
  material.diffuse = diffuse_of(source, warnings);
  if (specular_model && !lambertian) {
    material.specular = specular;
    material.roughness = scene::ggx_alpha_from_phong_exponent(exponent);
    if (scene::conserve_energy(material)) {
      warnings.add("material", source.name, "Kd + Ks exceeds 1; both are scaled");
    }
  }
}

/// A picture that the library names, as written on Windows or elsewhere. Errors: ResourceError.
std::uint32_t texture_named(std::string path, pictures::TextureStore& textures,
                            pictures::TextureContent content = pictures::TextureContent::color) {
  std::replace(path.begin(), path.end(), '\\', '/');
  return textures.from_file(path, content);
}

/// A texture beside map_Kd; `none` where the material has none or it cannot be had.
std::uint32_t texture_or_none(const std::string& name, pictures::TextureContent content,
                              const std::string& substitute, const Material& material,
                              pictures::TextureStore& textures, reading::ImportContext& context) {
  if (name.empty()) return none;
  try {
    return texture_named(name, textures, content);
  } catch (const files::ResourceError& error) {
    context.warnings.add("material", material.name,
                         std::string(error.what()) + "; " + substitute + " is used instead");
    return none;
  }
}

/// d, Tr and map_d. Emission knows no cutouts: what shines stays whole.
void set_opacity(const MtlMaterial& source, bool emits, pictures::TextureStore& textures,
                 Material& material, reading::ImportContext& context) {
  if (material.interaction == Interaction::glass) return;
  // Some programs write Tr as they write d, and what is not there at all would not be in the file.
  const double d = source.d.value_or(1);
  const float opacity = d > 0 ? static_cast<float>(d) : 1.0f;
  if (d == 0) {
    context.warnings.add("material", material.name, "d 0 (Tr 1) is treated as opaque");
  }
  const std::uint32_t texture = texture_or_none(source.map_d, pictures::TextureContent::opacity,
                                                "d", material, textures, context);
  if (texture == none && opacity >= 1.0f) return;
  if (emits) {
    context.warnings.add("material", material.name,
                         "d, Tr or map_d of a material that emits is ignored; it has no cutouts");
    return;
  }
  material.opacity = opacity;
  material.opacity_texture = texture;
  if (opacity < 1.0f) {
    context.warnings.add("material", material.name,
                         "transparency (d, Tr) lets light straight through, without refraction; "
                         "an Ni would make it glass");
  }
}

reading::Emission emission_of(const MtlMaterial& source, pictures::TextureStore& textures,
                              reading::ImportContext& context) {
  reading::Emission emission{source.Ke.value_or(glm::dvec3(0.0)) *
                             static_cast<double>(context.options.emissive_scale)};
  if (source.map_Ke.empty()) return emission;
  if (!source.Ke) {
    context.warnings.add("material", source.name,
                         "its map_Ke emits nothing without a Ke, which is its radiance where the "
                         "texture is white");
  }
  if (emission.radiance == glm::dvec3(0.0)) return emission;
  try {
    emission.texture = texture_named(source.map_Ke, textures);
  } catch (const files::ResourceError& error) {
    context.warnings.add("material", source.name,
                         std::string(error.what()) + "; its Ke is used alone");
  }
  return emission;
}

/// Appends one material and its emission to the context. OBJ emission is W/(m2 sr), from the front
/// side only.
///
/// | MTL                                            | becomes                                   |
/// |------------------------------------------------|-------------------------------------------|
/// | Pr or Pm above 0                               | metallic-roughness with base colour Kd    |
/// | illum 4, 6, 7, 9; or d < 1, Ni and no map_d    | glass of index Ni (1.5 without), tint Tf  |
/// | illum 3, 5 with Ns >= 1000, or black Kd and Ks | mirror with reflectance Ks                |
/// | illum 2, 3, 5 with Ks                          | Lambertian Kd plus a GGX lobe of F0 Ks    |
/// | anything else                                  | Lambertian Kd                             |
/// | map_d; or d < 1 without Ni                     | opacity: cutouts, by chance in between      |
/// | norm                                           | a normal map, -bm its scale               |
/// | map_Kd without Kd                              | the texture as it is                      |
/// | neither of them, nor Ke                        | mid grey                                  |
void add_mtl_material(const MtlMaterial& source, pictures::TextureStore& textures,
                      reading::ImportContext& context) {
  Material material;
  material.name = source.name;
  set_surface(source, context.options.lambertian, material, context.warnings);
  if (!source.map_Kd.empty() && material.interaction == Interaction::opaque) {
    try {
      material.diffuse_texture = texture_named(source.map_Kd, textures);
    } catch (const files::ResourceError& error) {
      pictures::use_missing_texture_colour(material);
      context.warnings.add("material", source.name,
                           std::string(error.what()) + "; mid grey (0.5) is used instead");
    }
  }
  material.normal_texture = texture_or_none(source.norm, pictures::TextureContent::data,
                                            "no normal map", material, textures, context);
  material.normal_scale = static_cast<float>(
      std::clamp(source.norm_scale, -limits::max_normal_scale, limits::max_normal_scale));
  const reading::Emission emission = emission_of(source, textures, context);
  set_opacity(source, emission.radiance != glm::dvec3(0.0), textures, material, context);
  context.scene.materials.push_back(std::move(material));
  context.emission.push_back(emission);
}

/// Appends a mid-grey material for a name that no library defines.
void add_missing_material(const std::string& name, reading::ImportContext& context) {
  Material material;
  material.name = name;
  material.diffuse = glm::vec3(scene::missing_albedo);
  context.scene.materials.push_back(std::move(material));
  context.emission.emplace_back();
}

void report_findings(const ObjTextFindings& findings, files::Warnings& warnings) {
  if (findings.vertex_colors) warnings.add("vertex colours are ignored");
  for (const auto& [keyword, lines] : findings.ignored_statements) {
    warnings.add("statement", keyword, "unknown, or not about polygons; ignored");
  }
}

/// Adds the materials that faces use. Returns the scene's material of each usemtl name, and one
/// more for faces without any.
std::vector<std::uint32_t> add_materials(const ObjFile& file,
                                         const std::vector<MtlMaterial>& defined,
                                         reading::ImportContext& context) {
  if (file.material_names.size() + 1 > limits::max_materials) {
    throw context.error(fmt::format("more than {} materials; merge some", limits::max_materials));
  }
  std::map<std::string, const MtlMaterial*> library;
  for (const MtlMaterial& material : defined) {
    if (!library.emplace(material.name, &material).second) {
      context.warnings.add("material", material.name, "defined more than once; the first is used");
    }
  }
  pictures::TextureStore textures(context.scene, context.folder);
  std::vector<std::uint32_t> index;
  for (const std::string& name : file.material_names) {
    index.push_back(static_cast<std::uint32_t>(context.scene.materials.size()));
    if (const auto found = library.find(name); found != library.end()) {
      add_mtl_material(*found->second, textures, context);
    } else {
      context.warnings.add("material", name,
                           "not defined in any material library; mid grey (0.5) is used");
      add_missing_material(name, context);
    }
  }
  const bool some_without = std::any_of(file.faces.begin(), file.faces.end(),
                                        [](const ObjFace& face) { return face.material == none; });
  index.push_back(static_cast<std::uint32_t>(context.scene.materials.size()));
  if (some_without) {
    context.warnings.add("faces without usemtl become mid grey (0.5)");
    add_missing_material("default", context);
  }
  return index;
}

scene::Corner corner_of(const ObjFile& file, const tinyobj::index_t& index) {
  scene::Corner corner;
  corner.position = file.positions[static_cast<std::size_t>(index.vertex_index)];
  if (index.normal_index >= 0) {
    corner.normal = file.normals[static_cast<std::size_t>(index.normal_index)];
  }
  if (index.texcoord_index >= 0) {
    const glm::dvec2 uv = file.texcoords[static_cast<std::size_t>(index.texcoord_index)];
    corner.uv = {uv.x, 1.0 - uv.y};  // OBJ puts (0,0) at the lower left corner
    corner.emission_uv = corner.uv;
  }
  return corner;
}

void add_face(const ObjFile& file, const ObjFace& face, std::uint32_t material,
              scene::MeshBuilder& builder, reading::PlainMaterials& plain_materials,
              reading::ImportContext& context) {
  std::vector<scene::Corner> corners;
  std::vector<glm::dvec3> positions;
  bool has_coordinates = true;
  for (std::uint64_t c = face.first_corner; c < face.first_corner + face.corner_count; ++c) {
    corners.push_back(corner_of(file, file.corners[c]));
    positions.push_back(corners.back().position);
    has_coordinates &= file.corners[c].texcoord_index >= 0;
  }
  reading::Emission emission = context.emission[material];
  const Material& requested = context.scene.materials[material];
  const bool is_plain = !has_coordinates && requested.textured();
  if (is_plain || (!has_coordinates && emission.texture != none)) {
    context.warnings.add(
        "material", requested.name,
        "faces without texture coordinates use its factors, and mid grey (0.5) in place of map_Kd");
    emission.texture = none;
  }
  const std::uint32_t light =
      context.area_lights.find_or_add(face.object, file.objects[face.object], material, emission);
  if (is_plain) material = plain_materials.of(material);
  if (corners.size() == 3) {
    builder.add({corners[0], corners[1], corners[2]}, material, light);
    return;
  }
  ++context.scene.report.polygons_triangulated;
  if (!std::all_of(positions.begin(), positions.end(), scene::within_limit)) {
    // No plane to triangulate in: the whole polygon is lost, as many triangles as it would give.
    context.scene.report.non_finite_triangles += corners.size() - 2;
    return;
  }
  const reading::Triangulation triangulation =
      reading::triangulate_polygon(positions, context.progress);
  if (!triangulation.simple) {
    context.warnings.add("object", file.objects[face.object],
                         "a polygon crosses itself; its triangulation may overlap or leave gaps");
  }
  for (const auto& [a, b, c] : triangulation.triangles) {
    builder.add({corners[a], corners[b], corners[c]}, material, light);
  }
}

/// Turns the file upright, and its lengths into metres.
void place(ObjFile& file, const glm::dmat3& turn, double metres_per_unit) {
  for (glm::dvec3& normal : file.normals) normal = turn * normal;
  const glm::dmat3 placed = metres_per_unit * turn;
  for (glm::dvec3& position : file.positions) position = placed * position;
}

/// Chooses Scene::origin (triangles.hpp) and counts all positions from there.
void move_to_origin(ObjFile& file, Scene& scene) {
  reading::SceneOrigin origin;
  const auto position = [&](std::uint64_t corner) {
    return file.positions[static_cast<std::size_t>(file.corners[corner].vertex_index)];
  };
  for (const ObjFace& face : file.faces) {
    // A fan stands for the polygon's triangles: their sizes are all that counts.
    for (std::uint32_t c = 2; c < face.corner_count; ++c) {
      origin.add({position(face.first_corner), position(face.first_corner + c - 1),
                  position(face.first_corner + c)});
    }
  }
  scene.origin = origin.best();
  for (glm::dvec3& at : file.positions) at -= scene.origin;
}

}  // namespace

void import_obj(reading::ImportContext& context) {
  if (!context.options.panels.empty()) {
    throw UsageError(
        fmt::format("area light at node {}: OBJ files have no nodes; leave out the area light, or "
                    "give a glTF file",
                    context.options.panels.front().node));
  }
  if (!context.options.scene.empty()) {
    throw UsageError(
        fmt::format("scene {}: OBJ files have no scenes; leave out the scene, or give a glTF file",
                    context.options.scene));
  }
  const std::vector<unsigned char> bytes = context.folder.read_scene_file();
  std::string text(bytes.begin(), bytes.end());
  ObjTextFindings findings;
  try {
    findings = examine_obj_text(text, context);
  } catch (const files::ResourceError& error) {
    throw context.error(error.what());
  }
  report_findings(findings, context.warnings);
  ObjFile file = read_obj(text, context);
  for (const std::uint64_t vertex : findings.unreadable_vertices) {
    if (vertex < file.positions.size()) {
      file.positions[vertex] = glm::dvec3(std::numeric_limits<double>::quiet_NaN());
    }
  }
  std::vector<bool> is_hidden;
  for (const std::string& object : file.objects) is_hidden.push_back(context.is_hidden(object));
  std::erase_if(file.faces, [&](const ObjFace& face) { return is_hidden[face.object]; });
  context.check_hidden();
  place(file, context.scene.turn, context.options.metres_per_unit);
  move_to_origin(file, context.scene);
  context.scene.unit = PowerUnit::watt;
  const std::vector<std::uint32_t> material_index =
      add_materials(file, read_obj_libraries(findings.libraries, context), context);
  const SceneNeeds needs = scene::needs_of_materials(context.scene.materials);
  scene::MeshBuilder builder(context.scene,
                             {needs.textures, reading::has_emission_texture(context), true});
  reading::PlainMaterials plain_materials(context.scene);
  std::vector<std::uint64_t> triangles(file.objects.size(), 0);
  for (const ObjFace& face : file.faces) {
    context.check_cancelled();
    const std::size_t name = face.material == none ? material_index.size() - 1 : face.material;
    const std::size_t before = context.scene.triangles.size();
    add_face(file, face, material_index[name], builder, plain_materials, context);
    triangles[face.object] += context.scene.triangles.size() - before;
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (triangles[i] > 0) context.scene.report.meshes.push_back({file.objects[i], triangles[i]});
  }
  builder.finish();
  scene::drop_flat_normals(context.scene, needs);
}

}  // namespace photile::obj
