#include "trace/portal_search.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "geometry/disjoint_sets.hpp"
#include "geometry/welded_vertices.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/ray_scene.hpp"
#include "scene/panes.hpp"
#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"
#include "trace/sampling.hpp"
#include "trace/surface.hpp"

namespace photile::trace {
namespace {

// The search. None of these changes what is estimated, only the noise.
constexpr std::uint64_t paths_of_search = 16'384, most_paths = 131'072;
constexpr int path_bounces = 3;
constexpr std::size_t enough_escapes = 400;
/// The fraction of the rays from a camera that leave at once above which it stands outside.
constexpr double outside_fraction = 0.4;
constexpr std::size_t most_planes = 256;     ///< of the largest area
constexpr double least_fraction = 0.02;      ///< of what escapes that a portal takes
constexpr double requested_fraction = 0.97;  ///< of what escapes that all take
/// The factor by which a portal that takes more may be larger than the narrowest.
constexpr double roomier = 1.5;
/// The part of the disc of the bounding sphere above which portals would gain little.
constexpr double most_portal_area = 0.25;

/// A straight way out of the scene, from the last surface that scatters.
struct Escape {
  glm::dvec3 from, direction;
};

/// Where a ray ends on a surface that light does not pass straight through; nothing where it
/// leaves.
std::optional<SurfacePoint> opaque_surface(const RayScene& rays, RayOrigin origin,
                                           const glm::vec3& direction) {
  const Scene& scene = rays.scene();
  for (int surfaces = 0; surfaces < 256; ++surfaces) {
    const auto hit = intersect(rays, origin, direction);
    if (!hit) return std::nullopt;
    const SurfacePoint point = surface_hit(scene, *hit, direction);
    const bool glass = scene::is_glazing(material_of(scene, point));
    if (!glass && !(luminance(glm::dvec3(transmittance(scene, point, direction))) > 0.5)) {
      return point;
    }
    origin = point.origin_towards(direction);
  }
  return std::nullopt;
}

/// Ways out on paths from a point, one of `points`; none where it stands outside.
std::vector<Escape> escapes_from(const RayScene& rays, const glm::vec3& start, std::size_t points) {
  const std::uint64_t first_paths = paths_of_search / points;
  std::vector<Escape> escapes;
  std::uint64_t at_once = 0;
  for (std::uint64_t path = 0; path < most_paths; ++path) {
    if (path == first_paths &&
        static_cast<double>(at_once) > outside_fraction * static_cast<double>(first_paths))
      return {};
    if (path >= first_paths && escapes.size() * points >= enough_escapes) break;
    const RandomStream random(0, path, 0);
    const RandomBlock first = random.block(Purpose::eye_scattering, 0);
    RayOrigin origin = start;
    glm::vec3 direction = sample_sphere(first.uniform(0), first.uniform(1));
    for (int bounce = 0; bounce <= path_bounces; ++bounce) {
      const auto end = opaque_surface(rays, origin, direction);
      if (!end) {
        at_once += bounce == 0 ? 1 : 0;
        escapes.push_back({glm::dvec3(origin.position), glm::dvec3(direction)});
        break;
      }
      const RandomBlock numbers =
          random.block(Purpose::eye_scattering, static_cast<std::uint32_t>(bounce) + 1);
      direction = Frame(end->normal)
                      .to_world(sample_cosine_hemisphere(numbers.uniform(0), numbers.uniform(1)));
      origin = end->origin_towards(direction);
    }
  }
  return escapes;
}

struct Plane {
  glm::dvec3 normal{0.0};  ///< unit
  double offset = 0;       ///< metres along the normal
  double area = 0;         ///< of the triangles in it

