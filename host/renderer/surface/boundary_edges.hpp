// Edges that share both corners with no other edge, and those of them that run along each other.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "geometry/box_tree.hpp"
#include "photile/scene.hpp"

namespace photile::surface {

struct BoundaryEdge {
  glm::dvec3 from, to;  ///< metres
  std::uint32_t triangle;
};

/// Whether the edges lie on one line, within `tolerance`, and share more of it than twice that;
/// metres.
bool run_along(const BoundaryEdge& a, const BoundaryEdge& b, double tolerance);

/// Finds the edges that lie on one line and share some of it. Edges of similar directions are in
/// one tree, separate from others: those that meet in a point, as the blades of a fan do, are
/// separated by it.
class BoundaryEdges {
 public:
  /// At most this many edges that run along an edge are found from either end. More edges within
  /// the tolerance bound no real surface, and testing all pairs would take too long.
  static constexpr int most_along = 64;

  /// \param tolerance metres, as that of run_along
  BoundaryEdges(std::vector<BoundaryEdge> edges, double tolerance);

  std::size_t size() const { return edges_.size(); }

  /// Calls visit(edge, other) for the edges that run along edge i and are longer, or as long and
  /// after it, once or more, up to `most_along`; of the two the first in the order of the edges
  /// comes first.
  template <class Visit>
  void visit_along(std::uint32_t i, const Visit& visit) const {
    if (is_too_short(i)) return;
    // The shorter of two edges that run along each other has an end on the longer.
    for (const bool second : {false, true}) {
      const glm::vec3 end(second ? edges_[i].to : edges_[i].from);
      int found = 0;
      for_each_bundle(headings_[i], [&](const Bundle& bundle) {
        bundle.tree.visit_within({end, end}, reach_ * reach_, [&](std::uint32_t piece) {
          const std::uint32_t j = bundle.edge_of[piece];
          if (is_shorter(i, j) && may_run_along(i, j) &&
              !(second && is_beside(edges_[i].from, j))) {
            const BoundaryEdge &a = edges_[std::min(i, j)], &b = edges_[std::max(i, j)];
            if (run_along(a, b, tolerance_)) {
              visit(a, b);
              ++found;
            }
          }
          return found >= most_along;
        });
      });
    }
  }

 private:
  struct Heading {
    glm::vec3 direction;
    float length;            ///< metres
    float most_sine_square;  ///< of the angle with a longer edge that it runs along
  };

  /// Pieces of edges whose directions are alike, to and fro.
  struct Bundle {
    std::vector<geometry::Box> boxes;    ///< of pieces
    std::vector<std::uint32_t> edge_of;  ///< per piece
    geometry::BoxTree tree;              ///< over pieces
  };

  /// The number of cells across a cube by which directions are distinguished; two opposite sides of
  /// the cube are one.
  static constexpr int cells_across = 16;
  static int cell_along(float position) {
    // Written so that a NaN has a cell, too.
    return position > -1.0f
               ? static_cast<int>(std::min(0.5f * (position + 1.0f), 0.9999f) * cells_across)
               : 0;
  }
  static std::size_t cell_at(int axis, int u, int v) {
    return static_cast<std::size_t>((axis * cells_across + u) * cells_across + v);
  }

  /// They share less than run_along requires.
  bool is_too_short(std::uint32_t i) const {
    return headings_[i].length < 1.99f * static_cast<float>(tolerance_);
  }
  /// Whether what may run along it has directions of few cells.
  static bool is_long(const Heading& heading) { return heading.most_sine_square < 1e-3f; }

  /// Calls visit(bundle) for all that may hold an edge that runs along one of this heading, which
  /// is the shorter.
  template <class Visit>
  void for_each_bundle(const Heading& heading, const Visit& visit) const {
    constexpr float least_of_axis = 0.577f;  // of the longest part of a direction
    if (!is_long(heading)) {
      visit(bundles_.front());
      return;
    }
    const float sine = std::sqrt(heading.most_sine_square);
    for (int axis = 0; axis < 3; ++axis) {
      const float along = heading.direction[axis];
      if (std::abs(along) < least_of_axis - 1.1f * sine) continue;
      const float u = heading.direction[(axis + 1) % 3] / along;
      const float v = heading.direction[(axis + 2) % 3] / along;
      // The difference of two such quotients is a part of the directions' cross product, over the
      // product of two parts of which none is below 0.46.
      const float reach = 5.0f * sine + 1e-5f;
      for (int i = cell_along(u - reach); i <= cell_along(u + reach); ++i) {
        for (int j = cell_along(v - reach); j <= cell_along(v + reach); ++j) {
          const std::uint32_t bundle = bundle_of_[cell_at(axis, i, j)];
          if (bundle != none) visit(bundles_[bundle]);
        }
      }
    }
  }

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
  Bundle& bundle_with(const Heading& heading);
  void cut();

  std::vector<BoundaryEdge> edges_;
  double tolerance_;    ///< metres
  float reach_ = 0.0f;  ///< metres from a piece of the longer edge to an end of the shorter
  std::vector<Heading> headings_;         ///< per edge
  std::vector<Bundle> bundles_;           ///< the first is of all directions, where it is asked
  std::vector<std::uint32_t> bundle_of_;  ///< per cell, or none
};

}  // namespace photile::surface
