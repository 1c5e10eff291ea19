#include "reading/camera_path.hpp"

#include <fmt/format.h>

#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "common/ascii_text.hpp"
#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "common/json_object.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile::reading {

namespace {

/// Velocity at a keyframe: that of the parabola's chord between its neighbours.
glm::dvec3 velocity(std::span<const double> times, std::span<const glm::dvec3> values,
                    std::size_t i) {
  if (i == 0 || i + 1 == times.size()) return glm::dvec3(0);
  return (values[i + 1] - values[i - 1]) / (times[i + 1] - times[i - 1]);
}

}  // namespace

Camera read_radiance_view(const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& reason) {
    throw InputError(
        fmt::format("{}: {}; give a view as Radiance's rvu and rpict write it, such as "
                    "-vtv -vp 1 2 1.6 -vd 0 1 0 -vu 0 0 1 -vh 60 -vv 40",
                    file.string(), reason));
  };
  std::string view;
  const std::string text = read_input_text(file);
  for (const std::string_view line : lines_of(text)) {
    if (const std::size_t at = fmt::format(" {}", line).find(" -v"); at != std::string::npos) {
      view = line.substr(at);
    }
  }
  if (view.empty()) refuse("the file holds no view");
  std::istringstream words(view);
  Camera camera;
  camera.name = file.filename().string();
  char type = 'v';
  double across = 45, high = 45;
  glm::dvec3 direction(0, 1, 0), up(0, 0, 1);
  for (std::string word; words >> word;) {
    const auto number = [&] {
      std::string next;
      words >> next;
      const auto value = parse_signed(next);
      if (!value || std::abs(*value) > limits::max_coordinate) {
        refuse(word + " needs a number");
      }
      return *value;
    };
    const auto vector = [&] {
      const double x = number(), y = number(), z = number();
      return glm::dvec3(x, y, z);
    };
    if (word.size() == 4 && word.starts_with("-vt")) {
      type = word[3];
    } else if (word == "-vp") {
      camera.position = vector();
    } else if (word == "-vd") {
      direction = vector();
    } else if (word == "-vu") {
      up = vector();
    } else if (word == "-vh") {
      across = number();
    } else if (word == "-vv") {
      high = number();
    } else if (word == "-vs" || word == "-vl" || word == "-vo" || word == "-va") {
      if (number() != 0) refuse(word + ": shifted and clipped views are not supported");
    } else {
      refuse(shortened(word, 20) + " is not an option of a view");
    }
  }
  if (!(glm::length(direction) > 0) || !(glm::length(glm::cross(direction, up)) > 0)) {
    refuse("-vd and -vu are parallel or zero");
  }
  const double most = type == 'v' ? 179 : type == 'h' ? 180 : type == 'a' ? 360 : 1e9;
  if (!(across > 0 && high > 0 && across <= most && high <= most)) {
    refuse(
        fmt::format("-vh {:g} and -vv {:g} must be above 0 and at most {:g}", across, high, most));
  }
  const double half_across = glm::radians(across / 2), half_high = glm::radians(high / 2);
  const std::string name = camera.name;
  camera = Camera::look_at(camera.position, camera.position + glm::normalize(direction), up,
                           glm::radians(std::min(high, 360.0)));
  camera.name = name;
  camera.aspect_ratio = across / high;
  switch (type) {
    case 'v':
      camera.aspect_ratio = std::tan(half_across) / std::tan(half_high);
      break;
    case 'h':
      camera.projection = Projection::fisheye;
      camera.aspect_ratio = std::sin(half_across) / std::sin(half_high);
      break;
    case 'a':
      camera.projection = Projection::angular;
      break;
    case 'l':
      camera.projection = Projection::orthographic;
      camera.orthographic_height = high;
      break;
    default:
      refuse(fmt::format("-vt{} is not a view type; use -vtv, -vth, -vta or -vtl", type));
  }
  return camera;
}

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
    keyframe.refuse("'time' must be later than that of the previous keyframe");
  }
  if (keyframe.has("look_at") == keyframe.has("direction")) {
    keyframe.refuse("give either 'look_at' or 'direction'");
  }
  const glm::dvec3 position = keyframe.vector("position");
  const bool at_point = keyframe.has("look_at");
  const glm::dvec3 target =
      at_point ? keyframe.vector("look_at") : position + keyframe.vector("direction");
  if (target == position)
    keyframe.refuse("'look_at' is the camera's own position; give another point");
  const glm::dvec3 up = keyframe.has("up") ? keyframe.vector("up") : base.up;
  if (!(glm::length(up) > 0)) keyframe.refuse("'up' has length 0");
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
    throw InputError(fmt::format("{}: 'interpolation' must be \"smooth\" or \"linear\"", file));
  }
  return word == "smooth";
}

}  // namespace

CameraMotion read_camera_path(const std::filesystem::path& file, const Camera& base) {
  const json content = read_input_json(file);
  const json list = content.is_object() ? content.value("keyframes", json()) : content;
  if (!list.is_array() || list.empty()) {
    throw InputError(fmt::format(
        "{}: there are no keyframes; write a list of {{\"time\", \"position\", \"look_at\"}}",
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
