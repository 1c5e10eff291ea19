#include "surface/unlit_sides.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>

#include "common/touched_memory.hpp"
#include "geometry/disjoint_sets.hpp"
#include "photile/device/surface.h"
#include "surface/smooth_components.hpp"

namespace photile::surface {

namespace {

constexpr double least_on_a_piece = 40;    ///< photons, of what is judged together
constexpr double least_of_a_triangle = 5;  ///< of them: e^-5 of such are empty by chance

}  // namespace

std::vector<std::uint8_t> find_unlit_sides(const SurfaceMesh& mesh,
                                           std::span<const Connection> connections,
                                           const SmoothComponents& components,
                                           std::span<const std::uint32_t> landed) {
  const std::size_t sides = mesh.original.size();
  std::vector<std::uint64_t> found(sides, 0);  // of originals, with what coincides with them
  for (std::size_t s = 0; s < sides; ++s) found[mesh.original[s]] += landed[s];
  std::vector<double> area(sides / 2), area_of_component(components.count, 0.0);
  std::vector<std::uint64_t> found_on_component(components.count, 0);
  for (std::uint32_t t = 0; t < area.size(); ++t) {
    if (!mesh.counts(t)) continue;
    area[t] = triangle_area(mesh.scene, t);
    for (const std::uint32_t s : {oriented(t, 0), oriented(t, 1)}) {
      area_of_component[components.of[s]] += area[t];
      found_on_component[components.of[s]] += found[s];
    }
  }
  const auto expected = [&](std::uint32_t s) {
    const std::uint32_t component = components.of[s];
    return static_cast<double>(found_on_component[component]) * area[triangle_of(s)] /
           area_of_component[component];
  };
  const auto nearly_empty = [](std::uint64_t count, double of) {
    return static_cast<double>(count) <= most_found_in_the_dark * of;
  };

  std::vector<std::uint8_t> dark(sides, 0);
  for (std::uint32_t s = 0; s < sides; ++s) {
    if (mesh.original[s] != s) continue;
    const double photons = expected(s);
    dark[s] = photons >= least_of_a_triangle && nearly_empty(found[s], photons) ? 1 : 0;
  }
  geometry::DisjointSets pieces(sides);
  for_each_pair_of_sides(connections, [&](std::uint32_t a, std::uint32_t b) {
    if (dark[a] != 0 && dark[b] != 0) pieces.join(a, b);
  });
  std::vector<double> expected_on_piece(sides, 0.0);
  for (std::uint32_t s = 0; s < sides; ++s) {
    if (dark[s] != 0) expected_on_piece[pieces.find(s)] += expected(s);
  }
  for (std::uint32_t s = 0; s < sides; ++s) {
    const std::uint32_t original = mesh.original[s];
    dark[s] = dark[original] != 0 && expected_on_piece[pieces.find(original)] >= least_on_a_piece;
  }
  return dark;
}

std::vector<DarkPart> find_hidden_parts(const SurfaceMesh& mesh,
                                        const scene::CoincidentFaces& coincident,
                                        const SmoothComponents& components,
                                        std::span<const std::uint32_t> landed,
                                        std::vector<std::uint8_t>& dark) {
  if (coincident.empty()) return {};
  std::vector<std::uint8_t> lit(components.count, 0);
  for (std::size_t s = 0; s < landed.size(); ++s) {
    if (landed[s] != 0) lit[components.of[s]] = 1;
  }
  std::vector<DarkPart> parts;
  for (std::uint32_t s = 0; s < landed.size(); ++s) {
    const std::span<const std::uint32_t> others = coincident.before(s);
    if (others.empty() || dark[s] != 0 || lit[components.of[s]] == 0) continue;
    if (std::any_of(others.begin(), others.end(), [&](std::uint32_t other) {
          return mesh.original[other] == mesh.original[s];
        })) {
      continue;
    }
    const auto of_side = coincident.parts_of(mesh.scene, s);
    if (of_side.counted.empty()) {
      dark[s] = 1;
      continue;
    }
    for (const auto& part : of_side.hidden) parts.push_back({part, s});
  }
  return parts;
}

namespace {

constexpr double least_on_a_half = 12;     ///< photons, as dense as on the denser half of the whole
constexpr std::size_t least_found = 10;    ///< on a triangle: by chance they lie on one half in 500
constexpr double least_of_a_disc = 0.001;  ///< area of a half

using FlatCorners = std::array<glm::dvec2, 3>;  ///< in the plane of the triangle

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Brings the positions for which `is_first` holds before the others; returns how many they are. On
/// which side of a cut photons lie cannot be foreseen: std::partition, which branches, takes four
/// times as long.
template <class IsFirst>
std::size_t partition(std::span<glm::dvec2> points, const IsFirst& is_first) {
  std::size_t first = 0;
  for (glm::dvec2& here : points) {
    const glm::dvec2 point = here;
    here = points[first];
    points[first] = point;
    first += is_first(point) ? 1 : 0;
  }
  return first;
}

class PartFinder {
 public:
  PartFinder(const SurfaceMesh& mesh, const Photons& photons, double least_area)
      : mesh_(mesh), photons_(photons), least_area_(least_area) {}

