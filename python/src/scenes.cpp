// Scenes: from files, and from arrays by SceneBuilder.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <optional>

#include "arrays.hpp"
#include "parts.hpp"
#include "photile/light_layers.hpp"
#include "photile/scene.hpp"
#include "photile/scene_builder.hpp"
#include "work.hpp"

namespace photile::python {
namespace {

using SharedScene = std::shared_ptr<Scene>;
using Vector3 = std::array<double, 3>;

glm::dvec3 vec(const Vector3& v) { return {v[0], v[1], v[2]}; }
template <class V>
py::tuple triple(const V& v) {
  return py::make_tuple(v.x, v.y, v.z);
}

constexpr std::array interactions{"opaque", "mirror", "glass"};
constexpr std::array light_kinds{"area", "point", "spot", "directional", "environment"};

template <class E, std::size_t n>
E word(const std::array<const char*, n>& words, const std::string& found, const char* what) {
  std::string all;
  for (std::size_t i = 0; i < n; ++i) {
    if (found == words[i]) return static_cast<E>(i);
    all += (i > 0 ? ", " : "") + std::string(words[i]);
  }
  throw UsageError(std::string(what) + ": '" + found + "' is not one of " + all);
}

/// An array of shape (height, width, 3 or 4), 8 bits each.
Texture texture_of(const std::string& name, const Array<std::uint8_t>& texels) {
  if (texels.ndim() != 3 || (texels.shape(2) != 3 && texels.shape(2) != 4) || texels.size() == 0) {
    throw InputError("texture of material '" + name + "': the array has shape " +
                     shape_text(texels) + ", and has to have (height, width, 3 or 4)");
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
  material.name = fields["name"].cast<std::string>();
  material.interaction = word<Interaction>(interactions, fields["interaction"].cast<std::string>(),
                                           "interaction of a material");
  material.diffuse = vec(fields["diffuse"].cast<Vector3>());
  material.specular = vec(fields["specular"].cast<Vector3>());
  material.roughness = fields["roughness"].cast<float>();
  material.transmission = vec(fields["transmission"].cast<Vector3>());
  material.index_of_refraction = fields["index_of_refraction"].cast<float>();
  material.thin = fields["thin"].cast<bool>();
  material.opacity = fields["opacity"].cast<float>();
  if (!fields["texture"].is_none()) {
    material.diffuse_texture =
        builder.add(texture_of(material.name, fields["texture"].cast<Array<std::uint8_t>>()));
  }
  return material;
}

/// An array of shape (height, width, 3): light from all around.
EnvironmentMap surroundings_of(const std::string& name, const Array<float>& texels) {
  if (texels.ndim() != 3 || texels.shape(2) != 3 || texels.size() == 0) {
    throw InputError("environment '" + name + "': the array has shape " + shape_text(texels) +
                     ", and has to have (height, width, 3)");
  }
  const auto* const rows = reinterpret_cast<const glm::vec3*>(texels.data());
  const auto pixels = static_cast<std::size_t>(texels.shape(0) * texels.shape(1));
  return {name,
          static_cast<int>(texels.shape(1)),
          static_cast<int>(texels.shape(0)),
          {rows, rows + pixels}};
}

/// By the fields of photile.Light. Returns its number.
std::uint32_t add_light(SceneBuilder& builder, const py::dict& fields) {
  Light light;
  light.name = fields["name"].cast<std::string>();
  light.group = fields["group"].cast<std::string>();
  light.kind = word<LightKind>(light_kinds, fields["kind"].cast<std::string>(), "kind of a light");
  light.power = fields["power"].cast<double>();
  light.color = vec(fields["color"].cast<Vector3>());
  light.position = vec(fields["position"].cast<Vector3>());
  light.direction = vec(fields["direction"].cast<Vector3>());
  light.two_sided = fields["two_sided"].cast<bool>();
  light.inner_cone_angle = glm::radians(fields["inner_angle"].cast<float>());
  light.outer_cone_angle = glm::radians(fields["outer_angle"].cast<float>());
  light.angular_diameter = glm::radians(fields["diameter"].cast<float>());
  if (light.kind == LightKind::environment) {
    if (fields["texels"].is_none()) {
      throw InputError("light '" + light.name + "': an environment needs texels");
    }
    return builder.add_surroundings(
        light.name, surroundings_of(light.name, fields["texels"].cast<Array<float>>()));
  }
  if (light.kind == LightKind::directional) {
    return builder.add_distant(light, fields["illuminance"].cast<double>());
  }
  return builder.add(std::move(light));
}

py::tuple tuple_of(const Camera& camera) {
  return py::make_tuple(camera.name, triple(camera.position), triple(camera.forward),
                        triple(camera.up), camera.vertical_field_of_view, camera.aspect_ratio);
}

SharedScene load(const std::filesystem::path& file, const py::dict& options,
                 const py::object& progress) {
  SceneLoadOptions load;
  load.emissive_scale = options["emissive_scale"].cast<float>();
  load.allow_outside = options["allow_outside"].cast<bool>();
  load.scene = options["scene"].cast<std::string>();
  load.up = options["up"].cast<std::string>();
  load.lumen_per_watt = options["lumen_per_watt"].cast<double>();
  const auto texts = [&](const char* name) {
    return options[name].cast<std::vector<std::string>>();
  };
  for (const auto& text : texts("light_groups"))
    load.light_groups.push_back(LightGrouping::parse(text));
  for (const auto& text : texts("profiles")) load.profiles.push_back(LightProfile::parse(text));
  for (const auto& text : texts("temperatures")) {
    load.temperatures.push_back(LightTemperature::parse(text));
  }
  for (const auto& text : texts("panels")) load.panels.push_back(LuminousPanel::parse(text));
  if (const auto picture = options["environment"].cast<std::string>(); !picture.empty()) {
    load.environment = {picture, options["environment_scale"].cast<double>(),
                        options["environment_rotation"].cast<double>()};
  }
  if (const auto text = options["sun"].cast<std::string>(); !text.empty())
    load.sun = Sun::parse(text);
  if (const auto text = options["sky"].cast<std::string>(); !text.empty())
    load.sky = Sky::parse(text);
  return run(progress, [&](Progress&) { return std::make_shared<Scene>(load_scene(file, load)); });
}

struct Arrays {
  Array<float> vertices, normals, uv;
  Array<std::uint32_t> triangles, materials, lights;
};

SharedScene build(const std::string& name, const std::string& unit, const Arrays& arrays,
                  const py::list& materials, const py::list& lights, const py::list& cameras) {
  constexpr std::array units{"lumen", "watt"};
  SceneBuilder builder(name, word<PowerUnit>(units, unit, "unit"));
  for (const py::handle& fields : materials) {
    builder.add(material_of(builder, fields.cast<py::dict>()));
  }
  for (const py::handle& fields : lights) add_light(builder, fields.cast<py::dict>());
  for (const py::handle& parts : cameras) {
    Scene at_origin;
    builder.add(camera_of(at_origin, parts.cast<py::tuple>()));
  }
  const MeshArrays mesh{.vertices = rows_of<glm::vec3>(arrays.vertices, "vertices"),
                        .triangles = rows_of<glm::uvec3>(arrays.triangles, "triangles"),
                        .normals = rows_of<glm::vec3>(arrays.normals, "normals"),
                        .uv = rows_of<glm::vec2>(arrays.uv, "uv"),
                        .materials = values_of(arrays.materials, "triangle_materials"),
                        .lights = values_of(arrays.lights, "triangles of lights")};
  const py::gil_scoped_release release;
  builder.add(mesh);
  return std::make_shared<Scene>(std::move(builder).build());
}

py::list lights_of_scene(const Scene& scene) {
  py::list list;
  for (const Light& light : scene.lights) {
    py::dict row;
    row["name"] = light.name;
    row["group"] = light.group;
    row["kind"] = light_kinds[static_cast<std::size_t>(light.kind)];
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
    const py::gil_scoped_release release;
    for (std::uint32_t t = 0; t < normals.size(); ++t) {
      normals[t] = sided_normal(scene, sided(t, scene.front_side[t]));
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
  const glm::dvec3 position = vec(parts[1].cast<Vector3>());
  const glm::dvec3 forward = vec(parts[2].cast<Vector3>());
  Camera camera =
      in_scene(scene, Camera::look_at(position, position + forward, vec(parts[3].cast<Vector3>()),
                                      parts[4].cast<double>()));
  camera.name = parts[0].cast<std::string>();
  camera.aspect_ratio = parts[5].cast<double>();
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
  module.def(
      "build", [](const std::string& name, const std::string& unit, Array<float> vertices,
                  Array<std::uint32_t> triangles, Array<float> normals, Array<float> uv,
                  Array<std::uint32_t> triangle_materials, Array<std::uint32_t> triangle_lights,
                  const py::list& materials, const py::list& lights, const py::list& cameras) {
        return build(name, unit,
                     {std::move(vertices), std::move(normals), std::move(uv), std::move(triangles),
                      std::move(triangle_materials), std::move(triangle_lights)},
                     materials, lights, cameras);
      });
}

}  // namespace photile::python
