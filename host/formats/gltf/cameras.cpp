#include "gltf/cameras.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "gltf/accessor.hpp"
#include "gltf/document.hpp"
#include "scene/scene_queries.hpp"

namespace photile::gltf {

namespace {

bool has_orientation(const glm::dmat4& world) {
  const double area = glm::length(glm::cross(glm::dvec3(world[1]), glm::dvec3(world[2])));
  return std::isfinite(area) && area > 0.0 && scene::within_limit(glm::dvec3(world[3]));
}

/// The camera of a node, which looks along its -z.
Camera camera_at(const glm::dmat4& world, double field_of_view, const std::string& name,
                 double aspect_ratio) {
  const glm::dvec3 position(world[3]);
  Camera camera = Camera::look_at(position, position - glm::normalize(glm::dvec3(world[2])),
                                  glm::normalize(glm::dvec3(world[1])), field_of_view);
  camera.name = name;
  camera.aspect_ratio = aspect_ratio;
  return camera;
}

/// The name of a visited node's camera: that of the node, or its own where the node has none.
std::string name_of_camera(const tinygltf::Model& model, const NodeVisit& visit,
                           const tinygltf::Camera& camera) {
  const bool unnamed = visit.source->name.empty() && !camera.name.empty();
  return unnamed ? camera.name : node_name(model, visit.node);
}

void add_camera(const tinygltf::Camera& source, const std::string& name, const glm::dmat4& world,
                reading::ImportContext& context) {
  if (source.type != "perspective") {
    context.warnings.add("camera", name, "is not a perspective camera; skipped");
    return;
  }
  const double field_of_view = source.perspective.yfov;
  if (!(field_of_view > 0.0 && field_of_view < std::numbers::pi) || !has_orientation(world)) {
    context.warnings.add("camera", name, "has no usable field of view or orientation; skipped");
    return;
  }
  const double aspect = source.perspective.aspectRatio;
  context.scene.cameras.push_back(
      camera_at(world, field_of_view, name, std::isfinite(aspect) && aspect > 0.0 ? aspect : 0.0));
}

}  // namespace

void add_gltf_cameras(const tinygltf::Model& model, const std::vector<NodeVisit>& visits,
                      reading::ImportContext& context) {
  for (const NodeVisit& visit : visits) {
    if (visit.source->camera < 0) continue;
    const tinygltf::Camera* const camera = element(model.cameras, visit.source->camera);
    if (camera == nullptr) {
      throw context.error(fmt::format("node '{}': there is no camera {}; export the file again",
                                      node_name(model, visit.node), visit.source->camera));
    }
    add_camera(*camera, name_of_camera(model, visit, *camera), visit.world, context);
  }
}

namespace {

/// One animated property of a node.
struct Channel {
  int node = 0;
  std::string path;           ///< "translation", "rotation" or "scale"
  std::string interpolation;  ///< "STEP", "LINEAR" or "CUBICSPLINE"
  int components = 3;
  std::vector<double> times;  ///< seconds, ascending
  std::vector<float> values;  ///< per key; with CUBICSPLINE in-tangent, value, out-tangent

  glm::dvec4 element(std::size_t index) const {
    glm::dvec4 result(0);
    for (int i = 0; i < components; ++i) {
      result[i] = static_cast<double>(
          values[index * static_cast<std::size_t>(components) + static_cast<std::size_t>(i)]);
    }
    return result;
  }

  /// Value of a key.
  glm::dvec4 key(std::size_t index) const {
    return element(interpolation == "CUBICSPLINE" ? 3 * index + 1 : index);
  }

  glm::dvec4 at(double time) const {
    if (times.size() < 2) return key(0);
    const auto [i, share] = reading::between(times, time);
    if (interpolation == "STEP") return key(share < 1 ? i : i + 1);
    if (interpolation == "CUBICSPLINE") {
      const double length = times[i + 1] - times[i];
      return reading::hermite(element(3 * i + 1), length * element(3 * i + 2), element(3 * i + 4),
                              length * element(3 * i + 3), share);
    }
    if (path != "rotation") return glm::mix(key(i), key(i + 1), share);
    const glm::dvec4 a = key(i), b = key(i + 1);
    const glm::dquat turned =
        glm::slerp(glm::dquat(a.w, a.x, a.y, a.z), glm::dquat(b.w, b.x, b.y, b.z), share);
    return {turned.x, turned.y, turned.z, turned.w};
  }
};

int components_of(const std::string& path) { return path == "rotation" ? 4 : 3; }

/// The nodes from a root down to one.
std::vector<int> chain_to(const tinygltf::Model& model, int node) {
  std::map<int, int> parent;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    for (const int child : model.nodes[i].children) parent.emplace(child, static_cast<int>(i));
  }
  std::vector<int> chain{node};
  // visit_nodes has refused cycles.
  for (auto above = parent.find(node); above != parent.end(); above = parent.find(above->second)) {
    chain.push_back(above->second);
  }
  std::reverse(chain.begin(), chain.end());
  return chain;
}

/// The node of a camera, by the names that add_gltf_cameras gives.
std::optional<int> camera_node(const tinygltf::Model& model, const std::vector<NodeVisit>& visits,
                               const std::string& name) {
  for (const NodeVisit& visit : visits) {
    const tinygltf::Camera* const camera = element(model.cameras, visit.source->camera);
    if (camera && name_of_camera(model, visit, *camera) == name) return visit.node;
  }
  return std::nullopt;
}

class AnimationReader {
 public:
  AnimationReader(const tinygltf::Model& model, const reading::ImportContext& context)
      : model_(model), context_(context), accessors_(model, context) {}

