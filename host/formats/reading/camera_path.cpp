#include "reading/camera_path.hpp"

#include <fmt/format.h>

#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <string>
#include <vector>

#include "common/json_object.hpp"
#include "photile/errors.hpp"

namespace photile::reading {

namespace {

/// Velocity at a keyframe: that of the parabola's chord between its neighbours.
glm::dvec3 velocity(std::span<const double> times, std::span<const glm::dvec3> values,
                    std::size_t i) {
  if (i == 0 || i + 1 == times.size()) return glm::dvec3(0);
  return (values[i + 1] - values[i - 1]) / (times[i + 1] - times[i - 1]);
}

}  // namespace

Between between(std::span<const double> times, double time) {
  if (times.size() < 2 || !(time > times.front())) return {0, 0};
  if (time >= times.back()) return {times.size() - 2, 1};
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  const auto index = static_cast<std::size_t>(after - times.begin()) - 1;
  return {index, (time - times[index]) / (times[index + 1] - times[index])};
}

glm::dvec3 smooth(std::span<const double> times, std::span<const glm::dvec3> values, double time) {
  if (times.size() < 2) return values.front();
  const auto [i, share] = between(times, time);
  const double length = times[i + 1] - times[i];
  return hermite(values[i], length * velocity(times, values, i), values[i + 1],
                 length * velocity(times, values, i + 1), share);
}

glm::dvec3 linear(std::span<const double> times, std::span<const glm::dvec3> values, double time) {
  if (times.size() < 2) return values.front();
  const auto [i, share] = between(times, time);
  return glm::mix(values[i], values[i + 1], share);
}

namespace {

using nlohmann::json;

/// All keyframes, one array for each of their members.
struct Keyframes {
  std::vector<double> times;
  std::vector<glm::dvec3> positions;
  std::vector<glm::dvec3> targets;  ///< of all, or none
  std::vector<glm::dvec3> ups;
  std::vector<glm::dquat> orientations;
  std::vector<glm::dvec3> fields_of_view;  ///< radians, in x
  bool smooth = true;
};

glm::dquat orientation_of(const Camera& camera) {
  return glm::quat_cast(glm::dmat3(camera.right, camera.up, -camera.forward));
}

void add(const JsonObject& keyframe, const Camera& base, Keyframes& all) {
  const double time = keyframe.number("time", -1e9, 1e9);
  if (!all.times.empty() && !(time > all.times.back())) {
    keyframe.refuse("'time' is not after that of the keyframe before");
  }
  if (keyframe.has("look_at") == keyframe.has("direction")) {
    keyframe.refuse("needs either 'look_at' or 'direction'");
  }
  const glm::dvec3 position = keyframe.vector("position");
  const bool at_point = keyframe.has("look_at");
  const glm::dvec3 target =
      at_point ? keyframe.vector("look_at") : position + keyframe.vector("direction");
  if (target == position) keyframe.refuse("looks at its own position");
  const glm::dvec3 up = keyframe.has("up") ? keyframe.vector("up") : base.up;
  if (!(glm::length(up) > 0)) keyframe.refuse("'up' has no length");
  const double fov = keyframe.has("fov") ? glm::radians(keyframe.number("fov", 0.01, 179))
                                         : base.vertical_field_of_view;
  all.times.push_back(time);
  all.positions.push_back(position);
  if (at_point) all.targets.push_back(target);
  all.ups.push_back(up);
  all.orientations.push_back(orientation_of(Camera::look_at(position, target, up, fov)));
  all.fields_of_view.emplace_back(fov, 0, 0);
}

glm::dquat turned(const Keyframes& all, double time) {
  if (all.times.size() < 2) return all.orientations.front();
  const auto [i, share] = between(all.times, time);
  return glm::slerp(all.orientations[i], all.orientations[i + 1], share);
}

Camera camera_at(const Keyframes& all, const Camera& base, double time) {
  const auto value = [&](const std::vector<glm::dvec3>& values) {
    return all.smooth ? smooth(all.times, values, time) : linear(all.times, values, time);
  };
  const glm::dvec3 position = value(all.positions);
  const double fov = linear(all.times, all.fields_of_view, time).x;
  Camera camera;
  if (!all.targets.empty()) {
    camera = Camera::look_at(position, value(all.targets), linear(all.times, all.ups, time), fov);
  } else {
    const glm::dmat3 axes = glm::mat3_cast(turned(all, time));
    camera = Camera::look_at(position, position - axes[2], axes[1], fov);
  }
  camera.name = base.name;
  camera.aspect_ratio = base.aspect_ratio;
  return camera;
}

bool is_smooth(const json& content, const std::string& file) {
  if (!content.is_object() || !content.contains("interpolation")) return true;
  const json& word = content["interpolation"];
  if (word != "smooth" && word != "linear") {
    throw InputError(fmt::format("{}: 'interpolation' is neither \"smooth\" nor \"linear\"", file));
  }
  return word == "smooth";
}

}  // namespace

CameraMotion read_camera_path(const std::filesystem::path& file, const Camera& base) {
  const json content = read_input_json(file);
  const json list = content.is_object() ? content.value("keyframes", json()) : content;
  if (!list.is_array() || list.empty()) {
    throw InputError(
        fmt::format("{}: no keyframes; write a list of {{\"time\", \"position\", \"look_at\"}}",
                    file.string()));
  }
  auto all = std::make_shared<Keyframes>();
  all->smooth = is_smooth(content, file.string());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonObject keyframe(list[i], fmt::format("{}: keyframe {}", file.string(), i + 1),
                              {"time", "position", "look_at", "direction", "up", "fov"});
    add(keyframe, base, *all);
  }
  // Targets and directions do not mix: then all turn as orientations.
  if (all->targets.size() < all->times.size()) all->targets.clear();
  return {all->times.front(), all->times.back(),
          [all, base](double time) { return camera_at(*all, base, time); }};
}

}  // namespace photile::reading
