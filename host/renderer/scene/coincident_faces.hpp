// Coincident faces: where several triangles of one plane overlap, which of them counts on either
// side.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "common/index_rows.hpp"
#include "photile/scene.hpp"

namespace photile::scene {

/// Triangles overlap where their planes agree within rounding and they share an area. At each point
/// one oriented face counts among those that face the same way: a front, or a back where no front
/// faces that way; among several, a light, then the first in the order of the file. Two fronts that
/// face away from each other are thus the two sides of one surface, each with its own material.
class CoincidentFaces {
 public:
  CoincidentFaces() = default;
  explicit CoincidentFaces(const Scene& scene);

  bool empty() const { return before_.items.empty(); }

  /// Whether faces count before either side of a triangle: asked at each hit, of rows that lie side
  /// by side.
  bool overlap(std::uint32_t triangle) const {
    return !empty() &&
           before_.first[oriented(triangle, 0)] != before_.first[oriented(triangle, 1) + 1];
  }

  /// The oriented faces that count before this one where they overlap it, the first one first.
  std::span<const std::uint32_t> before(std::uint32_t oriented_face) const {
    return empty() ? std::span<const std::uint32_t>() : before_.of(oriented_face);
  }

  /// The oriented face that counts at a point of this one.
  ///   position   metres
  std::uint32_t at(const Scene& scene, std::uint32_t oriented_face,
                   const glm::dvec3& position) const;

  using Part = std::array<glm::vec3, 3>;

  /// An oriented face, divided into triangles that do not overlap.
  struct Parts {
    std::vector<Part> counted;  ///< where it counts
    std::vector<Part> hidden;   ///< where others count
  };
  Parts parts_of(const Scene& scene, std::uint32_t oriented_face) const;

 private:
  IndexRows before_;  ///< per oriented face; no rows where no triangles overlap
};

}  // namespace photile::scene
