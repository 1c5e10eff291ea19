// Builds the scene's indexed triangle soup, in canonical order, from loose triangles.
#pragma once

#include <tsl/robin_map.h>
#include <tsl/robin_set.h>

#include <array>
#include <cstdint>
#include <memory>

#include "common/content_hash.hpp"
#include "photile/scene.hpp"

namespace photile::scene {

/// One corner as the file gives it, in world space.
struct Corner {
  glm::dvec3 position{0.0};
  glm::dvec2 uv{0.0};
  glm::dvec3 normal{0.0};  ///< any length; zero when the file has none
  glm::dvec2 emission_uv{0.0};
  glm::dvec3 tangent{0.0};  ///< any length; zero when the file has none
  double handedness = 1.0;  ///< its sign is that of the bitangent along normal x tangent
};

/// The attributes of corners that materials need.
struct CornerNeeds {
  bool uv = false, emission_uv = false, normals = false, tangents = false;
};

/// Appends triangles to a scene. Positions are rounded to float and welded where their bits agree;
/// vertices are numbered in the order in which canonical corners are met, so nothing but
/// `front_side` and the signs of shading normals depends on the winding.
class MeshBuilder {
 public:
  MeshBuilder(Scene& scene, const CornerNeeds& needs);

  /// Adds a triangle whose front is the side from which `corners` run counter-clockwise. Triangles
  /// with a corner that is not finite or beyond limits::max_coordinate, triangles without area and
  /// duplicates are counted and left out; it then returns false. `light` is an area light's index,
  /// or `none`. Errors: InputError beyond a limit.
  bool add(const std::array<Corner, 3>& corners, std::uint32_t material, std::uint32_t light);

  /// Adds attributes that triangles need from now on; earlier triangles get zeros.
  void also_need(const CornerNeeds& needs);

  /// Drops normals and tangents when the file turned out to have none.
  void finish();

 private:
  /// Numbers of triangles by their corners and the side that is the front.
  struct TriangleHash {
    const Scene* scene;
    std::size_t operator()(std::uint32_t triangle) const;
  };
  struct TriangleEqual {
    const Scene* scene;
    bool operator()(std::uint32_t a, std::uint32_t b) const;
  };

  std::uint32_t vertex_index(const glm::vec3& position);
  bool is_duplicate(std::uint32_t triangle, const std::array<const Corner*, 3>& sorted);
  bool repeats(std::uint32_t other, std::uint32_t triangle,
               const std::array<const Corner*, 3>& sorted) const;
  void add_normals(const std::array<const Corner*, 3>& sorted, double sign);
  void add_tangents(const std::array<const Corner*, 3>& sorted, double sign);

  Scene& scene_;
  CornerNeeds needs_;
  bool any_normal_ = false, any_tangent_ = false;
  tsl::robin_map<glm::vec3, std::uint32_t, BytesHash> index_of_position_;
  /// Triangles, with their hashes; comparing two of them looks up their corners.
  tsl::robin_set<std::uint32_t, TriangleHash, TriangleEqual, std::allocator<std::uint32_t>, true>
      distinct_;
  tsl::robin_set<std::uint32_t>
      both_sides_;  ///< triangles that a second one with the other winding repeats
};

}  // namespace photile::scene
