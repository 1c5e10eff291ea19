#include "loading/luminaires.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>
#include <tuple>
#include <utility>

#include "common/files.hpp"
#include "common/json_object.hpp"
#include "gltf/panels.hpp"
#include "photile/defaults.hpp"
#include "photile/errors.hpp"
#include "photile/layered_picture.hpp"
#include "photile/limits.hpp"
#include "photometry/photometric_file.hpp"
#include "scene/light_emission.hpp"
#include "scene/mesh_builder.hpp"
#include "trace/place_camera.hpp"
#include "trace/ray_query.hpp"
#include "trace/room.hpp"

namespace photile::loading {

namespace {

using nlohmann::json;

constexpr double below_ceiling = 0.005;  // metres
/// The least fraction of a lamp's flux that counts as light to the other side of its opening.
constexpr double least_uplight = 1e-3;
constexpr double least_maintenance = 0.01;
constexpr int most_in_a_row = 1'000;

/// A photometric file with what entries state in place of it, once in a scene.
struct LampKind {
  std::uint32_t distribution = 0;  ///< of the scene
  bool uplight = false;            ///< whether it shines to the other side of its opening, too
};

/// Data that entries share, found once: a file of kilobytes may have thousands of entries.
struct Shared {
  std::map<std::string, IntensityDistribution> files = {};
  std::map<std::tuple<std::string, double, double>, LampKind> kinds = {};
  std::map<std::string, glm::dvec3> ceilings = {};  ///< their middles, by "inside"
};

struct LuminaireArray {
  PlacedLuminaires placed;
  LampKind kind;
};

/// A pair of numbers, or nothing where the member is missing.
std::optional<glm::dvec2> pair_of(const json& entry, const JsonObject& object, const char* key,
                                  double lowest, double highest) {
  if (!object.has(key)) return std::nullopt;
  const json& value = entry[key];
  const auto in_range = [&](const json& number) {
    return number.is_number() && number.get<double>() >= lowest && number.get<double>() <= highest;
  };
  if (!value.is_array() || value.size() != 2 || !in_range(value[0]) || !in_range(value[1])) {
    object.refuse(fmt::format("'{}' is not two numbers from {:g} to {:g}", key, lowest, highest));
  }
  return glm::dvec2(value[0].get<double>(), value[1].get<double>());
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

LampKind kind_of(const std::string& file, double kelvin, const JsonObject& object,
                 files::SceneFolder& folder, Shared& shared, Scene& scene,
                 files::Warnings& warnings) {
  const double maintenance =
      object.has("maintenance") ? object.number("maintenance", least_maintenance, 1) : 0;
  const std::tuple key(file, kelvin, maintenance);
  if (const auto found = shared.kinds.find(key); found != shared.kinds.end()) {
    return found->second;
  }
  try {
    auto lamp = shared.files.find(file);
    if (lamp == shared.files.end()) {
      const auto bytes = folder.read(file, limits::max_photometry_bytes);
      lamp = shared.files.emplace(file, photometry::read_photometry(file, bytes, warnings)).first;
    }
    const LampKind kind{static_cast<std::uint32_t>(scene.distributions.size()),
                        uplight_of(lamp->second) > least_uplight};
    LuminaireData data = lamp->second.data();
    if (kelvin > 0) data.kelvin = kelvin, data.highest_kelvin = 0;
    data.maintenance = maintenance;
    scene.distributions.push_back(lamp->second);
    scene.distributions.back().set_data(std::move(data));
    return shared.kinds[key] = kind;
  } catch (const files::ResourceError& error) {
    object.refuse(fmt::format("'file': {}", error.what()));
  }
}

/// The middle of the ceiling of the room around a point, else of the first camera's room, else of
/// the largest.
std::optional<glm::dvec3> middle_of_ceiling(const Scene& scene,
                                            const std::optional<glm::dvec3>& inside) {
  const RayScene rays(scene);
  const trace::FlushDenormals flush_denormals;
  const auto axes = trace::PlanAxes();
  std::optional<trace::Room> room =
      inside ? trace::Room::around(rays, axes, position_in_scene(scene, *inside))
             : trace::Room::meant(rays, axes, {});
  if (!room && !inside) room = trace::Room::of_camera(rays, axes, trace::place_camera(scene));
  if (!room) return std::nullopt;
  const glm::dvec2 plan = 0.5 * (room->low() + room->high());
  const glm::dvec3 middle =
      plan.x * axes.right + plan.y * axes.ahead + room->cut_height() * axes.up;
  // Above the middle there may be a hole or a seam.
  std::vector<glm::dvec3> positions = room->positions();
  positions.push_back(middle);
  std::ranges::sort(positions, {}, [&](const glm::dvec3& position) {
    return std::pair(glm::distance(position, middle), position.x);
  });
  const glm::vec3 up(axes.up);
  for (const glm::dvec3& position : positions) {
    const auto ceiling = trace::intersect(rays, glm::vec3(position), up);
    if (!ceiling) continue;
    return glm::dvec3(trace::surface_hit(scene, *ceiling, up).position) - below_ceiling * axes.up;
  }
  return std::nullopt;
}

glm::dvec3 position_of(const json& entry, const JsonObject& object, const Scene& scene,
                       Shared& shared) {
  const bool hangs = entry.value("position", json()) == "ceiling";
  const auto inside = object.has("inside") ? std::optional(object.vector("inside")) : std::nullopt;
  if (inside && !hangs) object.refuse("'inside' is for \"position\": \"ceiling\"; leave it out");
  if (!hangs) return position_in_scene(scene, object.vector("position"));
  const std::string key = inside ? entry["inside"].dump() : "";
  if (const auto known = shared.ceilings.find(key); known != shared.ceilings.end()) {
    return known->second;
  }
  const auto middle = middle_of_ceiling(scene, inside);
  if (!middle) {
    object.refuse(
        "'position': no such room with a ceiling; give 'inside', a point in one, or numbers");
  }
  return shared.ceilings[key] = *middle;
}

/// Along x and across, of the flat opening that is seen from below; of a round one a rectangle of
/// the same area. Nothing where the file states none.
std::optional<glm::dvec2> size_of(const LuminousOpening& opening) {
  const double area = opening.projected_area({0, 0, -1});
  if (!(area > 0)) return std::nullopt;
  return std::sqrt(area / (opening.x * opening.y)) * glm::dvec2(opening.x, opening.y);
}

LuminaireArray array_of(const json& entry, const JsonObject& object, files::SceneFolder& folder,
                        Shared& shared, Scene& scene, files::Warnings& warnings) {
  const std::string file = object.text("file", "");
  double kelvin = 0;
  if (object.has("kelvin")) {
    kelvin = object.number("kelvin", limits::min_color_temperature, limits::max_color_temperature);
  }
  LuminaireArray lamps{{}, kind_of(file, kelvin, object, folder, shared, scene, warnings)};
  const IntensityDistribution& distribution = scene.distributions[lamps.kind.distribution];
  PlacedLuminaires& placed = lamps.placed;
  placed.kelvin = kelvin;
  placed.name = object.text("name", std::filesystem::path(file).stem().string());
  placed.position = position_of(entry, object, scene, shared);
  glm::dvec3 aim(0.0, -1.0, 0.0);
  if (object.has("aim")) aim = direction_in_scene(scene, object.vector("aim"));
  if (!(glm::length(aim) > 0)) object.refuse("'aim' has length 0; give a direction");
  if (object.has("rotation")) placed.rotation = glm::radians(object.number("rotation", -360, 360));
  placed.axes = luminaire_axes(glm::normalize(aim), placed.rotation);
  placed.lumens = distribution.flux();
  if (object.has("lumens")) placed.lumens = object.number("lumens", 0, limits::max_light_power);
  if (object.has("circuit")) placed.circuit = object.text("circuit", "");
  if (const auto count = pair_of(entry, object, "count", 1, most_in_a_row)) {
    if (*count != glm::floor(*count)) object.refuse("'count' is not two whole numbers");
    placed.columns = static_cast<int>(count->x);
    placed.rows = static_cast<int>(count->y);
  }
  if (const auto spacing = pair_of(entry, object, "spacing", 0, limits::max_coordinate)) {
    placed.spacing = *spacing;
  } else if (placed.columns * placed.rows > 1) {
    object.refuse("'count' of several lamps needs 'spacing', two numbers of metres");
  }
  std::optional<glm::dvec2> size = pair_of(entry, object, "size", 1e-4, limits::max_coordinate);
  if (!size) size = size_of(distribution.opening());
  if (!size) {
    object.refuse(
        "'size' is missing, and the photometric file states no luminous opening visible from "
        "below; give two numbers of metres");
  }
  placed.opening = *size;
  return lamps;
}

std::uint32_t black_material(Scene& scene) {
  Material material;
  material.name = "luminaire";
  scene.materials.push_back(material);
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

void add_array(const LuminaireArray& lamps, double lumen_per_watt, std::uint32_t material,
               scene::MeshBuilder& mesh, Scene& scene) {
  const PlacedLuminaires& placed = lamps.placed;
  Light light;
  light.kind = LightKind::area;
  light.power = in_unit(placed.lumens, PowerUnit::lumen, scene.unit, lumen_per_watt);
  if (placed.kelvin > 0) light.color = glm::vec3(scene::color_of_temperature(placed.kelvin));
  light.direction = glm::vec3(-placed.axes[2]);
  light.x_axis = glm::vec3(placed.axes[0]);
  light.two_sided = lamps.kind.uplight;
  light.distribution = lamps.kind.distribution;
  const std::vector<glm::dvec3> middles = placed.middles();
  const bool alone = middles.size() == 1;
  light.group = placed.circuit;
  if (!alone && light.group.empty()) light.group = placed.name;
  const auto columns = static_cast<std::size_t>(placed.columns);
  for (std::size_t i = 0; i < middles.size(); ++i) {
    glm::dmat4 world(placed.axes);
    world[3] = glm::dvec4(middles[i], 1.0);
    const auto number = static_cast<std::uint32_t>(scene.lights.size());
    light.name = alone ? placed.name
                       : fmt::format("{}_{}_{}", placed.name, i % columns + 1, i / columns + 1);
    light.triangles.clear();
    const gltf::Panel opening{.width = placed.opening.x, .height = placed.opening.y};
    for (const auto& corners : gltf::panel_triangles(opening, world)) {
      const auto index = static_cast<std::uint32_t>(scene.triangles.size());
      if (mesh.add(
              {scene::Corner{corners[0]}, scene::Corner{corners[1]}, scene::Corner{corners[2]}},
              material, number))
        light.triangles.push_back(index);
    }
    if (!light.triangles.empty()) scene.lights.push_back(light);
  }
}

/// A lamp for a room that has no light yet.
void add_work_light(double lumen_per_watt, Scene& scene) {
  Light light;
  light.name = "work_light";
  light.kind = LightKind::point;
  light.power = in_unit(defaults::work_light, PowerUnit::lumen, scene.unit, lumen_per_watt);
  const Camera camera = scene.cameras.empty() ? trace::place_camera(scene) : scene.cameras.front();
  light.position = glm::vec3(camera.position);
  scene.lights.push_back(std::move(light));
}

}  // namespace

std::vector<glm::dvec3> PlacedLuminaires::middles() const {
  std::vector<glm::dvec3> middles;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      middles.push_back(position + (column - 0.5 * (columns - 1)) * spacing.x * axes[0] +
                        (row - 0.5 * (rows - 1)) * spacing.y * axes[1]);
    }
  }
  return middles;
}

glm::dmat3 luminaire_axes(const glm::dvec3& aim, double rotation) {
  const glm::dvec3 z = -aim;
  const bool upright = std::abs(z.y) > 0.999;
  const glm::dvec3 level = upright ? glm::dvec3(1, 0, 0) : glm::cross(glm::dvec3(0, 1, 0), z);
  const glm::dvec3 x = glm::normalize(level - glm::dot(level, z) * z);
  const glm::dvec3 y = glm::cross(z, x);
  const double cosine = std::cos(rotation), sine = std::sin(rotation);
  return {cosine * x + sine * y, cosine * y - sine * x, z};
}

std::optional<glm::dvec2> stated_opening(const std::filesystem::path& photometry) {
  files::Warnings unheard;
  const auto bytes = files::read_regular_file(photometry, limits::max_photometry_bytes);
  return size_of(photometry::read_photometry(photometry.string(), bytes, unheard).opening());
}

std::vector<PlacedLuminaires> add_luminaires(const LuminaireList& list,
                                             const std::filesystem::path& file, bool allow_outside,
                                             double lumen_per_watt, Scene& scene,
                                             files::Warnings& warnings) {
  std::vector<LuminaireArray> arrays;
  Shared shared;
  files::SceneFolder folder(file, allow_outside);
  std::size_t lamps = scene.lights.size();
  for (std::size_t i = 0; i < list.entries.size(); ++i) {
    const json entry = list.entries[i];
    const JsonObject object(entry, fmt::format("{}: luminaire {}", file.string(), i + 1),
                            {"name", "file", "position", "inside", "aim", "rotation", "lumens",
                             "kelvin", "maintenance", "circuit", "count", "spacing", "size"});
    arrays.push_back(array_of(entry, object, folder, shared, scene, warnings));
    const PlacedLuminaires& placed = arrays.back().placed;
    lamps += static_cast<std::size_t>(placed.columns) * static_cast<std::size_t>(placed.rows);
    if (lamps > limits::max_lights) {
      object.refuse(fmt::format("more than {} lights together; place fewer", limits::max_lights));
    }
  }
  std::vector<PlacedLuminaires> placed;
  if (arrays.empty()) return placed;
  const std::uint32_t material = black_material(scene);
  scene::MeshBuilder mesh(scene, {.uv = !scene.corner_uv.empty(),
                                  .emission_uv = !scene.corner_emission_uv.empty(),
                                  .normals = !scene.corner_normal.empty(),
                                  .tangents = !scene.corner_tangent.empty()});
  for (const LuminaireArray& array : arrays) {
    placed.push_back(array.placed);
    add_array(array, lumen_per_watt, material, mesh, scene);
  }
  return placed;
}

std::vector<PlacedLuminaires> add_luminaires(const SceneLoadOptions& options, Scene& scene,
                                             files::Warnings& warnings) {
  const std::filesystem::path& file = options.luminaires;
  if (file.empty()) return {};
  const bool edited = !options.luminaires_text.empty();
  const LuminaireList list =
      edited ? LuminaireList::parse(options.luminaires_text, file.string()) : read_luminaires(file);
  if (list.entries.empty() && !edited) {
    throw InputError(fmt::format("{}: the file lists no luminaires", file.string()));
  }
  auto placed =
      add_luminaires(list, file, options.allow_outside, options.lumen_per_watt, scene, warnings);
  const bool lit = options.sky || options.sun || !options.environment.file.empty();
  if (edited && scene.lights.empty() && !lit) add_work_light(options.lumen_per_watt, scene);
  return placed;
}

std::string LuminaireList::text() const {
  if (alone && entries.size() == 1) return entries.front().dump() + "\n";
  std::string text = "[";
  for (const nlohmann::ordered_json& entry : entries) {
    text += text.size() > 1 ? ",\n " : "";
    text += entry.dump();
  }
  return text + "]\n";
}

LuminaireList LuminaireList::parse(const std::string& text, const std::string& name) {
  check_json_depth(text, name);
  const auto content = nlohmann::ordered_json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (content.is_discarded()) throw InputError(fmt::format("{}: this is not valid JSON", name));
  LuminaireList list;
  list.alone = !content.is_array();
  if (list.alone) {
    list.entries.push_back(content);
  } else {
    list.entries.assign(content.begin(), content.end());
  }
  return list;
}

LuminaireList read_luminaires(const std::filesystem::path& file) {
  return LuminaireList::parse(read_input_text(file), file.string());
}

LuminaireList read_own_luminaires(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file, ignored))) return {};
  return LuminaireList::parse(read_own_text(file), file.string());
}

void write_luminaires(const std::filesystem::path& file, const LuminaireList& list) {
  write_file(file, list.text());
}

}  // namespace photile::loading
