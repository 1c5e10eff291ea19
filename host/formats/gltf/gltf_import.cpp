#include "gltf/gltf_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "files/scene_files.hpp"
#include "gltf/cameras.hpp"
#include "gltf/document.hpp"
#include "gltf/lights.hpp"
#include "gltf/materials.hpp"
#include "gltf/meshes.hpp"
#include "photile/limits.hpp"
#include "pictures/textures.hpp"
#include "reading/triangles.hpp"
#include "scene/light_emission.hpp"

namespace photile::gltf {

namespace {

/// A triangle takes three indices at least, of a byte each.
constexpr std::uint64_t least_bytes_per_triangle = 3;

/// Beyond any limit, and small enough to be added and multiplied by any number of visits.
constexpr std::uint64_t too_many = 3 * limits::max_triangles;

/// The triangles of a primitive, and at least as many as the work on its vertices corresponds to: a
/// mesh may have vertices that no triangle uses, and primitives without triangles take time, too.
std::uint64_t cost_of(const tinygltf::Primitive& primitive, std::uint64_t buffer_bytes,
                      const std::string& use, const AccessorReader& accessors) {
  if (!is_usable(primitive, use, accessors)) return 1;
  // Accessors of more elements are refused, by what they ask for, when they are read.
  const std::uint64_t vertices = std::min(accessors.count(attribute(primitive, "POSITION"), use),
                                          limits::max_implicit_elements + buffer_bytes);
  const std::uint64_t corners =
      primitive.indices >= 0 ? accessors.count(primitive.indices, use) : vertices;
  const std::uint64_t per_triangle = primitive.mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
  return std::clamp<std::uint64_t>(std::max(corners / per_triangle, vertices / 3), 1, too_many);
}

std::uint64_t cost_of_mesh(const tinygltf::Model& model, int mesh, std::uint64_t buffer_bytes,
                           const AccessorReader& accessors) {
  const std::string use = fmt::format("mesh '{}'", name_of_mesh(model, mesh));
  std::uint64_t cost = 0;
  for (const tinygltf::Primitive& primitive :
       model.meshes[static_cast<std::size_t>(mesh)].primitives) {
    cost = std::min(cost + cost_of(primitive, buffer_bytes, use, accessors), too_many);
  }
  return cost;
}

}  // namespace

void check_scene_size(const tinygltf::Model& model, const AccessorReader& accessors,
                      const std::vector<NodeVisit>& visits, const reading::ImportContext& context) {
  std::vector<std::uint64_t> places(model.meshes.size(), 0);
  for (const NodeVisit& visit : visits) {
    const int mesh = visit.source->mesh;
    if (element(model.meshes, mesh)) ++places[static_cast<std::size_t>(mesh)];
  }
  std::uint64_t buffer_bytes = 0;
  for (const tinygltf::Buffer& buffer : model.buffers) buffer_bytes += buffer.data.size();
  std::uint64_t triangles = 0, most = 0;
  int largest = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] == 0) continue;
    const auto mesh = static_cast<int>(i);
    const std::uint64_t placed = places[i] * cost_of_mesh(model, mesh, buffer_bytes, accessors);
    triangles += placed;
    if (placed > most) {
      most = placed;
      largest = mesh;
    }
  }
  if (triangles > limits::max_triangles) {
    throw context.error(
        fmt::format("the scene has {} triangles, {} of them in {} instances of mesh '{}'; the "
                    "limit is {}; split the scene",
                    triangles, most, places[static_cast<std::size_t>(largest)],
                    name_of_mesh(model, largest), limits::max_triangles));
  }
  const std::uint64_t held = packed_bytes(model) / least_bytes_per_triangle + model.nodes.size();
  const std::uint64_t most_placed =
      std::max(limits::unchecked_triangles, held * limits::max_triangle_expansion);
  if (triangles > most_placed) {
    throw context.error(
        fmt::format("the scene has {} triangles, from a file of at most {}; the limit for such a "
                    "file is {}; use fewer instances: {} are of mesh '{}', in {} instances",
                    triangles, held, most_placed, most, name_of_mesh(model, largest),
                    places[static_cast<std::size_t>(largest)]));
  }
}