  glm::dvec3 s() const {
    return std::abs(normal.y) < 0.999 ? glm::normalize(glm::cross(glm::dvec3(0, 1, 0), normal))
                                      : glm::dvec3(1, 0, 0);
  }
  glm::dvec3 t() const { return glm::cross(normal, s()); }
};

/// The normal of a triangle's plane, the same for whatever lies in it.
glm::dvec3 plane_normal(const Scene& scene, std::uint32_t triangle) {
  const glm::dvec3 normal = face_normal(scene, oriented(triangle, 0));
  constexpr double level = 1e-6;  // roundings of 0
  const double first = std::abs(normal.x) > level   ? normal.x
                       : std::abs(normal.y) > level ? normal.y
                                                    : normal.z;
  return first < 0 ? -normal : normal;
}

using PlaneKey = std::array<long, 4>;

/// A key that is equal for triangles in about one plane.
PlaneKey plane_key(const glm::dvec3& normal, double offset) {
  return {std::lround(500 * normal.x), std::lround(500 * normal.y), std::lround(500 * normal.z),
          std::lround(std::clamp(100 * offset, -1e15, 1e15))};
}

/// The planes of the scene's triangles with the most area.
std::vector<Plane> planes_of(const Scene& scene) {
  std::map<PlaneKey, Plane> found;
  for (std::uint32_t triangle = 0; triangle < scene.triangle_count(); ++triangle) {
    const glm::dvec3 normal = plane_normal(scene, triangle);
    const double offset = glm::dot(normal, glm::dvec3(scene.corners(triangle)[0]));
    if (!std::isfinite(offset)) continue;
    Plane& plane = found[plane_key(normal, offset)];
    if (!(plane.area > 0)) plane = {normal, offset, 0};
    plane.area += triangle_area(scene, triangle);
  }
  std::vector<Plane> planes;
  for (const auto& [key, plane] : found) planes.push_back(plane);
  std::stable_sort(planes.begin(), planes.end(),
                   [](const Plane& a, const Plane& b) { return a.area > b.area; });
  if (planes.size() > most_planes) planes.resize(most_planes);
  return planes;
}

/// Crossings of a plane that lie close together: perhaps a window.
struct Opening {
  Portal portal;
  double area = 0;                ///< m2
  std::vector<std::size_t> rays;  ///< of the escapes
};

struct Crossing {
  std::size_t ray;
  double x, y;  ///< along the plane's axes, metres
};

Opening opening_of(const Plane& plane, bool along_normal, const std::vector<Crossing>& crossings,
                   double cell) {
  Opening opening;
  double left = std::numeric_limits<double>::infinity(), right = -left, low = left, high = -left;
  for (const Crossing& crossing : crossings) {
    opening.rays.push_back(crossing.ray);
    left = std::min(left, crossing.x);
    right = std::max(right, crossing.x);
    low = std::min(low, crossing.y);
    high = std::max(high, crossing.y);
  }
  left -= 0.5 * cell;
  low -= 0.5 * cell;
  const glm::dvec3 u = (right - left + 0.5 * cell) * plane.s();
  const glm::dvec3 v = (high - low + 0.5 * cell) * plane.t();
  opening.area = glm::length(u) * glm::length(v);
  opening.portal.corner =
      glm::vec3(plane.offset * plane.normal + left * plane.s() + low * plane.t());
  // Light comes in against the rays; s x t is the normal.
  opening.portal.u = glm::vec3(along_normal ? v : u);
  opening.portal.v = glm::vec3(along_normal ? u : v);
  return opening;
}

/// Crossings of a plane in one direction, parted where cells between them are empty.
void part(const Plane& plane, bool along_normal, const std::vector<Crossing>& crossings,
          double cell, std::size_t least, std::vector<Opening>& openings) {
  using Cell = std::pair<long, long>;
  std::map<Cell, std::vector<Crossing>> cells;
  for (const Crossing& crossing : crossings)
    cells[{std::lround(crossing.x / cell), std::lround(crossing.y / cell)}].push_back(crossing);
  while (!cells.empty()) {
    std::vector<Cell> edge{cells.begin()->first};
    std::vector<Crossing> together = std::move(cells.begin()->second);
    cells.erase(cells.begin());
    while (!edge.empty()) {
      const Cell at = edge.back();
      edge.pop_back();
      for (long dx = -1; dx <= 1; ++dx) {
        for (long dy = -1; dy <= 1; ++dy) {
          const auto beside = cells.find({at.first + dx, at.second + dy});
          if (beside == cells.end()) continue;
          together.insert(together.end(), beside->second.begin(), beside->second.end());
          edge.push_back(beside->first);
          cells.erase(beside);
        }
      }
    }
    if (together.size() >= least)
      openings.push_back(opening_of(plane, along_normal, together, cell));
  }
}

std::vector<Opening> openings_of(const Scene& scene, const std::vector<Escape>& escapes,
                                 std::size_t least) {
  const BoundingSphere bounds = bounding_sphere(scene);
  const double cell = std::clamp(bounds.radius / 40, 0.02, 0.25);
  std::vector<Opening> openings;
  for (const Plane& plane : planes_of(scene)) {
    std::array<std::vector<Crossing>, 2> crossings;  // along the normal, against it
    for (std::size_t ray = 0; ray < escapes.size(); ++ray) {
      const auto& [from, direction] = escapes[ray];
      const double cosine = glm::dot(direction, plane.normal);
      const double distance = (plane.offset - glm::dot(from, plane.normal)) / cosine;
      if (!(distance > 1e-3) || !std::isfinite(distance)) continue;
      const glm::dvec3 point = from + distance * direction;
      if (glm::distance(point, bounds.center) > 1.01 * bounds.radius) continue;
      crossings[cosine > 0 ? 0 : 1].push_back(
          {ray, glm::dot(point, plane.s()), glm::dot(point, plane.t())});
    }
    for (const bool along : {true, false}) {
      const auto& these = crossings[along ? 0 : 1];
      if (these.size() >= least) part(plane, along, these, cell, least, openings);
    }
  }
  return openings;
}

/// The portals that together take most of what escapes, by little area: among about the narrowest,
/// each is the one that takes most. What lights a frame from outside, and the room from there,
/// crosses the plane of the pane, and not that of the frame; where no portal is, light starts on
/// the whole of the bounding sphere, and each of its photons weighs a hundred times as much as
/// others.
std::vector<Portal> narrowest(const std::vector<Opening>& openings, std::size_t escapes,
                              std::size_t least, double most_area) {
  std::vector<bool> taken(escapes, false);
  std::vector<Portal> portals;
  double area = 0;
  std::size_t left = escapes;
  while (portals.size() < limits::max_portals &&
         static_cast<double>(left) > (1 - requested_fraction) * static_cast<double>(escapes)) {
    const auto fresh_of = [&](const Opening& opening) {
      return static_cast<std::size_t>(std::count_if(opening.rays.begin(), opening.rays.end(),
                                                    [&](std::size_t ray) { return !taken[ray]; }));
    };
    const Opening* tightest = nullptr;
    double best_score = 0;
    for (const Opening& opening : openings) {
      const std::size_t fresh = fresh_of(opening);
      const double score = static_cast<double>(fresh) / opening.area;
      if (fresh < least || score <= best_score) continue;
      tightest = &opening;
      best_score = score;
    }
    if (tightest == nullptr) break;
    const Opening* best = tightest;
    std::size_t most = fresh_of(*tightest);
    for (const Opening& opening : openings) {
      if (opening.area > roomier * tightest->area) continue;
      const std::size_t fresh = fresh_of(opening);
      if (fresh <= most) continue;
      best = &opening;
      most = fresh;
    }
    for (const std::size_t ray : best->rays) {
      left -= taken[ray] ? 0 : 1;
      taken[ray] = true;
    }
    portals.push_back(best->portal);
    area += best->area;
  }
  return area <= most_area ? portals : std::vector<Portal>{};
}

/// Fraction of rays from a rectangle to one of its sides that leave the scene.
double open_fraction(const RayScene& rays, const Portal& portal, const glm::vec3& normal) {
  constexpr int count = 256;
  int escaped = 0;
  const float above = 1e-3f * std::sqrt(glm::length(glm::cross(portal.u, portal.v)));
  for (int i = 0; i < count; ++i) {
    const RandomBlock numbers =
        RandomStream(1, static_cast<std::uint64_t>(i), 0).block(Purpose::eye_scattering, 0);
    const glm::vec3 point = portal.corner + numbers.uniform(0) * portal.u +
                            numbers.uniform(1) * portal.v + above * normal;
    const glm::vec3 direction =
        Frame(normal).to_world(sample_cosine_hemisphere(numbers.uniform(2), numbers.uniform(3)));
    escaped += opaque_surface(rays, point, direction) ? 0 : 1;
  }
  return static_cast<double>(escaped) / count;
}

/// Turns a rectangle so that light comes in from the side that sees more of the sky.
Portal facing_in(const RayScene& rays, Portal portal) {
  const glm::vec3 normal = glm::normalize(glm::cross(portal.u, portal.v));
  if (open_fraction(rays, portal, normal) > open_fraction(rays, portal, -normal))
    std::swap(portal.u, portal.v);
  return portal;
}

/// The triangles of some materials, by plane and where they hang together.
std::vector<std::vector<std::uint32_t>> panes_of(const Scene& scene,
                                                 const std::vector<bool>& chosen) {
  const std::vector<std::uint32_t> welded = geometry::welded_vertices(scene.vertices);
  geometry::DisjointSets joined(welded.size());
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t triangle = 0; triangle < scene.triangle_count(); ++triangle) {
    if (!chosen[scene.triangle_material[triangle]]) continue;
    const glm::uvec3& corners = scene.triangles[triangle];
    joined.join(welded[corners.x], welded[corners.y]);
    joined.join(welded[corners.x], welded[corners.z]);
    triangles.push_back(triangle);
  }
  std::map<PlaneKey, std::map<std::uint32_t, std::vector<std::uint32_t>>> panes;
  for (const std::uint32_t triangle : triangles) {
    const glm::dvec3 normal = plane_normal(scene, triangle);
    const double offset = glm::dot(normal, glm::dvec3(scene.corners(triangle)[0]));
    if (!std::isfinite(offset)) continue;
    panes[plane_key(normal, offset)][joined.find(welded[scene.triangles[triangle].x])].push_back(
        triangle);
  }
  std::vector<std::vector<std::uint32_t>> found;
  for (const auto& [plane, parts] : panes) {
    for (const auto& [first, members] : parts) found.push_back(members);
  }
  return found;
}

Portal rectangle_around(const Scene& scene, const std::vector<std::uint32_t>& triangles) {
  const glm::dvec3 normal = face_normal(scene, oriented(triangles.front(), 0));
  const Plane plane{normal, glm::dot(normal, glm::dvec3(scene.corners(triangles.front())[0])), 0};
  std::vector<Crossing> corners;
  for (const std::uint32_t triangle : triangles) {
    for (const glm::vec3& corner : scene.corners(triangle)) {
      corners.push_back(
          {0, glm::dot(glm::dvec3(corner), plane.s()), glm::dot(glm::dvec3(corner), plane.t())});
    }
  }
  return opening_of(plane, true, corners, 1e-4).portal;
}

}  // namespace

