// From a file of either format to a scene that later stages can trust.
#include "loading/load_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <new>
#include <utility>

#include "common/ascii_text.hpp"
#include "geometry/box.hpp"
#include "gltf/gltf_import.hpp"
#include "gltf/lights.hpp"
#include "loading/light_changes.hpp"
#include "loading/surroundings.hpp"
#include "obj/obj_reader.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "scene/light_emission.hpp"
#include "scene/light_names.hpp"
#include "scene/scene_queries.hpp"
#include "trace/light_offset.hpp"
#include "trace/place_camera.hpp"
#include "trace/portal_search.hpp"

namespace photile {

namespace {

void import_by_extension(reading::ImportContext& context) {
  const std::string extension = lower(context.folder.scene_file().extension().string());
  if (extension == ".obj") {
    obj::import_obj(context);
  } else if (extension == ".gltf" || extension == ".glb") {
    gltf::import_gltf(context);
  } else {
    throw context.error(fmt::format("unknown scene format '{}'; {}", extension,
                                    extension == ".ifc"
                                        ? "convert it by photile import FILE.ifc -o FILE.glb"
                                        : "give an .obj, .gltf or .glb file"));
  }
}

void report_dropped_triangles(const ImportReport& report, files::Warnings& warnings) {
  if (report.degenerate_triangles > 0) {
    warnings.add(fmt::format("{} triangles without area are dropped", report.degenerate_triangles));
  }
  if (report.non_finite_triangles > 0) {
    warnings.add(
        fmt::format("{} triangles with a corner that is NaN, infinite or beyond {:g} m are dropped",
                    report.non_finite_triangles, limits::max_coordinate));
  }
  if (report.duplicate_triangles > 0) {
    warnings.add(
        fmt::format("{} triangles that coincide with others are dropped: of those that face the "
                    "same way, the first is kept",
                    report.duplicate_triangles));
  }
}

/// The ranges are those of the command's settings. Errors: UsageError.
void check_options(const SceneLoadOptions& options) {
  check_value("lumen_per_watt", options.lumen_per_watt, PositiveNumbers{});
  check_value("metres_per_unit", options.metres_per_unit, PositiveNumbers{});
  check_value("emissive_scale", shortest_double(options.emissive_scale), PositiveNumbers{});
  check_value("environment_scale", options.environment.scale, PositiveNumbers{});
  check_value("environment_rotation", options.environment.rotation_degrees, loading::turns);
  check_value("north", options.situation.north_degrees, loading::turns);
  check_value("ground", options.ground, loading::reflectances);
}

/// An error about a scene that lacks something. The warnings of the import are often the reason: a
/// missing material library, lamps that the exporter dropped.
InputError lacks(const std::string& what, const reading::ImportContext& context) {
  constexpr std::size_t warnings_told = 3;
  std::vector<std::string> lines = context.warnings.lines();
  if (lines.size() > warnings_told) lines.resize(warnings_told);
  const std::string reasons =
      lines.empty() ? "" : fmt::format(" (import: {})", fmt::join(lines, "; "));
  return context.error(what + reasons);
}

/// Importers leave the irradiance of a directional light in `power`, since the size of the scene is
/// known only now.
void finish_directional_lights(const reading::ImportContext& context) {
  const double radius = bounding_sphere(context.scene).radius;
  for (Light& light : context.scene.lights) {
    if (light.kind != LightKind::directional) continue;
    light.power = scene::directional_flux(light.power, radius);
    if (!std::isfinite(light.power)) {
      throw context.error(fmt::format(
          "light '{}': its flux over a scene of {:g} m is too large for a float; reduce its lux",
          light.name, 2 * radius));
    }
  }
}

void check_powers(const Scene& scene, double emissive_scale) {
  for (const Light& light : scene.lights) {
    if (light.power <= limits::max_light_power) continue;
    const std::string emits =
        fmt::format("light '{}' emits {:.4g} {}; the limit is {:g}", light.name, light.power,
                    symbol_of(scene.unit), limits::max_light_power);
    const bool by_scale = light.kind == LightKind::area && emissive_scale > 1.0 &&
                          light.power / emissive_scale <= limits::max_light_power;
    if (by_scale) {
      throw UsageError(
          fmt::format("emissive scale {:g}: {}; give a smaller scale", emissive_scale, emits));
    }
    throw InputError(fmt::format("{}: {}; reduce its power", scene.source.string(), emits));
  }
}

/// Objects of a glTF file are its visits, then its panels; those of an OBJ file have no nodes.
reading::LightSource source_of(const reading::AreaLights::Origin& origin,
                               const reading::ImportContext& context) {
  const std::vector<std::uint32_t>& nodes = context.visited_nodes;
  if (nodes.empty())
    return {reading::LightSource::Kind::surface, none, origin.material, origin.lamp};
  if (origin.object < nodes.size()) {
    return {reading::LightSource::Kind::surface, nodes[origin.object], origin.material,
            origin.lamp};
  }
  return {reading::LightSource::Kind::panel, nodes[origin.object - reading::first_panel_object],
          none, origin.lamp};
}

}  // namespace

namespace loading {

SourcedScene load_sourced_scene(const std::filesystem::path& file, const SceneLoadOptions& options,
                                const Progress& progress) {
  check_options(options);
  Scene scene;
  scene.source = file;
  scene.turn = loading::turn_upright(options.up);
  files::SceneFolder folder(file, options.allow_outside);
  files::Warnings warnings;
  reading::AreaLights area_lights(scene);
  std::vector<loading::PlacedLuminaires> placed;
  reading::ImportContext context{scene, folder, options, warnings, area_lights,
                                 {},    {},     {},      progress};
  try {
    import_by_extension(context);
    report_dropped_triangles(scene.report, warnings);
    if (scene.triangles.empty()) {
      throw lacks("the file has no triangles with an area; export the scene with its geometry",
                  context);
    }
    if (options.up.empty()) loading::warn_of_other_up(scene, warnings);
    if (options.metres_per_unit == 1) loading::warn_of_other_unit(scene, warnings);
    for (const reading::AreaLights::Origin& origin : area_lights.finish(warnings)) {
      context.light_sources.push_back(source_of(origin, context));
    }
    finish_directional_lights(context);
    placed = loading::add_luminaires(options, scene, warnings);
    loading::add_surroundings(scene, options);
    context.light_sources.resize(scene.lights.size());
    if (scene.lights.empty() && !options.may_be_dark) {
      throw lacks(
          "the scene has no lights; give a material an emission (Ke in MTL, emissiveFactor in "
          "glTF), add "
          "KHR_lights_punctual lights, or give luminaires, an environment picture, a sun or a sky",
          context);
    }
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw context.error("not enough memory to load the scene; split it");
  } catch (const std::exception& error) {
    // The importer libraries may throw any exception on malformed files.
    throw context.error(fmt::format("malformed file ({}); export the file again", error.what()));
  }
  gltf::group_instances(scene.lights, context.light_sources);
  scene::make_light_names_unique(scene.lights);
  loading::apply_profiles(scene, options.profiles, warnings);
  loading::apply_temperatures(scene, options.temperatures);
  loading::apply_glasses(scene, options.glasses);
  loading::apply_reflectances(scene, options.reflectances);
  check_powers(scene, options.emissive_scale);
  loading::group_lights(scene, options.light_groups);
  trace::offset_lights(scene);
  if (scene.cameras.empty()) scene.cameras.push_back(trace::place_camera(scene));
  const bool lit_from_beyond = std::any_of(scene.lights.begin(), scene.lights.end(),
                                           [](const Light& light) { return light.is_distant(); });
  if (lit_from_beyond) scene.portals = trace::portals_asked_for(scene, options.portals);
  scene.report.warnings = warnings.lines();
  return {std::move(scene), std::move(context.light_sources), std::move(placed)};
}

Scene load_scene(const std::filesystem::path& file, const SceneLoadOptions& options,
                 const Progress& progress) {
  return load_sourced_scene(file, options, progress).scene;
}

}  // namespace loading

Scene load_scene(const std::filesystem::path& file, const SceneLoadOptions& options) {
  return loading::load_scene(file, options, Progress::none());
}

}  // namespace photile

