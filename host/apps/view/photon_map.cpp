#include "view/photon_map.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "geometry/triangle_distance.hpp"
#include "trace/ray_query.hpp"

namespace photile::view {

namespace {

std::array<glm::dvec3, 3> corners_of(const Scene& scene, std::uint32_t oriented_face) {
  const auto corners = scene.corners(triangle_of(oriented_face));
  return {glm::dvec3(corners[0]), glm::dvec3(corners[1]), glm::dvec3(corners[2])};
}

/// Whether the boxes of two triangles are at most `radius` apart: cheap, and true wherever the
/// triangles are.
bool boxes_within(const std::array<glm::dvec3, 3>& a, const std::array<glm::dvec3, 3>& b,
                  double radius) {
  const glm::dvec3 gap =
      glm::max(glm::min(glm::min(a[0], a[1]), a[2]) - glm::max(glm::max(b[0], b[1]), b[2]),
               glm::min(glm::min(b[0], b[1]), b[2]) - glm::max(glm::max(a[0], a[1]), a[2]));
  return std::max({gap.x, gap.y, gap.z}) <= radius;
}

std::vector<std::uint32_t> group_of(const Scene& scene, const InspectablePhotons& photons,
                                    std::uint32_t oriented_face) {
  if (!std::isfinite(photons.radius)) return {};
  const double cos_angle = std::cos(glm::radians(photons.angle_degrees));
  const auto own = corners_of(scene, oriented_face);
  const glm::dvec3 normal = face_normal(scene, oriented_face);
  std::vector<std::uint8_t> near(2 * scene.triangle_count(), 0);
  tbb::parallel_for(std::size_t{0}, scene.triangle_count(), [&](std::size_t triangle) {
    const auto first = oriented(static_cast<std::uint32_t>(triangle), 0);
    const auto other = corners_of(scene, first);
    if (!boxes_within(own, other, photons.radius)) return;
    if (triangle_triangle_distance(own, other) > photons.radius) return;
    for (const std::uint32_t each : {first, first + 1}) {
      near[each] = normals_agree(normal, face_normal(scene, each), cos_angle) ? 1 : 0;
    }
  });
  near[oriented_face] = 0;
  std::vector<std::uint32_t> group;
  for (std::uint32_t each = 0; each < near.size(); ++each) {
    if (near[each]) group.push_back(each);
  }
  return group;
}

std::span<const glm::vec3> photons_on(const InspectablePhotons& photons,
                                      std::uint32_t oriented_face) {
  return std::span(photons.position)
      .subspan(photons.first_of[oriented_face],
               photons.first_of[oriented_face + 1] - photons.first_of[oriented_face]);
}

}  // namespace

InspectablePhotons InspectablePhotons::of(const TracedPhotons& photons) {
  return {photons.photons.position, photons.photons.first_of, photons.groups.patches,
          photons.groups.radius, photons.groups.angle_degrees};
}

PhotonMapView view_of_map(const Scene& scene, const InspectablePhotons& photons,
                          std::uint32_t oriented_face) {
  PhotonMapView view;
  view.oriented_face = oriented_face;
  view.group = group_of(scene, photons, oriented_face);
  const std::vector<std::uint32_t>& map_of = photons.patches.map_of;
  for (std::uint32_t each = 0; each < map_of.size(); ++each) {
    if (each == oriented_face || map_of[each] != map_of[oriented_face]) continue;
    if (!std::binary_search(view.group.begin(), view.group.end(), each)) view.patch.push_back(each);
  }
  const auto own = photons_on(photons, oriented_face);
  view.own_photons.assign(own.begin(), own.end());
  const auto corners = corners_of(scene, oriented_face);
  for (const std::uint32_t each : view.group) {
    for (const glm::vec3& photon : photons_on(photons, each)) {
      if (geometry::squared_point_triangle_distance(glm::dvec3(photon), corners) <=
          photons.radius * photons.radius) {
        view.group_photons.push_back(photon);
      }
    }
  }
  return view;
}

namespace {

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour red{230, 60, 40}, blue{60, 120, 255}, green{60, 190, 90}, yellow{255, 230, 0},
    cyan{0, 255, 255};
/// The fraction of a tint that is its colour.
constexpr double tint_fraction = 0.4;
/// A photon is hidden by surface that is nearer by this fraction of its distance: pixels see their
/// middles only.
constexpr double hidden_share = 0.02;

void tint(DisplayedFrame& shown, std::size_t pixel, const Colour& colour) {
  for (std::size_t c = 0; c < 3; ++c) {
    std::uint8_t& value = shown.rgb[3 * pixel + c];
    value = static_cast<std::uint8_t>((1 - tint_fraction) * value + tint_fraction * colour[c]);
  }
}

void draw_photons(DisplayedFrame& shown, const Camera& camera, const VisibleSurfaces& seen,
                  const std::vector<glm::vec3>& photons, const Colour& colour) {
  for (const glm::vec3& photon : photons) {
    const auto place = project(camera, glm::dvec3(photon), shown.width, shown.height);
    if (!place || !(place->x >= 0) || !(place->x < shown.width) || !(place->y >= 0) ||
        !(place->y < shown.height)) {
      continue;
    }
    const std::size_t pixel =
        static_cast<std::size_t>(place->y) * static_cast<std::size_t>(shown.width) +
        static_cast<std::size_t>(place->x);
    const double distance = glm::distance(glm::dvec3(photon), camera.position);
    if (distance > (1 + hidden_share) * seen.distance[pixel]) continue;
    std::copy(colour.begin(), colour.end(),
              shown.rgb.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
  }
}

struct VisiblePoint {
  std::uint32_t oriented_face = none;
  double distance = std::numeric_limits<double>::infinity();
};

VisiblePoint seen_along(const RayScene& rays, const glm::dvec3& from, const glm::dvec3& direction) {
  const auto hit = trace::intersect(rays, glm::vec3(from), glm::vec3(direction));
  if (!hit) return {};
  const Scene& scene = rays.scene();
  const auto corners = scene.corners(hit->triangle);
  const double u = static_cast<double>(hit->u), v = static_cast<double>(hit->v);
  const glm::dvec3 place = (1 - u - v) * glm::dvec3(corners[0]) + u * glm::dvec3(corners[1]) +
                           v * glm::dvec3(corners[2]);
  const bool faces = glm::dot(face_normal(scene, oriented(hit->triangle, 0)), direction) < 0;
  return {oriented(hit->triangle, faces ? 0 : 1), glm::distance(place, from)};
}

}  // namespace

std::uint32_t face_along(const RayScene& rays, const glm::dvec3& from,
                         const glm::dvec3& direction) {
  const trace::FlushDenormals flush_denormals;
  return seen_along(rays, from, direction).oriented_face;
}

VisibleSurfaces visible_surfaces(const RayScene& rays, const Camera& camera, int width,
                                 int height) {
  VisibleSurfaces seen{width, height, {}, {}};
  const auto columns = static_cast<std::size_t>(width);
  seen.oriented_face.resize(columns * static_cast<std::size_t>(height));
  seen.distance.resize(seen.oriented_face.size());
  tbb::parallel_for(0, height, [&](int y) {
    const trace::FlushDenormals flush_denormals;
    for (int x = 0; x < width; ++x) {
      const VisiblePoint point =
          seen_along(rays, camera.position, camera.direction(x + 0.5, y + 0.5, width, height));
      const std::size_t pixel = static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x);
      seen.oriented_face[pixel] = point.oriented_face;
      seen.distance[pixel] = point.distance;
    }
  });
  return seen;
}

std::optional<glm::dvec2> project(const Camera& camera, const glm::dvec3& point, int width,
                                  int height) {
  const glm::dvec3 from_eye = point - camera.position;
  const double depth = glm::dot(from_eye, camera.forward);
  if (!(depth > 0)) return std::nullopt;
  const double half_height = std::tan(0.5 * camera.vertical_field_of_view) * depth;
  const double half_width = half_height * width / height;
  return glm::dvec2(0.5 * width * (1 + glm::dot(from_eye, camera.right) / half_width),
                    0.5 * height * (1 - glm::dot(from_eye, camera.up) / half_height));
}

void draw_photon_map(DisplayedFrame& shown, const Camera& camera, const VisibleSurfaces& seen,
                     const PhotonMapView& map) {
  const auto holds = [](const std::vector<std::uint32_t>& ascending, std::uint32_t each) {
    return std::binary_search(ascending.begin(), ascending.end(), each);
  };
  for (std::size_t pixel = 0; pixel < seen.oriented_face.size(); ++pixel) {
    const std::uint32_t triangle = seen.oriented_face[pixel];
    if (triangle == none) continue;
    if (triangle == map.oriented_face) {
      tint(shown, pixel, red);
    } else if (holds(map.group, triangle)) {
      tint(shown, pixel, blue);
    } else if (holds(map.patch, triangle)) {
      tint(shown, pixel, green);
    }
  }
  draw_photons(shown, camera, seen, map.group_photons, cyan);
  draw_photons(shown, camera, seen, map.own_photons, yellow);
}

const RayScene& PhotonInspector::rays() {
  if (!rays_) rays_.emplace(scene_);
  return *rays_;
}

void PhotonInspector::pick(const Frame& frame, double x, double y) {
  const trace::FlushDenormals flush_denormals;
  const int width = frame.layers.width, height = frame.layers.height;
  const glm::dvec3 direction = frame.camera.direction(x * width, y * height, width, height);
  picked_ = seen_along(rays(), frame.camera.position, direction).oriented_face;
  map_.reset();
}

std::optional<PhotonInspector::Surface> PhotonInspector::surface_at(const Frame& frame, double x,
                                                                    double y) {
  const trace::FlushDenormals flush_denormals;
  const int width = frame.layers.width, height = frame.layers.height;
  const glm::dvec3 direction = frame.camera.direction(x * width, y * height, width, height);
  const VisiblePoint seen = seen_along(rays(), frame.camera.position, direction);
  if (seen.oriented_face == none) return std::nullopt;
  return Surface{frame.camera.position + seen.distance * direction,
                 face_normal(scene_, seen.oriented_face)};
}

void PhotonInspector::draw(const Frame& frame, DisplayedFrame& shown) {
  if (picked_ == none || !frame.photons) return;
  if (!map_ || photons_ != frame.photons) {
    photons_ = frame.photons;
    map_ = view_of_map(scene_, *photons_, picked_);
  }
  draw_photon_map(shown, frame.camera,
                  visible_surfaces(rays(), frame.camera, shown.width, shown.height), *map_);
}

}  // namespace photile::view
