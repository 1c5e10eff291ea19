#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "files/warnings.hpp"
#include "gltf/document.hpp"
#include "gltf/nodes.hpp"
#include "gltf/pictures.hpp"
#include "gltf/steps.hpp"
#include "photile/limits.hpp"
#include "pictures/cube_map.hpp"
#include "scene/light_emission.hpp"

namespace photile::gltf {
namespace {

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
  const tinygltf::Value* extension = find_extension(model.extensions, extension_name);
  const int light = integer_member(*reference, "light", -1);
  const std::size_t count =
      extension != nullptr && extension->Has("lights") ? extension->Get("lights").ArrayLen() : 0;
  if (light < 0 || static_cast<std::size_t>(light) >= count) {
    throw context.error(fmt::format("scene {}: there is no light {} of {}; export it again", *scene,
                                    light, extension_name));
  }
  return &extension->Get("lights").Get(light);
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
    throw files::ResourceError("its specularImages are not six for each size");
  }
  for (std::size_t i = 0; i < cube.size(); ++i) {
    const tinygltf::Value& image = faces.Get(static_cast<int>(i));
    const double number = image.IsNumber() ? image.GetNumberAsDouble() : -1.0;
    if (!(number >= 0.0 && number < static_cast<double>(model.images.size()))) {
      throw files::ResourceError(fmt::format("there is no image {}", number));
    }
    cube[i] = rgbd_picture(model, static_cast<std::size_t>(number), accessors, folder);
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
    throw files::ResourceError(fmt::format("its intensity is {}", intensity));
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

}  // namespace

void add_gltf_surroundings(const tinygltf::Model& model, const AccessorReader& accessors,
                           reading::ImportContext& context) {
  const tinygltf::Value* light = light_of_scene(model, context);
  if (light == nullptr || context.scene.triangles.empty()) return;
  try {
    add_light(*light, model, accessors, context);
  } catch (const files::ResourceError& error) {
    context.warnings.add(
        fmt::format("{}: {}; the surroundings are dark; give them as an environment picture",
                    extension_name, error.what()));
  }
}

}  // namespace photile::gltf