namespace photile::loading {

namespace {

constexpr double least_cosine = 0.985;  ///< of what faces along an axis: 10 degrees
constexpr double level = 0.02;          ///< metres: what lies so near to each other is one plane
constexpr double least_height = 2;      ///< metres, of a room
constexpr double small_model = 3;       ///< metres: what is smaller is no room
constexpr double least_share = 0.5;     ///< of the width, the height of a small model
constexpr double least_evidence = 2;
// Metres: an interior is seldom as wide, or as small, and one in centimetres is hardly narrower.
constexpr double doubtfully_wide = 200, doubtfully_small = 0.05;
constexpr std::array<std::pair<std::string_view, double>, 5> length_units{
    {{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1}, {"in", 0.0254}, {"ft", 0.3048}}};
constexpr double usual_width[] = {2, 150};  ///< metres, of what a unit that is proposed makes

/// Surface that faces along an axis, either way.
struct Facing {
  double area = 0;                        ///< m2
  std::map<std::int64_t, double> planes;  ///< m2 by position along the axis

  double widest() const {
    double most = 0;
    for (const auto& [place, area_there] : planes) most = std::max(most, area_there);
    return most;
  }
};

/// Along x, y and z.
std::array<Facing, 3> facings_of(const Scene& scene) {
  std::array<Facing, 3> facings;
  for (std::size_t triangle = 0; triangle < scene.triangle_count(); ++triangle) {
    const std::array<glm::vec3, 3> p = scene.corners(triangle);
    const glm::dvec3 a(p[0]), doubled = glm::cross(glm::dvec3(p[1]) - a, glm::dvec3(p[2]) - a);
    const double length = glm::length(doubled);
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(doubled[axis]) >= least_cosine * length)) continue;
      Facing& facing = facings[static_cast<std::size_t>(axis)];
      facing.area += 0.5 * length;
      facing.planes[std::llround(a[axis] / level)] += 0.5 * length;
    }
  }
  return facings;
}

