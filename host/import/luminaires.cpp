#include "import/luminaires.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "common/json_object.hpp"
#include "import/gltf/panels.hpp"
#include "import/photometry/photometric_file.hpp"
#include "import/scene_folder.hpp"
#include "measuring/room.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "scene/default_camera.hpp"
#include "scene/light_names.hpp"
#include "scene/mesh_builder.hpp"
#include "trace/flush_denormals.hpp"
#include "trace/ray_query.hpp"

namespace photile::scene_io {
namespace {

using nlohmann::json;

constexpr double below_ceiling = 0.005;  // metres
/// Of a lamp's flux: what shines to the other side of its opening.
constexpr double least_uplight = 1e-3;
constexpr int most_in_a_row = 1'000;

/// A photometric file, which a scene holds once however many entries name it.
struct LampKind {
  std::uint32_t distribution = 0;  ///< of the scene
  bool uplight = false;            ///< whether it shines to the other side of its opening, too
};

/// What entries have in common, found once: a file of kilobytes may have thousands of them.
struct Shared {
  std::map<std::filesystem::path, LampKind> kinds = {};
  std::optional<std::optional<glm::dvec3>> ceiling = {};  ///< its middle, once it was looked for
};

struct LuminaireArray {
  std::string name;
  LampKind kind;
  glm::dvec3 position{0.0};  ///< of its middle, in the scene
  glm::dvec3 aim{0.0, -1.0, 0.0};
  double rotation = 0;  ///< radians
  double lumens = 0;
  int columns = 1, rows = 1;
  double column_spacing = 0, row_spacing = 0;  ///< metres
  Panel opening = {};
};

/// A pair of numbers, or nothing where the member is missing.
std::optional<std::array<double, 2>> pair_of(const json& entry, const JsonObject& object,
                                             const char* key, double lowest, double highest) {
  if (!object.has(key)) return std::nullopt;
  const json& value = entry[key];
  const auto in_range = [&](const json& number) {
    return number.is_number() && number.get<double>() >= lowest && number.get<double>() <= highest;
  };
  if (!value.is_array() || value.size() != 2 || !in_range(value[0]) || !in_range(value[1])) {
    object.refuse(fmt::format("'{}' is not two numbers from {:g} to {:g}", key, lowest, highest));
  }
  return std::array{value[0].get<double>(), value[1].get<double>()};
}

/// Share of the flux that shines away from the aim.
double uplight_of(const IntensityDistribution& distribution) {
  constexpr int rows = 64, columns = 64;
  double up = 0, all = 0;
  for (int row = 0; row < rows; ++row) {
    const double z = -1 + 2 * (row + 0.5) / rows, sine = std::sqrt(1 - z * z);
    for (int column = 0; column < columns; ++column) {
      const double azimuth = glm::two_pi<double>() * (column + 0.5) / columns;
      const double intensity =
          distribution.intensity({sine * std::cos(azimuth), sine * std::sin(azimuth), z});
      all += intensity;
      up += z > 0 ? intensity : 0.0;
    }
  }
  return all > 0 ? up / all : 0.0;
}

LampKind kind_of(const std::filesystem::path& file, const JsonObject& object, Shared& shared,
                 Scene& scene, Warnings& warnings) {
  if (const auto found = shared.kinds.find(file); found != shared.kinds.end()) {
    return found->second;
  }
  try {
    const auto bytes = read_regular_file(file, limits::max_photometry_bytes);
    auto lamp = read_photometry(file.string(), bytes, warnings);
    const LampKind kind{static_cast<std::uint32_t>(scene.distributions.size()),
                        uplight_of(lamp) > least_uplight};
    scene.distributions.push_back(std::move(lamp));
    return shared.kinds[file] = kind;
  } catch (const ResourceError& error) {
    object.refuse(fmt::format("'file': {}: {}", file.string(), error.what()));
  }
}

/// The middle of the ceiling of the first camera's room.
std::optional<glm::dvec3> middle_of_ceiling(const Scene& scene) {
  const RayScene rays(scene);
  const trace::FlushDenormals flush_denormals;
  const auto axes = measuring::PlanAxes();
  const Camera camera = scene.cameras.empty() ? place_camera(scene) : scene.cameras.front();
  const auto room = measuring::Room::of_camera(rays, axes, camera);
  if (!room) return std::nullopt;
  const glm::dvec2 plan = 0.5 * (room->low() + room->high());
  const auto places = room->places();
  if (places.empty()) return std::nullopt;
  const double height = glm::dot(places.front(), axes.up);
  const glm::dvec3 below = plan.x * axes.right + plan.y * axes.ahead + height * axes.up;
  const auto ceiling = trace::intersect(rays, glm::vec3(below), glm::vec3(axes.up));
  if (!ceiling) return std::nullopt;
  const trace::SurfacePoint point = trace::surface_hit(scene, *ceiling, glm::vec3(axes.up));
  return glm::dvec3(point.position) - below_ceiling * axes.up;
}

glm::dvec3 position_of(const json& entry, const JsonObject& object, const Scene& scene,
                       Shared& shared) {
  if (!entry.contains("position") || entry["position"] != "ceiling") {
    return place_in_scene(scene, object.vector("position"));
  }
  if (!shared.ceiling) shared.ceiling = middle_of_ceiling(scene);
  const auto& middle = *shared.ceiling;
  if (!middle) {
    object.refuse("'position': the first camera sees no room with a ceiling; give three numbers");
  }
  return *middle;
}

/// Along x and across, of the flat opening that is seen from below; of a round one a rectangle of
/// the same area. Nothing where the file states none.
std::optional<std::array<double, 2>> size_of(const LuminousOpening& opening) {
  if (!(opening.along_zero > 0 && opening.along_quarter > 0)) return std::nullopt;
  const double squared = opening.round ? std::sqrt(std::numbers::pi) / 2 : 1;
  return std::array{squared * opening.along_zero, squared * opening.along_quarter};
}

LuminaireArray array_of(const json& entry, const JsonObject& object,
                        const std::filesystem::path& folder, Shared& shared, Scene& scene,
                        Warnings& warnings) {
  const std::filesystem::path file = folder / object.text("file", "");
  LuminaireArray lamps{object.text("name", file.stem().string()),
                       kind_of(file, object, shared, scene, warnings)};
  const IntensityDistribution& distribution = scene.distributions[lamps.kind.distribution];
  lamps.position = position_of(entry, object, scene, shared);
  if (object.has("aim")) lamps.aim = direction_in_scene(scene, object.vector("aim"));
  if (!(glm::length(lamps.aim) > 0)) object.refuse("'aim' is 0 0 0; it has to point somewhere");
  lamps.aim = glm::normalize(lamps.aim);
  if (object.has("rotation")) lamps.rotation = glm::radians(object.number("rotation", -360, 360));
  lamps.lumens = distribution.flux();
  if (object.has("lumens")) lamps.lumens = object.number("lumens", 0, limits::max_light_power);
  if (const auto count = pair_of(entry, object, "count", 1, most_in_a_row)) {
    lamps.columns = static_cast<int>((*count)[0]);
    lamps.rows = static_cast<int>((*count)[1]);
    if (lamps.columns != (*count)[0] || lamps.rows != (*count)[1]) {
      object.refuse("'count' is not two whole numbers");
    }
  }
  if (const auto spacing = pair_of(entry, object, "spacing", 0, limits::max_coordinate)) {
    lamps.column_spacing = (*spacing)[0];
    lamps.row_spacing = (*spacing)[1];
  } else if (lamps.columns * lamps.rows > 1) {
    object.refuse("'count' of several lamps needs 'spacing', two numbers of metres");
  }
  auto size = pair_of(entry, object, "size", 1e-4, limits::max_coordinate);
  if (!size) size = size_of(distribution.opening());
  if (!size) {
    object.refuse(
        "'size' is missing, and the file states no luminous opening; give two numbers of metres");
  }
  lamps.opening.width = (*size)[0];
  lamps.opening.height = (*size)[1];
  return lamps;
}

/// x, y and z of a lamp that shines along -z; not rotated, its x axis lies in the horizon, along
/// that of the world where it shines up or down.
glm::dmat3 axes_of(const LuminaireArray& lamps) {
  const glm::dvec3 z = -lamps.aim;
  const bool upright = std::abs(z.y) > 0.999;
  const glm::dvec3 level = upright ? glm::dvec3(1, 0, 0) : glm::cross(glm::dvec3(0, 1, 0), z);
  const glm::dvec3 x = glm::normalize(level - glm::dot(level, z) * z);
  const glm::dvec3 y = glm::cross(z, x);
  const double cosine = std::cos(lamps.rotation), sine = std::sin(lamps.rotation);
  return {cosine * x + sine * y, cosine * y - sine * x, z};
}

std::uint32_t black_material(Scene& scene) {
  Material material;
  material.name = "luminaire";
  scene.materials.push_back(material);
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

void add_array(const LuminaireArray& lamps, double lumen_per_watt, std::uint32_t material,
               MeshBuilder& mesh, Scene& scene) {
  const glm::dmat3 axes = axes_of(lamps);
  Light light;
  light.kind = LightKind::area;
  light.power = scene.unit == PowerUnit::lumen ? lamps.lumens : lamps.lumens / lumen_per_watt;
  light.direction = glm::vec3(lamps.aim);
  light.x_axis = glm::vec3(axes[0]);
  light.two_sided = lamps.kind.uplight;
  light.distribution = lamps.kind.distribution;
  const bool alone = lamps.columns * lamps.rows == 1;
  if (!alone) light.group = lamps.name;
  for (int row = 0; row < lamps.rows; ++row) {
    for (int column = 0; column < lamps.columns; ++column) {
      const glm::dvec3 place =
          lamps.position + (column - 0.5 * (lamps.columns - 1)) * lamps.column_spacing * axes[0] +
          (row - 0.5 * (lamps.rows - 1)) * lamps.row_spacing * axes[1];
      glm::dmat4 world(axes);
      world[3] = glm::dvec4(place, 1.0);
      const auto number = static_cast<std::uint32_t>(scene.lights.size());
      light.name = alone ? lamps.name : fmt::format("{}_{}_{}", lamps.name, column + 1, row + 1);
      light.triangles.clear();
      for (const auto& corners : panel_triangles(lamps.opening, world)) {
        const auto index = static_cast<std::uint32_t>(scene.triangles.size());
        if (mesh.add({Corner{corners[0]}, Corner{corners[1]}, Corner{corners[2]}}, material,
                     number))
          light.triangles.push_back(index);
      }
      if (!light.triangles.empty()) scene.lights.push_back(light);
    }
  }
}

}  // namespace

void add_luminaires(const std::filesystem::path& file, double lumen_per_watt, Scene& scene,
                    Warnings& warnings) {
  const json content = read_input_json(file);
  const json list = content.is_array() ? content : json::array({content});
  std::vector<LuminaireArray> arrays;
  Shared shared;
  std::size_t lamps = scene.lights.size();
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonObject object(
        list[i], fmt::format("{}: luminaire {}", file.string(), i + 1),
        {"name", "file", "position", "aim", "rotation", "lumens", "count", "spacing", "size"});
    arrays.push_back(array_of(list[i], object, file.parent_path(), shared, scene, warnings));
    lamps += static_cast<std::size_t>(arrays.back().columns) *
             static_cast<std::size_t>(arrays.back().rows);
    if (lamps > limits::max_lights) {
      object.refuse(fmt::format("more than {} lights together; place fewer", limits::max_lights));
    }
  }
  if (arrays.empty()) throw InputError(fmt::format("{}: holds no luminaire", file.string()));
  const std::uint32_t material = black_material(scene);
  MeshBuilder mesh(scene, {.uv = !scene.corner_uv.empty(),
                           .emission_uv = !scene.corner_emission_uv.empty(),
                           .normals = !scene.corner_normal.empty(),
                           .tangents = !scene.corner_tangent.empty()});
  for (const LuminaireArray& array : arrays)
    add_array(array, lumen_per_watt, material, mesh, scene);
}

}  // namespace photile::scene_io