  /// The channels of an animation that move nodes of the chain.
  std::vector<Channel> channels(const tinygltf::Animation& animation,
                                const std::vector<int>& chain) const {
    std::vector<Channel> result;
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      if (std::find(chain.begin(), chain.end(), channel.target_node) == chain.end()) continue;
      const std::string& path = channel.target_path;
      if (path != "translation" && path != "rotation" && path != "scale") continue;
      result.push_back(read(animation, channel));
    }
    return result;
  }

 private:
  Channel read(const tinygltf::Animation& animation,
               const tinygltf::AnimationChannel& source) const {
    const std::string use = fmt::format("{} of animation '{}'", source.target_path, animation.name);
    const tinygltf::AnimationSampler* const sampler = element(animation.samplers, source.sampler);
    if (sampler == nullptr) {
      throw context_.error(
          fmt::format("{}: there is no sampler {}; export the file again", use, source.sampler));
    }
    Channel channel{source.target_node,
                    source.target_path,
                    sampler->interpolation,
                    components_of(source.target_path),
                    {},
                    {}};
    if (channel.interpolation.empty()) channel.interpolation = "LINEAR";
    const std::vector<float> times = accessors_.floats(sampler->input, 1, "times of " + use);
    channel.times.assign(times.begin(), times.end());
    channel.values = accessors_.floats(sampler->output, channel.components, use);
    const std::size_t per_key = channel.interpolation == "CUBICSPLINE" ? 3 : 1;
    const bool ascending = std::adjacent_find(channel.times.begin(), channel.times.end(),
                                              std::greater_equal<>()) == channel.times.end();
    if (channel.times.empty() || !ascending ||
        channel.values.size() !=
            per_key * channel.times.size() * static_cast<std::size_t>(channel.components)) {
      throw context_.error(
          fmt::format("{}: the times do not ascend, or do not match the number of values; export "
                      "the file again",
                      use));
    }
    const auto finite = [](auto value) { return std::isfinite(value); };
    if (!std::all_of(channel.times.begin(), channel.times.end(), finite) ||
        !std::all_of(channel.values.begin(), channel.values.end(), finite)) {
      throw context_.error(
          fmt::format("{}: has NaN or infinite values; export the file again", use));
    }
    return channel;
  }

  const tinygltf::Model& model_;
  const reading::ImportContext& context_;
  AccessorReader accessors_;
};

/// The nodes of the chain, with what moves them.
struct AnimatedChain {
  std::vector<tinygltf::Node> nodes;
  std::vector<int> numbers;  ///< in the file
  std::vector<Channel> channels;
  double metres_per_unit;

  glm::dmat4 world(double time) const {
    glm::dmat4 result = glm::scale(glm::dmat4(1.0), glm::dvec3(metres_per_unit));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      tinygltf::Node moved = nodes[i];
      for (const Channel& channel : channels) {
        if (channel.node != numbers[i]) continue;
        const glm::dvec4 v = channel.at(time);
        std::vector<double>& property = channel.path == "translation" ? moved.translation
                                        : channel.path == "rotation"  ? moved.rotation
                                                                      : moved.scale;
        property.assign(&v[0], &v[0] + channel.components);
        moved.matrix.clear();  // the specification forbids it on animated nodes
      }
      result *= local_transform(moved);
    }
    return result;
  }
};

reading::CameraMotion motion_of(AnimatedChain chain, const Camera& base) {
  double begin = HUGE_VAL, end = -HUGE_VAL;
  for (const Channel& channel : chain.channels) {
    begin = std::min(begin, channel.times.front());
    end = std::max(end, channel.times.back());
  }
  auto shared = std::make_shared<const AnimatedChain>(std::move(chain));
  return {begin, end, [shared, base](double time) {
            return camera_at(shared->world(time), base.vertical_field_of_view, base.name,
                             base.aspect_ratio);
          }};
}

bool is_chosen(const tinygltf::Animation& animation, std::size_t index,
               const std::string& selector) {
  return selector.empty() || animation.name == selector || std::to_string(index) == selector;
}

}  // namespace

reading::CameraMotion read_camera_animation(const std::filesystem::path& file,
                                            const SceneLoadOptions& options, const Camera& camera,
                                            const std::string& animation) {
  Scene scene;
  scene.source = file;
  files::SceneFolder folder(file, options.allow_outside);
  files::Warnings warnings;
  reading::AreaLights area_lights(scene);
  reading::ImportContext context{scene, folder, options, warnings, area_lights, {}};
  if (file.extension() != ".gltf" && file.extension() != ".glb") {
    throw context.error("only glTF files have animations; describe the path in a JSON file");
  }
  try {
    const tinygltf::Model model = read_gltf(context);
    const auto node = camera_node(model, visit_nodes(model, context), camera.name);
    if (!node) {
      throw context.error(fmt::format("camera '{}' is not a node of the file", camera.name));
    }
    AnimatedChain chain;
    chain.metres_per_unit = options.metres_per_unit;
    chain.numbers = chain_to(model, *node);
    for (const int number : chain.numbers) {
      chain.nodes.push_back(model.nodes[static_cast<std::size_t>(number)]);
    }
    const AnimationReader reader(model, context);
    for (std::size_t i = 0; i < model.animations.size() && chain.channels.empty(); ++i) {
      if (!is_chosen(model.animations[i], i, animation)) continue;
      chain.channels = reader.channels(model.animations[i], chain.numbers);
    }
    if (chain.channels.empty()) {
      throw context.error(
          fmt::format("no animation {}moves camera '{}'; describe the path in a JSON file",
                      animation.empty() ? "" : "'" + animation + "' ", camera.name));
    }
    return motion_of(std::move(chain), camera);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw context.error(fmt::format("malformed file ({}); export the file again", error.what()));
  }
}

}  // namespace photile::gltf