namespace {

void add_triangles(const reading::LocalMesh& local, const glm::dmat4& world,
                   reading::SceneOrigin& origin) {
  for (const glm::uvec3& triangle : local.triangles) {
    std::array<glm::dvec3, 3> corners;
    for (int c = 0; c < 3; ++c) {
      corners[static_cast<std::size_t>(c)] =
          glm::dvec3(world * glm::dvec4(local.positions[triangle[c]], 1.0));
    }
    origin.add(corners);
  }
}

/// Chooses Scene::origin (reading/triangles.hpp) and moves the visited nodes there, with all that
/// hangs on them: meshes, cameras, lights. Reads every mesh once more. Errors: InputError.
void move_to_origin(const tinygltf::Model& model, const AccessorReader& accessors,
                    std::vector<NodeVisit>& visits, reading::ImportContext& context) {
  std::map<int, std::vector<const NodeVisit*>> visits_of;  // each mesh is read once
  for (const NodeVisit& visit : visits) {
    const int mesh = visit.source->mesh;
    if (element(model.meshes, mesh)) visits_of[mesh].push_back(&visit);
  }
  reading::SceneOrigin origin;
  for (const auto& [mesh, places] : visits_of) {
    const reading::LocalMesh local = read_local_mesh(model, mesh, accessors, context);
    for (const NodeVisit* visit : places) add_triangles(local, visit->world, origin);
  }
  context.scene.origin = origin.best();
  for (NodeVisit& visit : visits) visit.world[3] -= glm::dvec4(context.scene.origin, 0.0);
}

constexpr const char* extension_name = "EXT_lights_image_based";

constexpr double largest_rgbd = 255;

/// The definition of the light that the scene names, or nullptr.
const tinygltf::Value* light_of_scene(const tinygltf::Model& model,
                                      const reading::ImportContext& context) {
  const std::optional<std::size_t> scene = scene_number(model, context);
  if (!scene) return nullptr;
  const tinygltf::Value* reference =
      find_extension(model.scenes[*scene].extensions, extension_name);
  if (reference == nullptr) return nullptr;
  const int number = integer_member(*reference, "light", -1);
  const tinygltf::Value* const light = light_of_extension(model, extension_name, number);
  if (light == nullptr) {
    throw context.error(fmt::format("scene {}: there is no light {} of {}; export the file again",
                                    *scene, number, extension_name));
  }
  return light;
}

glm::dquat rotation_of(const tinygltf::Value& light) {
  const tinygltf::Value& values = light.Has("rotation") ? light.Get("rotation") : tinygltf::Value();
  if (values.ArrayLen() != 4) return {1.0, 0.0, 0.0, 0.0};
  std::array<double, 4> xyzw{};
  for (int i = 0; i < 4; ++i) {
    xyzw[static_cast<std::size_t>(i)] =
        values.Get(i).IsNumber() ? values.Get(i).GetNumberAsDouble() : 0.0;
  }
  const glm::dquat rotation(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);  // glTF puts w last, GLM first
  const double length = glm::length(rotation);
  if (!std::isfinite(length) || !(length > 0.0)) return {1.0, 0.0, 0.0, 0.0};
  return rotation / length;
}

/// Errors: ResourceError.
pictures::CubeMap cube_of(const tinygltf::Value& light, const tinygltf::Model& model,
                          const AccessorReader& accessors, files::SceneFolder& folder) {
  const bool has_levels = light.Has("specularImages") && light.Get("specularImages").ArrayLen() > 0;
  const tinygltf::Value faces = has_levels ? light.Get("specularImages").Get(0) : tinygltf::Value();
  pictures::CubeMap cube;
  if (faces.ArrayLen() != cube.size()) {
    throw files::ResourceError("its specularImages do not have six faces for each size");
  }
  std::array<double, 6> numbers{};
  for (std::size_t i = 0; i < cube.size(); ++i) {
    const tinygltf::Value& image = faces.Get(static_cast<int>(i));
    const double number = image.IsNumber() ? image.GetNumberAsDouble() : -1.0;
    if (!(number >= 0.0 && number < static_cast<double>(model.images.size()))) {
      throw files::ResourceError(fmt::format("there is no image {}", number));
    }
    numbers[i] = number;
    const auto first = static_cast<std::size_t>(std::find(numbers.begin(), numbers.end(), number) -
                                                numbers.begin());
    cube[i] = first < i ? cube[first]
                        : rgbd_picture(model, static_cast<std::size_t>(number), accessors, folder);
    if (cube[i].width > limits::max_cube_map_side) {
      throw files::ResourceError(fmt::format("a face is {} texels wide; the limit is {}",
                                             cube[i].width, limits::max_cube_map_side));
    }
    if (cube[i].width != cube[0].width || cube[i].height != cube[0].width) {
      throw files::ResourceError(
          fmt::format("its faces are not squares of one size: {} x {}, {} x {}", cube[0].width,
                      cube[0].height, cube[i].width, cube[i].height));
    }
  }
  return cube;
}

void add_light(const tinygltf::Value& light, const tinygltf::Model& model,
               const AccessorReader& accessors, reading::ImportContext& context) {
  const double intensity = number_member(light, "intensity", 1.0);
  if (!(intensity > 0.0) || !std::isfinite(static_cast<float>(largest_rgbd * intensity))) {
    throw files::ResourceError(fmt::format("its intensity of {} is not usable", intensity));
  }
  pictures::CubeMap cube = cube_of(light, model, accessors, context.folder);
  for (pictures::RadiancePicture& face : cube) {
    for (glm::vec3& texel : face.texels) texel *= static_cast<float>(intensity);
  }
  EnvironmentMap map = pictures::environment_of(
      cube, glm::quat_cast(context.scene.turn) * rotation_of(light), extension_name);
  if (!(luminance(map.integral()) > 0.0)) throw files::ResourceError("it is black");
  const std::string name = string_member(light, "name");
  scene::add_environment_light(name.empty() ? "environment" : name, std::move(map), context.scene);
  context.light_sources.push_back({reading::LightSource::Kind::picture, none, none});
}

/// Adds the environment light of the scene that is loaded, if it has one; triangles must be there.
/// The sharpest of its cube maps is what surrounds the scene: the others, and the coefficients of
/// irradiance, are the same light blurred for programs that do not trace it. Its values times
/// `intensity` are taken as cd/m2; PNGs with alpha are RGBD, linear value = sRGB-decoded RGB /
/// alpha. Surroundings that cannot be read are named in a warning. Errors: InputError where there
/// is no such light.
void add_gltf_surroundings(const tinygltf::Model& model, const AccessorReader& accessors,
                           reading::ImportContext& context) {
  const tinygltf::Value* light = light_of_scene(model, context);
  if (light == nullptr || context.scene.triangles.empty()) return;
  try {
    add_light(*light, model, accessors, context);
  } catch (const files::ResourceError& error) {
    context.warnings.add(
        fmt::format("{}: {}; the surroundings are black; give them by --environment",
                    extension_name, error.what()));
  }
}

}  // namespace

void import_gltf(reading::ImportContext& context) {
  const tinygltf::Model model = read_gltf(context);
  const AccessorReader accessors(model, context);
  context.scene.unit = PowerUnit::lumen;
  const std::vector<MaterialCoordinates> coordinates =
      add_gltf_materials(model, accessors, context);
  std::vector<NodeVisit> visits = visit_nodes(model, context);
  context.check_hidden();
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