  void find_on(std::uint32_t s, std::vector<DarkPart>& parts) const {
    const std::uint32_t first = photons_.first_of[s], last = photons_.first_of[s + 1];
    if (last - first < least_found) return;
    const std::uint32_t triangle = triangle_of(s);
    const double area = triangle_area(mesh_.scene, triangle);
    if (!(area >= 2 * least_area_)) return;
    const auto corners = mesh_.scene.corners(triangle);
    const glm::dvec3 origin(corners[0]);
    const glm::dvec3 u = glm::normalize(glm::dvec3(corners[1]) - origin);
    const glm::dvec3 v = glm::cross(mesh_.normal[triangle], u);
    const auto in_plane = [&](const glm::vec3& p) {
      const glm::dvec3 offset = glm::dvec3(p) - origin;
      return glm::dvec2(glm::dot(offset, u), glm::dot(offset, v));
    };
    std::vector<glm::dvec2> points;
    points.reserve(last - first);
    for (std::uint32_t i = first; i < last; ++i) points.push_back(in_plane(photons_.position[i]));
    std::vector<FlatCorners> found;
    halve({in_plane(corners[0]), in_plane(corners[1]), in_plane(corners[2])}, points,
          (last - first) / area, found);
    for (const FlatCorners& part : found) {
      const auto at = [&](const glm::dvec2& p) { return glm::vec3(origin + p.x * u + p.y * v); };
      parts.push_back({{at(part[0]), at(part[1]), at(part[2])}, s});
    }
  }

 private:
  /// Looks for unlit regions of a triangle.
  ///   density   of photons where light falls, to a square metre
  void halve(FlatCorners corner, std::span<glm::dvec2> points, double density,
             std::vector<FlatCorners>& found) const {
    const double area =
        std::abs(cross(corner[1] - corner[0], corner[2] - corner[0])) / 4;  // a half
    const double expected = density * area;
    if (expected < least_on_a_half || points.size() < least_found || area < least_area_) return;
    const auto length = [&](int i) { return glm::distance(corner[i], corner[(i + 1) % 3]); };
    int longest = 0;
    for (const int i : {1, 2}) {
      if (length(i) > length(longest)) longest = i;
    }
    std::rotate(corner.begin(), corner.begin() + longest, corner.end());
    const auto& [a, b, c] = corner;
    const glm::dvec2 middle = 0.5 * (a + b), cut = middle - c;
    const double side_of_a = cross(cut, a - c);
    const glm::dvec2 apex = c;  // a copy: what is written to positions cannot change it
    const std::size_t split = partition(points, [cut, apex, side_of_a](const glm::dvec2& p) {
      return cross(cut, p - apex) * side_of_a >= 0;
    });
    const std::array<FlatCorners, 2> halves{{{c, a, middle}, {b, c, middle}}};
    const std::array<std::span<glm::dvec2>, 2> parts{points.first(split), points.subspan(split)};
    const double denser = static_cast<double>(std::max(parts[0].size(), parts[1].size())) / area;
    for (int i = 0; i < 2; ++i) {
      if (static_cast<double>(parts[i].size()) <= most_found_in_the_dark * expected) {
        found.push_back(halves[i]);
      } else {
        halve(halves[i], parts[i], denser, found);
      }
    }
  }

