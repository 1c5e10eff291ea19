#include "photile/surface_index.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "geometry/radius_range.hpp"
#include "photile/errors.hpp"
#include "photile/scene_builder.hpp"
#include "surface/exposure.hpp"
#include "surface/facets.hpp"
#include "surface/sheets.hpp"
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
    leaf.facet[lane] = PHOTILE_NO_FACET;
    leaf.triangle[lane] = PHOTILE_PIECE_BORDER;
    leaf.front_sheet[lane] = leaf.back_sheet[lane] = PHOTILE_SHEET_UNLIT;
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
    leaf.facet[lane] = piece.facet;
    leaf.triangle[lane] = piece.triangle;
    leaf.front_sheet[lane] = index.sheet[oriented(triangle, 0)];
    leaf.back_sheet[lane] = index.sheet[oriented(triangle, 1)];
    leaf.front_exposure[lane] = index.exposure[oriented(triangle, 0)];
    leaf.back_exposure[lane] = index.exposure[oriented(triangle, 1)];
    if (piece.unlit_side == none) continue;
    const bool front = side_of(piece.unlit_side) == 0;
    leaf.front_sheet[lane] = front ? index.sheets : PHOTILE_NO_SHEET;
    leaf.back_sheet[lane] = front ? PHOTILE_NO_SHEET : index.sheets;
    leaf.front_exposure[lane] = leaf.back_exposure[lane] = -1.0f;
  }
  return leaf;
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
  index.dark =
      surface::find_unlit_sides(mesh, connections, surface::join_sheets(mesh, connections), landed);
  const surface::Sheets sheets = surface::join_sheets(mesh, connections, index.dark);
  const surface::Facets facets = surface::find_facets(mesh, radius, index.dark);
  const surface::PlaneTree planes(mesh, facets);
  index.sheet = sheets.of;
  index.sheets = sheets.count;
  index.normal.resize(2 * scene.triangle_count());
  tbb::parallel_for(std::size_t{0}, index.normal.size(), [&](std::size_t s) {
    const glm::dvec3& normal = mesh.normal[s / 2];
    index.normal[s] = glm::vec3(s % 2 == 0 ? normal : -normal);
  });
  index.exposure = surface::find_exposure(mesh, facets, sheets, lit_sheets(index, landed), radius,
                                          angle_degrees);
  index.facet = facets.of_triangle;
  if (photons != nullptr) {
    index.unlit_regions = surface::find_unlit_regions(mesh, *photons, index.dark, radius);
    // What counts in part for most hits has no holes for others.
    std::erase_if(index.unlit_regions,
                  [&](const DarkPart& part) { return index.exposure[part.oriented_face] < 1; });
    index.first_unlit_region.resize(2 * scene.triangle_count() + 1);
    std::size_t next = 0;
    for (std::size_t s = 0; s < index.first_unlit_region.size(); ++s) {
      while (next < index.unlit_regions.size() && index.unlit_regions[next].oriented_face < s)
        ++next;
      index.first_unlit_region[s] = static_cast<std::uint32_t>(next);
    }
  }
  const auto pieces =
      surface::find_pieces(mesh, facets, planes, index.unlit_regions, radius, angle_degrees);
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
  return (original.size() + facet.size() + sheet.size()) * sizeof(std::uint32_t) + dark.size() +
         unlit_regions.size() * sizeof(DarkPart) +
         first_unlit_region.size() * sizeof(std::uint32_t) +
         normal.size() * (sizeof(glm::vec3) + sizeof(float)) + nodes.size() * sizeof(nodes[0]) +
         leaves.size() * sizeof(leaves[0]);
}

std::uint32_t SurfaceIndex::sheet_at(std::uint32_t s, const glm::vec3& position) const {
  const std::uint32_t own = original[s];
  if (first_unlit_region.empty()) return sheet[own];
  for (std::uint32_t i = first_unlit_region[own]; i < first_unlit_region[own + 1]; ++i) {
    const auto& corner = unlit_regions[i].corner;
    const glm::dvec3 n(normal[own]), p(position);
    int left = 0, right = 0;
    for (int c = 0; c < 3; ++c) {
      const glm::dvec3 from(corner[c]), to(corner[(c + 1) % 3]);
      const double turn = glm::dot(n, glm::cross(to - from, p - from));
      left += turn >= 0, right += turn <= 0;
    }
    if (left == 3 || right == 3) return sheets;
  }
  return sheet[own];
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

std::vector<std::uint8_t> lit_sheets(const SurfaceIndex& surface,
                                     const std::vector<std::uint32_t>& landed) {
  std::vector<std::uint8_t> lit(surface.sheets + 1, 0);
  lit.back() = 1;
  for (std::size_t s = 0; s < landed.size(); ++s) {
    if (landed[s] != 0 && surface.dark[s] == 0) lit[surface.sheet[s]] = 1;
  }
  return lit;
}

}  // namespace photile
