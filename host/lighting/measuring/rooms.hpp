// The rooms of a scene, by name.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "photile/scene.hpp"

namespace photile::measuring {

struct NamedRoom {
  std::string name;
  glm::dvec3 inside{0.0};  ///< a point in it, metres in the file's world
  /// Its entry in the NAME.rooms.json of `photile import`. Of a room that was found: name; area, m2
  /// of its plan, with what lies under slopes; height, metres to most of its ceiling; floor, its
  /// height in the file's world; sides, metres of the upright rectangle around its plan; inside;
  /// outline and holes, the corners of its floor.
  nlohmann::json facts;
};

/// The room around `inside`, or the first camera's, without a name; none where the scene has no
/// such room. Errors: UsageError where the point is in none.
std::optional<NamedRoom> room_at(const Scene& scene, const std::optional<glm::dvec3>& inside);

/// Those that such a file beside the scene lists. Where there is none, those that the first 16
/// cameras see, and others with walls all around, each once, 100 at most: "room 1", "room 2" and so
/// on. Errors: InputError naming the file and what is wrong in it.
std::vector<NamedRoom> rooms_of(const Scene& scene);

/// Those whose names match a glob. Errors: UsageError with the names that there are.
std::vector<NamedRoom> rooms_named(const Scene& scene, const std::string& glob);

}  // namespace photile::measuring