  const SurfaceMesh& mesh_;
  const Photons& photons_;
  double least_area_;
};

}  // namespace

std::vector<DarkPart> find_unlit_regions(const SurfaceMesh& mesh, const Photons& photons,
                                         std::span<const std::uint8_t> dark,
                                         std::vector<DarkPart> hidden, double radius) {
  const std::size_t sides = mesh.original.size();
  // Photons on coincident triangles may lie on either: which part of one is empty says nothing.
  std::vector<std::uint8_t> shared(sides, 0);
  for (std::uint32_t s = 0; s < sides; ++s) {
    if (mesh.original[s] != s) shared[s] = shared[mesh.original[s]] = 1;
  }
  for (const DarkPart& part : hidden) shared[part.oriented_face] = 1;
  const PartFinder finder(mesh, photons, least_of_a_disc * glm::pi<double>() * radius * radius);
  std::vector<std::vector<DarkPart>> of_side(sides);
  tbb::parallel_for(std::size_t{0}, sides, [&](std::size_t i) {
    const auto s = static_cast<std::uint32_t>(i);
    const bool answers = !photons.of_all || photons.of_all->own[s] != 0;
    if (answers && shared[s] == 0 && dark[s] == 0) finder.find_on(s, of_side[s]);
  });
  std::vector<DarkPart> parts = joined(
      sides, [&](std::size_t side) -> const auto& { return of_side[side]; });
  if (photons.of_all) parts = photons.of_all->processes->gather_values<DarkPart>(parts);
  if (!photons.of_all && hidden.empty()) return parts;
  parts.insert(parts.end(), hidden.begin(), hidden.end());
  std::stable_sort(parts.begin(), parts.end(), [](const DarkPart& a, const DarkPart& b) {
    return a.oriented_face < b.oriented_face;
  });
  return parts;
}

namespace {

/// Tells for a triangle whether another plane of similar normal comes near it.
class NearbyPlanes {
 public:
  NearbyPlanes(const SurfaceMesh& mesh, const PlaneTree& planes, double radius,
               double angle_degrees)
      : mesh_(mesh),
        planes_(planes),
        radius_(radius),
        // Rather a triangle too many than one too few where the kernels round.
        least_cosine_(std::cos(glm::radians(angle_degrees)) - 1e-5) {}

  bool near(std::uint32_t triangle) const {
    bool found = false;
    planes_.visit_others(
        triangle, geometry::triangle_box(mesh_.scene, triangle), radius_, [&](std::uint32_t other) {
          const double cosine = glm::dot(mesh_.normal[triangle], mesh_.normal[other]);
          return found = !(std::abs(cosine) < least_cosine_);
        });
    return found;
  }

 private:
  const SurfaceMesh& mesh_;
  const PlaneTree& planes_;
  double radius_, least_cosine_;
};

SurfacePiece border_piece(const BorderEdge& edge, std::uint32_t region) {
  SurfacePiece piece{.a = edge.from,
                     .b = edge.to,
                     .c = edge.inward,
                     .region = region,
                     .triangle = edge.triangle | PHOTILE_PIECE_BORDER};
  piece.box.extend(edge.from);
  piece.box.extend(edge.to);
  return piece;
}

}  // namespace

std::vector<SurfacePiece> find_pieces(const SurfaceMesh& mesh, const CoplanarRegions& regions,
                                      const PlaneTree& planes,
                                      std::span<const DarkPart> unlit_regions, double radius,
                                      double angle_degrees) {
  const NearbyPlanes nearby(mesh, planes, radius, angle_degrees);
  std::vector<std::uint8_t> is_piece(mesh.normal.size(), 0);
  tbb::parallel_for(std::size_t{0}, is_piece.size(), [&](std::size_t i) {
    const auto triangle = static_cast<std::uint32_t>(i);
    if (!mesh.counts(triangle)) return;
    is_piece[i] = regions.of_triangle[i] == PHOTILE_NO_REGION || nearby.near(triangle);
  });
  std::vector<SurfacePiece> pieces;
  for (const BorderEdge& edge : regions.borders) {
    pieces.push_back(border_piece(edge, regions.of_triangle[edge.triangle]));
  }
  for (const DarkPart& part : unlit_regions) {
    const auto& [a, b, c] = part.corner;
    SurfacePiece piece{.a = a,
                       .b = b,
                       .c = c,
                       .region = PHOTILE_NO_REGION,
                       .triangle = triangle_of(part.oriented_face),
                       .unlit_side = part.oriented_face};
    for (const glm::vec3& corner : part.corner) piece.box.extend(corner);
    pieces.push_back(piece);
  }
  for (std::uint32_t t = 0; t < is_piece.size(); ++t) {
    if (is_piece[t] == 0) continue;
    const auto [a, b, c] = mesh.scene.corners(t);
    pieces.push_back({.box = geometry::triangle_box(mesh.scene, t),
                      .a = a,
                      .b = b,
                      .c = c,
                      .region = regions.of_triangle[t],
                      .triangle = t});
  }
  return pieces;
}

}  // namespace photile::surface