bool may_be_height(double z, const glm::dvec3& size) {
  const double largest = std::max({size.x, size.y, size.z});
  if (z > size.y) return false;
  return largest < small_model ? z >= least_share * largest : z >= least_height;
}

}  // namespace

glm::dmat3 turn_upright(const std::string& up) {
  const std::string word = up.empty() ? "y" : up;
  const bool down = word.front() == '-';
  const std::string axis = down ? word.substr(1) : word;
  if (axis != "x" && axis != "y" && axis != "z") {
    throw UsageError(fmt::format("up '{}' is not an axis; give x, y, z, -x, -y or -z", up));
  }
  glm::dvec3 upwards(0.0);
  upwards[axis.front() - 'x'] = down ? -1.0 : 1.0;
  const glm::dvec3 right = axis == "x" ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  return glm::transpose(glm::dmat3(right, upwards, glm::cross(right, upwards)));
}

void warn_of_other_up(const Scene& scene, files::Warnings& warnings) {
  geometry::BoxOf<double> box;
  for (const glm::vec3& vertex : scene.vertices) box.extend(glm::dvec3(vertex));
  const glm::dvec3 size = box.size();
  if (!may_be_height(size.z, size)) return;
  const auto [x, y, z] = facings_of(scene);
  const double by_area = z.area / y.area, by_plane = z.widest() / y.widest();
  if (!(by_area >= 1 && by_plane >= 1 && by_area * by_plane >= least_evidence)) return;
  warnings.add(
      fmt::format("z seems to point up: {:.3g} m2 face along z, {:.3g} along y, which is taken as "
                  "up; --set up=z turns the scene, --set up=y silences this warning",
                  z.area, y.area));
}

std::vector<std::string_view> names_of_units() {
  std::vector<std::string_view> names;
  for (const auto& [name, metres] : length_units) names.push_back(name);
  return names;
}

double metres_in(std::string_view unit) {
  const auto found = std::find_if(length_units.begin(), length_units.end(),
                                  [&](const auto& one) { return one.first == unit; });
  return found->second;
}

void warn_of_other_unit(const Scene& scene, files::Warnings& warnings) {
  const glm::vec3 size = scene::bounds_of(scene).size();
  const double width = std::max({size.x, size.y, size.z});
  if (width >= doubtfully_small && width <= doubtfully_wide) return;
  std::vector<std::string> remedies;
  for (const auto& [unit, metres] : length_units) {
    const double then = metres * width;
    if (then >= usual_width[0] && then <= usual_width[1]) {
      remedies.push_back(fmt::format("--set units={} makes it {:.4g} m", unit, then));
    }
  }
  if (remedies.empty()) remedies.emplace_back("--set units gives the unit of its lengths");
  warnings.add(fmt::format("the scene is {:.4g} m wide; {}", width, fmt::join(remedies, ", ")));
}

}  // namespace photile::loading
