#include "photile/surface_index.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <span>

#include "geometry/box.hpp"
#include "geometry/radius_range.hpp"
#include "photile/errors.hpp"
#include "photile/scene_builder.hpp"
#include "scene/coincident_faces.hpp"
#include "surface/coplanar_regions.hpp"
#include "surface/open_fraction.hpp"
#include "surface/smooth_components.hpp"
#include "surface/surface_mesh.hpp"
#include "surface/surface_tree.hpp"
#include "surface/unlit_sides.hpp"

namespace photile {
namespace {

static_assert(sizeof(PhotileSurfaceNode) == 7 * 4 * PHOTILE_SURFACE_WIDTH);
static_assert(sizeof(PhotileSurfaceLeaf) == 18 * 4 * PHOTILE_SURFACE_WIDTH);

/// A leaf without a piece.
PhotileSurfaceLeaf empty_leaf() {
  PhotileSurfaceLeaf leaf{};
  for (int lane = 0; lane < PHOTILE_SURFACE_WIDTH; ++lane) {
    leaf.region[lane] = PHOTILE_NO_REGION;
    leaf.triangle[lane] = PHOTILE_PIECE_BORDER;
    leaf.front_component[lane] = leaf.back_component[lane] = PHOTILE_COMPONENT_UNLIT;
  }
  return leaf;
}

PhotileSurfaceLeaf leaf_of(const SurfaceIndex& index,
                           const std::vector<surface::SurfacePiece>& pieces,
                           const std::vector<std::uint32_t>& members) {
  PhotileSurfaceLeaf leaf = empty_leaf();
  for (std::size_t lane = 0; lane < members.size(); ++lane) {
    const surface::SurfacePiece& piece = pieces[members[lane]];
    const std::uint32_t triangle = piece.triangle & ~PHOTILE_PIECE_BORDER;
    const glm::vec3& normal = index.normal[oriented(triangle, 0)];
    leaf.a_x[lane] = piece.a.x, leaf.a_y[lane] = piece.a.y, leaf.a_z[lane] = piece.a.z;
    leaf.b_x[lane] = piece.b.x, leaf.b_y[lane] = piece.b.y, leaf.b_z[lane] = piece.b.z;
    leaf.c_x[lane] = piece.c.x, leaf.c_y[lane] = piece.c.y, leaf.c_z[lane] = piece.c.z;
    leaf.normal_x[lane] = normal.x, leaf.normal_y[lane] = normal.y, leaf.normal_z[lane] = normal.z;
    leaf.region[lane] = piece.region;
    leaf.triangle[lane] = piece.triangle;
    leaf.front_component[lane] = index.component[oriented(triangle, 0)];
    leaf.back_component[lane] = index.component[oriented(triangle, 1)];
    leaf.front_open_fraction[lane] = index.open_fraction[oriented(triangle, 0)];
    leaf.back_open_fraction[lane] = index.open_fraction[oriented(triangle, 1)];
    if (piece.unlit_side == none) continue;
    const bool front = side_of(piece.unlit_side) == 0;
    (front ? leaf.back_component : leaf.front_component)[lane] = PHOTILE_NO_COMPONENT;
    leaf.front_open_fraction[lane] = leaf.back_open_fraction[lane] = -1.0f;
  }
  return leaf;
}

/// Hits lie off the plane of their triangle, and corners of its parts, too, by roundings: by far
/// less than this part of the radius.
constexpr double part_margin = 1.0 / 64;

PartBounds bounds_of(std::span<const DarkPart> parts, float margin) {
  geometry::Box box;
  for (const DarkPart& part : parts) {
    for (const glm::vec3& corner : part.corner) box.extend(corner);
  }
  return {box.lower - margin, box.upper + margin};
}

/// Of each SurfaceIndex::bounded_together parts.
std::vector<PartBounds> bounds_of_blocks(std::span<const DarkPart> parts, float margin) {
  std::vector<PartBounds> bounds;
  while (!parts.empty()) {
    const std::size_t count = std::min<std::size_t>(SurfaceIndex::bounded_together, parts.size());
    bounds.push_back(bounds_of(parts.first(count), margin));
    parts = parts.subspan(count);
  }
  return bounds;
}

/// Where photons are given, with unlit regions.
SurfaceIndex index_of(const Scene& scene, const std::vector<std::uint32_t>& landed,
                      const Photons* photons, double radius, double angle_degrees) {
  check_scene(scene);
  check_radius(scene, radius);
  SurfaceIndex index;
  index.radius = radius;
  // Tolerances are in proportion to the radius. Beyond the scene there is no other surface.
  radius = std::min(radius, scene_diagonal(scene));
  index.angle_degrees = angle_degrees;
  surface::SurfaceMesh mesh(scene);
  const auto connections = surface::find_connections(mesh, radius, angle_degrees);
  const surface::SmoothComponents connected = surface::join_components(mesh, connections);
  index.dark = surface::find_unlit_sides(mesh, connections, connected, landed);
  const std::vector<DarkPart> hidden = surface::find_hidden_parts(
      mesh, scene::CoincidentFaces(scene), connected, landed, index.dark);
  const surface::SmoothComponents components =
      surface::join_components(mesh, connections, index.dark);
  const surface::CoplanarRegions regions = surface::find_coplanar_regions(mesh, radius, index.dark);
  const surface::PlaneTree planes(mesh, regions);
  index.component = components.of;
  index.components = components.count;
  index.normal.resize(2 * scene.triangle_count());
  tbb::parallel_for(std::size_t{0}, index.normal.size(), [&](std::size_t s) {
    const glm::dvec3& normal = mesh.normal[s / 2];
    index.normal[s] = glm::vec3(s % 2 == 0 ? normal : -normal);
  });
  index.open_fraction = surface::find_open_fractions(
      mesh, regions, components, lit_components(index, landed), radius, angle_degrees);
  index.region = regions.of_triangle;
  if (photons != nullptr) {
    index.unlit_regions = surface::find_unlit_regions(mesh, *photons, index.dark, hidden, radius);
    // Faces whose area counts only in part for most hits keep no unlit regions.
    std::erase_if(index.unlit_regions, [&](const DarkPart& part) {
      return index.open_fraction[part.oriented_face] < 1;
    });
    index.unlit_bounds =
        bounds_of_blocks(index.unlit_regions, static_cast<float>(part_margin * radius));
    index.first_unlit_region.resize(2 * scene.triangle_count() + 1);
    std::size_t next = 0;
    for (std::size_t s = 0; s < index.first_unlit_region.size(); ++s) {
      while (next < index.unlit_regions.size() && index.unlit_regions[next].oriented_face < s)
        ++next;
      index.first_unlit_region[s] = static_cast<std::uint32_t>(next);
    }
  }
  const auto pieces =
      surface::find_pieces(mesh, regions, planes, index.unlit_regions, radius, angle_degrees);
  index.original = std::move(mesh.original);
  surface::SurfaceTree tree = surface::build_surface_tree(pieces);
  index.nodes = std::move(tree.nodes);
  index.leaves.resize(tree.leaves.size());
  tbb::parallel_for(std::size_t{0}, tree.leaves.size(), [&](std::size_t i) {
    index.leaves[i] = leaf_of(index, pieces, tree.leaves[i]);
  });
  return index;
}

}  // namespace

SurfaceIndex index_surface(const Scene& scene, const std::vector<std::uint32_t>& landed,
                           double radius, double angle_degrees) {
  return index_of(scene, landed, nullptr, radius, angle_degrees);
}

SurfaceIndex index_surface(const Scene& scene, const Photons& photons, double radius,
                           double angle_degrees) {
  return index_of(scene, landed_on(scene, photons), &photons, radius, angle_degrees);
}

std::uint64_t SurfaceIndex::bytes() const {
  return (original.size() + region.size() + component.size()) * sizeof(std::uint32_t) +
         dark.size() + unlit_regions.size() * sizeof(DarkPart) +
         first_unlit_region.size() * sizeof(std::uint32_t) +
         unlit_bounds.size() * sizeof(PartBounds) +
         normal.size() * (sizeof(glm::vec3) + sizeof(float)) + nodes.size() * sizeof(nodes[0]) +
         leaves.size() * sizeof(leaves[0]);
}

namespace {

/// Whether the point above or below which `position` lies is on the part; `normal`: of its face.
bool lies_on(const DarkPart& part, const glm::vec3& normal, const glm::vec3& position) {
  const glm::dvec3 n(normal), p(position);
  bool left = true, right = true;
  for (std::size_t c = 0; c < 3 && (left || right); ++c) {
    const glm::dvec3 from(part.corner[c]), to(part.corner[(c + 1) % 3]);
    const double turn = glm::dot(n, glm::cross(to - from, p - from));
    left = left && turn >= 0;
    right = right && turn <= 0;
  }
  return left || right;
}

}  // namespace

std::uint32_t SurfaceIndex::component_at(std::uint32_t s, const glm::vec3& position) const {
  const std::uint32_t own = original[s];
  if (first_unlit_region.empty()) return component[own];
  const std::uint32_t end = first_unlit_region[own + 1];
  for (std::uint32_t i = first_unlit_region[own]; i < end;) {
    const std::uint32_t block = i / bounded_together;
    const std::uint32_t end_of_block = std::min(end, (block + 1) * bounded_together);
    if (!unlit_bounds[block].contain(position)) i = end_of_block;
    for (; i < end_of_block; ++i) {
      if (lies_on(unlit_regions[i], normal[own], position)) return PHOTILE_UNLIT_REGION;
    }
  }
  return component[own];
}

std::vector<std::uint32_t> landed_on(const Scene& scene, const Photons& photons) {
  if (photons.of_all) return photons.of_all->landed;
  std::vector<std::uint32_t> landed(2 * scene.triangle_count(), 0);
  for (const std::uint32_t s : photons.oriented_face) {
    if (s >= landed.size()) {
      throw InputError(fmt::format("{}: a photon lies on oriented face {} of {}",
                                   scene.source.string(), s, landed.size()));
    }
    ++landed[s];
  }
  return landed;
}

std::vector<std::uint8_t> lit_components(const SurfaceIndex& surface,
                                         const std::vector<std::uint32_t>& landed) {
  std::vector<std::uint8_t> lit(surface.components, 0);
  for (std::size_t s = 0; s < landed.size(); ++s) {
    if (landed[s] != 0 && surface.dark[s] == 0) lit[surface.component[s]] = 1;
  }
  return lit;
}

}  // namespace photile