std::vector<Portal> find_portals(const Scene& scene, std::span<const glm::dvec3> points) {
  std::vector<glm::dvec3> starts;
  const std::size_t step = (points.size() + most_search_points - 1) / most_search_points;
  for (std::size_t i = 0; i < points.size(); i += step) starts.push_back(points[i]);
  if (starts.empty()) {
    for (const Camera& camera : scene.cameras) starts.push_back(camera.position);
  }
  const RayScene rays(scene);
  const FlushDenormals flush_denormals;
  std::vector<Escape> escapes;
  for (const glm::dvec3& start : starts) {
    for (const Escape& escape : escapes_from(rays, glm::vec3(start), starts.size()))
      escapes.push_back(escape);
  }
  if (escapes.empty()) return {};
  const std::size_t least = std::max<std::size_t>(
      8, static_cast<std::size_t>(least_fraction * static_cast<double>(escapes.size())));
  const double radius = bounding_sphere(scene).radius;
  return narrowest(openings_of(scene, escapes, least), escapes.size(), least,
                   most_portal_area * glm::pi<double>() * radius * radius);
}

std::vector<Portal> portals_of_materials(const Scene& scene, std::span<const std::string> globs) {
  std::vector<bool> chosen(scene.materials.size(), false);
  for (const std::string& glob : globs) {
    bool matched = false;
    for (std::size_t material = 0; material < scene.materials.size(); ++material) {
      if (::fnmatch(glob.c_str(), scene.materials[material].name.c_str(), 0) != 0) continue;
      chosen[material] = matched = true;
    }
    if (!matched) {
      throw UsageError(
          fmt::format("portals={}: no material of {} matches; photile info lists "
                      "them, or use auto or off",
                      glob, scene.source.string()));
    }
  }
  const auto panes = panes_of(scene, chosen);
  if (panes.size() > limits::max_portals) {
    throw UsageError(fmt::format("portals: {} panes, more than {}; name fewer, or use auto",
                                 panes.size(), limits::max_portals));
  }
  const RayScene rays(scene);
  const FlushDenormals flush_denormals;
  std::vector<Portal> portals;
  for (const auto& pane : panes) portals.push_back(facing_in(rays, rectangle_around(scene, pane)));
  return portals;
}

std::vector<Portal> portals_asked_for(const Scene& scene, std::span<const std::string> asked,
                                      std::span<const glm::dvec3> points) {
  for (const char* word : {"auto", "off"}) {
    if (asked.size() > 1 && std::find(asked.begin(), asked.end(), word) != asked.end())
      throw UsageError(fmt::format(
          "portals={}: cannot be combined with others; give it alone, or only materials", word));
  }
  if (asked.empty() || asked.front() == "auto") return find_portals(scene, points);
  if (asked.front() == "off") return {};
  return portals_of_materials(scene, asked);
}

}  // namespace photile::trace
