// Cubes of space near photons, each with a pair of maps.
#pragma once

#include <tsl/robin_map.h>

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "maps/build_maps.hpp"

namespace photile::cloud {

/// A lattice of cubes four reaches wide. A photon belongs to every cube within reach of it. Map 2 v
/// of cube v serves points whose normals lie on the side of its axis, map 2 v + 1 the others;
/// without normals map 2 v serves all.
class Voxels {
 public:
  /// Keeps no reference to an array.
  ///   normals         empty, or one per photon
  ///   radius          metres, of the search
  ///   angle_degrees   largest angle between normals
  Voxels(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals, double radius,
         double angle_degrees);

  /// The plan of their maps, whose candidate lists are one for each photon. Call once.
  maps::MapPlan take_plan() { return std::move(plan_); }
  /// Per photon: a map of the cube that it lies in.
  std::vector<std::uint32_t> take_own_maps() { return std::move(own_maps_); }

  /// The map that serves a point, `none` where no photon is near.
  std::uint32_t map_at(const glm::vec3& point, const glm::vec3& normal) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct CellHash {
    std::size_t operator()(const Cell& cell) const;
  };
  struct Voxel {
    glm::vec3 low, high;   ///< bounds of the photons that may be near
    glm::dvec3 lean{0.0};  ///< sum of absolute normals
    int axis = 2;          ///< across the plane of its maps
  };

  Cell cell_of(const glm::dvec3& point) const;
  std::uint32_t find_or_add(const Cell& cell);
  /// Calls visit(voxel) for each cube within reach of a photon.
  template <class Visit>
  void for_each_near(const glm::vec3& position, const Visit& visit);
  PhotileMapShape shape_of(const Cell& cell, const Voxel& voxel, bool normals) const;

  double reach_ = 0, width_ = 0, margin_ = 0;  ///< metres
  glm::dvec3 origin_{0.0};
  tsl::robin_map<Cell, std::uint32_t, CellHash> number_of_;
  std::vector<Cell> cells_;
  std::vector<Voxel> voxels_;
  std::vector<std::uint32_t> own_maps_;
  maps::MapPlan plan_;
};

}  // namespace photile::cloud
