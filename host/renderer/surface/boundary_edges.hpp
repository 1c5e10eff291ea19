// Edges that no other has both corners of, and those of them that run along each other.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "geometry/box_tree.hpp"

namespace photile::surface {

struct BoundaryEdge {
  glm::dvec3 from, to;  ///< metres
  std::uint32_t triangle;
};

/// Whether the edges lie on one line, within `tolerance`, and share more of it than twice that;
/// metres.
bool run_along(const BoundaryEdge& a, const BoundaryEdge& b, double tolerance);

/// Finds the edges that lie on one line and share some of it, among n in O(n^(5/3)) where they
/// cross a room in all directions.
class BoundaryEdges {
 public:
  /// \param tolerance metres, as that of run_along
  BoundaryEdges(std::vector<BoundaryEdge> edges, double tolerance);

  std::size_t size() const { return edges_.size(); }

  /// Calls visit(edge, other) for the edges that run along edge i and are longer, or as long and
  /// after it, once or more; of the two the first in the order of the edges comes first.
  template <class Visit>
  void visit_along(std::uint32_t i, const Visit& visit) const {
    // The shorter of two edges that run along each other has an end on the longer.
    for (const bool second : {false, true}) {
      const glm::vec3 end(second ? edges_[i].to : edges_[i].from);
      tree_.visit_within({end, end}, reach_ * reach_, [&](std::uint32_t piece) {
        const std::uint32_t j = edge_of_[piece];
        if (is_shorter(i, j) && may_run_along(i, j) && !(second && is_beside(edges_[i].from, j))) {
          const BoundaryEdge &a = edges_[std::min(i, j)], &b = edges_[std::max(i, j)];
          if (run_along(a, b, tolerance_)) visit(a, b);
        }
        return false;
      });
    }
  }

 private:
  struct Heading {
    glm::vec3 direction;
    float length;            ///< metres
    float most_sine_square;  ///< of the angle with a longer edge that it runs along
  };

  bool is_shorter(std::uint32_t i, std::uint32_t j) const {
    const float a = headings_[i].length, b = headings_[j].length;
    return a != b ? a < b : i < j;
  }
  /// Excludes all but a few pairs of edges that do not, at the cost of a product.
  bool may_run_along(std::uint32_t shorter, std::uint32_t longer) const {
    const glm::vec3 across = glm::cross(headings_[shorter].direction, headings_[longer].direction);
    return !(glm::dot(across, across) > headings_[shorter].most_sine_square);
  }
  /// Whether a point's foot on the edge's line is on the edge.
  bool is_beside(const glm::dvec3& point, std::uint32_t edge) const;
  void set_headings();
  /// \return the boxes of the edges' pieces
  std::vector<geometry::Box> cut();

  std::vector<BoundaryEdge> edges_;
  double tolerance_;    ///< metres
  float reach_ = 0.0f;  ///< metres from a piece of the longer edge to an end of the shorter
  std::vector<Heading> headings_;       ///< per edge
  std::vector<std::uint32_t> edge_of_;  ///< per piece
  geometry::BoxTree tree_;              ///< over pieces
};

}  // namespace photile::surface
