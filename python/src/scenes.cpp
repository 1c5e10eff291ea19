// Scenes: from files, and from arrays by SceneBuilder.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "arrays.hpp"
#include "loading/load_scene.hpp"
#include "loading/luminaires.hpp"
#include "loading/surroundings.hpp"
#include "parts.hpp"
#include "photile/defaults.hpp"
#include "photile/light_layers.hpp"
#include "photile/scene.hpp"
#include "photile/scene_builder.hpp"
#include "reading/triangles.hpp"
#include "scene/light_names.hpp"
#include "work.hpp"

namespace photile::python {
namespace {

using Vector3 = std::array<double, 3>;

glm::dvec3 vec(const Vector3& v) { return {v[0], v[1], v[2]}; }
template <class V>
py::tuple triple(const V& v) {
  return py::make_tuple(v.x, v.y, v.z);
}

constexpr std::array interactions{"opaque", "mirror", "glass"};

template <class E, std::size_t n>
E word(const std::array<const char*, n>& words, const std::string& found, const std::string& what) {
  std::string all;
  for (std::size_t i = 0; i < n; ++i) {
    if (found == words[i]) return static_cast<E>(i);
    all += (i > 0 ? ", " : "") + std::string(words[i]);
  }
  throw UsageError(what + ": '" + found + "' is not one of " + all);
}

/// An array of shape (height, width, 3 or 4), 8 bits each.
Texture texture_of(const std::string& name, const Array<std::uint8_t>& texels) {
  if (texels.ndim() != 3 || (texels.shape(2) != 3 && texels.shape(2) != 4) || texels.size() == 0) {
    throw InputError("texture of material '" + name + "': the array has shape " +
                     shape_text(texels) + "; it must have shape (height, width, 3 or 4)");
  }
  const auto components = static_cast<std::size_t>(texels.shape(2));
  const auto pixels = static_cast<std::size_t>(texels.shape(0) * texels.shape(1));
  std::vector<std::array<std::uint8_t, 4>> rgba(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint8_t* const from = texels.data() + i * components;
    rgba[i] = {from[0], from[1], from[2], components == 4 ? from[3] : std::uint8_t{255}};
  }
  return {name, static_cast<int>(texels.shape(1)), static_cast<int>(texels.shape(0)),
          std::move(rgba)};
}

/// By the fields of photile.Material.
Material material_of(SceneBuilder& builder, const py::dict& fields) {
  Material material;
  material.name = field<std::string>(fields, "name", "material: ");
  const std::string of = "material '" + material.name + "': ";
  material.interaction = word<Interaction>(
      interactions, field<std::string>(fields, "interaction", of), of + "interaction");
  material.diffuse = vec(field<Vector3>(fields, "diffuse", of));
  material.specular = vec(field<Vector3>(fields, "specular", of));
  material.roughness = field<float>(fields, "roughness", of);
  material.transmission = vec(field<Vector3>(fields, "transmission", of));
  material.index_of_refraction = field<float>(fields, "index_of_refraction", of);
  material.thin = field<bool>(fields, "thin", of);
  material.opacity = field<float>(fields, "opacity", of);
  if (!fields["texture"].is_none()) {
    material.diffuse_texture =
        builder.add(texture_of(material.name, field<Array<std::uint8_t>>(fields, "texture", of)));
  }
  return material;
}

/// An array of shape (height, width, 3): light from all around.
EnvironmentMap surroundings_of(const std::string& name, const Array<float>& texels) {
  if (texels.ndim() != 3 || texels.shape(2) != 3 || texels.size() == 0) {
    throw InputError("environment '" + name + "': the array has shape " + shape_text(texels) +
                     "; it must have shape (height, width, 3)");
  }
  const auto* const rows = reinterpret_cast<const glm::vec3*>(texels.data());
  const auto pixels = static_cast<std::size_t>(texels.shape(0) * texels.shape(1));
  if (!std::all_of(texels.data(), texels.data() + texels.size(),
                   [](float texel) { return std::isfinite(texel); })) {
    throw InputError("environment '" + name + "': a texel is not a finite number");
  }
  return {name,
          static_cast<int>(texels.shape(1)),
          static_cast<int>(texels.shape(0)),
          {rows, rows + pixels}};
}

/// By the fields of photile.Light; positions count from `origin`. Returns its number.
std::uint32_t add_light(SceneBuilder& builder, const py::dict& fields, const glm::dvec3& origin) {
  Light light;
  light.name = field<std::string>(fields, "name", "light: ");
  const std::string of = "light '" + light.name + "': ";
  light.group = field<std::string>(fields, "group", of);
  light.kind = named(all_light_kinds, field<std::string>(fields, "kind", of), of + "kind");
  light.power = field<double>(fields, "power", of);
  light.color = vec(field<Vector3>(fields, "color", of));
  light.position = vec(field<Vector3>(fields, "position", of)) - origin;
  light.direction = vec(field<Vector3>(fields, "direction", of));
  light.two_sided = field<bool>(fields, "two_sided", of);
  light.inner_cone_angle = glm::radians(field<float>(fields, "inner_angle", of));
  light.outer_cone_angle = glm::radians(field<float>(fields, "outer_angle", of));
  light.angular_diameter = glm::radians(field<float>(fields, "diameter", of));
  if (light.kind == LightKind::environment) {
    if (fields["texels"].is_none()) {
      throw InputError("light '" + light.name + "': an environment needs texels");
    }
    return builder.add_surroundings(
        light.name, surroundings_of(light.name, field<Array<float>>(fields, "texels", of)));
  }
  if (light.kind == LightKind::directional) {
    return builder.add_distant(light, field<double>(fields, "illuminance", of));
  }
  return builder.add(std::move(light));
}

/// The name of a list that is in no file, whose photometric files have absolute names.
constexpr const char* listed_luminaires = "/luminaires";

/// Adds a list of luminaires to a finished scene.
void add_listed(const std::string& text, Scene& scene) {
  if (text.empty()) return;
  files::Warnings warnings;
  loading::add_luminaires(loading::LuminaireList::parse(text, listed_luminaires), listed_luminaires,
                          /*allow_outside=*/false, defaults::lumen_per_watt, scene, warnings);
  scene::make_light_names_unique(scene.lights);
  for (const std::string& line : warnings.lines()) scene.report.warnings.push_back(line);
}

py::tuple tuple_of(const Camera& camera) {
  return py::make_tuple(camera.name, triple(camera.position), triple(camera.forward),
                        triple(camera.up), camera.vertical_field_of_view, camera.aspect_ratio);
}

SceneLoadOptions load_options(const py::dict& options) {
  SceneLoadOptions load;
  load.emissive_scale = field<float>(options, "emissive_scale");
  load.allow_outside = field<bool>(options, "allow_outside");
  load.scene = field<std::string>(options, "scene");
  load.up = field<std::string>(options, "up");
  load.metres_per_unit = field<double>(options, "metres_per_unit");
  load.lumen_per_watt = field<double>(options, "lumen_per_watt");
  const auto texts = [&](const char* name) {
    return field<std::vector<std::string>>(options, name);
  };
  for (const auto& text : texts("light_groups"))
    load.light_groups.push_back(LightGrouping::parse(text));
  for (const auto& text : texts("profiles")) load.profiles.push_back(LightProfile::parse(text));
  for (const auto& text : texts("temperatures")) {
    load.temperatures.push_back(LightTemperature::parse(text));
  }
  for (const auto& text : texts("panels")) load.panels.push_back(LuminousPanel::parse(text));
  load.environment = {field<std::string>(options, "environment"),
                      field<double>(options, "environment_scale"),
                      field<double>(options, "environment_rotation")};
  if (const auto text = field<std::string>(options, "sun"); !text.empty())
    load.sun = Sun::parse(text);
  if (const auto text = field<std::string>(options, "sky"); !text.empty())
    load.sky = Sky::parse(text);
  load.ground = field<double>(options, "ground");
  SkySituation& situation = load.situation;
  if (const auto text = field<std::string>(options, "site"); !text.empty())
    situation.site = Site::parse(text);
  if (const auto text = field<std::string>(options, "time"); !text.empty())
    situation.time = LocalTime::parse(text);
  situation.weather = field<std::string>(options, "weather");
  situation.north_degrees = field<double>(options, "north");
  for (const auto& text : texts("reflectance"))
    load.reflectances.push_back(MaterialShare::parse(text));
  for (const auto& text : texts("glass")) load.glasses.push_back(MaterialShare::parse(text));
  load.hidden = texts("hide");
  load.portals = texts("portals");
  load.luminaires = field<std::string>(options, "luminaires");
  load.luminaires_text = field<std::string>(options, "luminaires_text");
  if (!load.luminaires_text.empty()) load.luminaires = listed_luminaires;
  return load;
}

SharedScene load(const std::filesystem::path& file, const py::dict& options,
                 const py::object& progress) {
  const SceneLoadOptions load = load_options(options);
  return run(progress, [&](Progress& told) {
    return std::make_shared<Scene>(loading::load_scene(file, load, told));
  });
}

/// What results state of the sky that these options make: the reflectance of the ground, None
/// without a sky, and names and values.
py::tuple sky_of(const py::dict& options) {
  const SceneLoadOptions load = load_options(options);
  return py::make_tuple(loading::ground_reflectance(load), loading::sky_facts(load));
}

/// Where the scene's coordinates count from, as those of files do.
glm::dvec3 origin_of(std::span<const glm::dvec3> vertices, std::span<const glm::uvec3> triangles) {
  reading::SceneOrigin origin;
  for (const glm::uvec3& corner : triangles) {
    origin.add({vertices[corner[0]], vertices[corner[1]], vertices[corner[2]]});
  }
  return origin.best();
}

struct Arrays {
  Array<double> vertices;
  Array<float> normals, uv;
  Array<std::uint32_t> triangles, materials, lights;
};

SharedScene build(const std::string& name, const std::string& unit, const Arrays& arrays,
                  const py::list& materials, const py::list& lights, const py::list& cameras,
                  const std::string& luminaires) {
  constexpr std::array units{"lumen", "watt"};
  SceneBuilder builder(name, word<PowerUnit>(units, unit, "unit"));
  for (const py::handle& fields : materials) {
    builder.add(material_of(builder, fields.cast<py::dict>()));
  }
  const auto vertices = rows_of<glm::dvec3>(arrays.vertices, "vertices");
  const auto triangles = rows_of<glm::uvec3>(arrays.triangles, "triangles");
  Scene around;
  around.origin = origin_of(vertices, triangles);
  for (const py::handle& fields : lights) {
    add_light(builder, fields.cast<py::dict>(), around.origin);
  }
  for (const py::handle& parts : cameras) {
    builder.add(camera_of(around, parts.cast<py::tuple>()));
  }
  std::vector<glm::vec3> near;
  near.reserve(vertices.size());
  for (const glm::dvec3& vertex : vertices) near.emplace_back(vertex - around.origin);
  const MeshArrays mesh{.vertices = near,
                        .triangles = triangles,
                        .normals = rows_of<glm::vec3>(arrays.normals, "normals"),
                        .uv = rows_of<glm::vec2>(arrays.uv, "uv"),
                        .materials = values_of(arrays.materials, "triangle_materials"),
                        .lights = values_of(arrays.lights, "triangles of lights")};
  const Unlocked unlocked;
  builder.add(mesh);
  auto scene = std::make_shared<Scene>(std::move(builder).build());
  scene->origin = around.origin;
  add_listed(luminaires, *scene);
  return scene;
}

py::list lights_of_scene(const Scene& scene) {
  py::list list;
  for (const Light& light : scene.lights) {
    py::dict row;
    row["name"] = light.name;
    row["group"] = light.group;
    row["kind"] = std::string(name_of(light.kind));
    row["power"] = light.power;
    row["color"] = triple(light.color);
    row["position"] = triple(position_in_world(scene, glm::dvec3(light.position)));
    row["direction"] = triple(direction_in_world(scene, glm::dvec3(light.direction)));
    row["two_sided"] = light.two_sided;
    row["inner_angle"] = glm::degrees(light.inner_cone_angle);
    row["outer_angle"] = glm::degrees(light.outer_cone_angle);
    row["diameter"] = glm::degrees(light.angular_diameter);
    row["triangles"] = light.triangles;
    list.append(row);
  }
  return list;
}

py::list materials_of(const Scene& scene) {
  py::list list;
  for (const Material& material : scene.materials) {
    py::dict row;
    row["name"] = material.name;
    row["interaction"] = interactions[static_cast<std::size_t>(material.interaction)];
    row["diffuse"] = triple(material.diffuse);
    row["specular"] = triple(material.specular);
    row["roughness"] = material.roughness;
    row["transmission"] = triple(material.transmission);
    row["index_of_refraction"] = material.index_of_refraction;
    row["thin"] = material.thin;
    row["opacity"] = material.opacity;
    list.append(row);
  }
  return list;
}

/// Layers of the picture: names and powers.
py::list layers_of(const Scene& scene) {
  py::list list;
  for (const LightGroup& group : light_groups_of(scene).groups) {
    list.append(py::make_tuple(group.name, group.power));
  }
  return list;
}

/// Unit normals of the fronts of all triangles.
py::object triangle_normals(const Scene& scene) {
  std::vector<glm::vec3> normals(scene.triangle_count());
  {
    const Unlocked unlocked;
    for (std::uint32_t t = 0; t < normals.size(); ++t) {
      normals[t] = face_normal(scene, oriented(t, scene.front_side[t]));
    }
  }
  const auto count = static_cast<py::ssize_t>(normals.size());
  return taken<float>(std::move(normals), {count, 3});
}

py::object triangle_areas(const Scene& scene) {
  std::vector<double> areas(scene.triangle_count());
  for (std::uint32_t t = 0; t < areas.size(); ++t) areas[t] = triangle_area(scene, t);
  const auto count = static_cast<py::ssize_t>(areas.size());
  return taken<double>(std::move(areas), {count});
}

}  // namespace

Camera camera_of(const Scene& scene, const py::tuple& parts) {
  const auto name = value_of<std::string>(parts[0], "camera: name");
  const std::string of = "camera '" + name + "': ";
  const auto vector = [&](std::size_t part, const char* what) {
    return vec(value_of<Vector3>(parts[part], of + what));
  };
  const glm::dvec3 position = vector(1, "position"), forward = vector(2, "target");
  Camera camera =
      in_scene(scene, Camera::look_at(position, position + forward, vector(3, "up"),
                                      value_of<double>(parts[4], of + "field_of_view")));
  camera.name = name;
  camera.aspect_ratio = value_of<double>(parts[5], of + "aspect_ratio");
  if (!(camera.aspect_ratio >= 0) || !std::isfinite(camera.aspect_ratio)) {
    throw UsageError(of + "aspect_ratio: give width divided by height, or 0");
  }
  return camera;
}

void define_scenes(py::module_& module) {
  py::class_<Scene, SharedScene>(module, "Scene")
      .def_property_readonly("source", [](const Scene& s) { return s.source.string(); })
      .def_property_readonly(
          "unit", [](const Scene& s) { return s.unit == PowerUnit::lumen ? "lumen" : "watt"; })
      .def_property_readonly("origin", [](const Scene& s) { return triple(s.origin); })
      .def_property_readonly("warnings", [](const Scene& s) { return s.report.warnings; })
      .def_property_readonly("dropped_triangles",
                             [](const Scene& s) {
                               return s.report.degenerate_triangles +
                                      s.report.non_finite_triangles + s.report.duplicate_triangles;
                             })
      .def_property_readonly(
          "vertices",
          [](const py::object& o) { return view_rows<float>(o, o.cast<const Scene&>().vertices); })
      .def_property_readonly("triangles",
                             [](const py::object& o) {
                               return view_rows<std::uint32_t>(o, o.cast<const Scene&>().triangles);
                             })
      .def_property_readonly("triangle_material",
                             [](const py::object& o) {
                               return view_rows<std::uint32_t>(
                                   o, o.cast<const Scene&>().triangle_material);
                             })
      .def_property_readonly("triangle_light",
                             [](const py::object& o) {
                               return view_rows<std::uint32_t>(
                                   o, o.cast<const Scene&>().triangle_light);
                             })
      .def("triangle_normals", &triangle_normals)
      .def("triangle_areas", &triangle_areas)
      .def("lights", &lights_of_scene)
      .def("materials", &materials_of)
      .def("layers", &layers_of)
      .def("cameras", [](const Scene& s) {
        py::list list;
        for (const Camera& camera : s.cameras) list.append(tuple_of(in_world(s, camera)));
        return list;
      });
  module.def("load", &load);
  module.def("sky_of", &sky_of);
  module.def(
      "build", [](const py::object& name, const py::object& unit, Array<double> vertices,
                  Array<std::uint32_t> triangles, Array<float> normals, Array<float> uv,
                  Array<std::uint32_t> triangle_materials, Array<std::uint32_t> triangle_lights,
                  const py::list& materials, const py::list& lights, const py::list& cameras,
                  const py::object& luminaires) {
        return build(value_of<std::string>(name, "name"), value_of<std::string>(unit, "unit"),
                     {std::move(vertices), std::move(normals), std::move(uv), std::move(triangles),
                      std::move(triangle_materials), std::move(triangle_lights)},
                     materials, lights, cameras, value_of<std::string>(luminaires, "luminaires"));
      });
}

}  // namespace photile::python
