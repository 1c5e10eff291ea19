#include "surface/boundary_edges.hpp"

#include <algorithm>
#include <utility>

namespace photile::surface {

bool run_along(const BoundaryEdge& a, const BoundaryEdge& b, double tolerance) {
  const glm::dvec3 along = glm::normalize(a.to - a.from);
  const auto offset = [&](const glm::dvec3& p) {
    const glm::dvec3 d = p - a.from;
    return glm::length(d - along * glm::dot(d, along));
  };
  if (!(offset(b.from) <= tolerance) || !(offset(b.to) <= tolerance)) return false;
  const double first = glm::dot(b.from - a.from, along), last = glm::dot(b.to - a.from, along);
  const double shared = std::min(std::max(first, last), glm::length(a.to - a.from)) -
                        std::max(std::min(first, last), 0.0);
  return shared > 2 * tolerance;
}

BoundaryEdges::BoundaryEdges(std::vector<BoundaryEdge> edges, double tolerance)
    : edges_(std::move(edges)),
      tolerance_(tolerance),
      bundle_of_(cell_at(3, 0, 0), std::uint32_t{none}) {
  set_headings();
  cut();
  for (Bundle& bundle : bundles_) bundle.tree = geometry::BoxTree(bundle.boxes);
}

void BoundaryEdges::set_headings() {
  headings_.reserve(edges_.size());
  for (const BoundaryEdge& edge : edges_) {
    const glm::dvec3 along = edge.to - edge.from;
    const double length = glm::length(along);
    // Its ends are as far apart, across the other, as their distances from it allow.
    constexpr double rounding = 1e-6;
    const double sine = 2 * tolerance_ / length + rounding;
    headings_.push_back(
        {glm::vec3(along / length), static_cast<float>(length), static_cast<float>(sine * sine)});
  }
}

BoundaryEdges::Bundle& BoundaryEdges::bundle_with(const Heading& heading) {
  const glm::vec3 size = glm::abs(heading.direction);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const float along = heading.direction[axis];
  std::uint32_t& bundle =
      bundle_of_[cell_at(axis, cell_along(heading.direction[(axis + 1) % 3] / along),
                         cell_along(heading.direction[(axis + 2) % 3] / along))];
  if (bundle == none) {
    bundle = static_cast<std::uint32_t>(bundles_.size());
    bundles_.emplace_back();
  }
  return bundles_[bundle];
}

/// A long edge across all axes has a box that is nearly empty, and its pieces have not: at most
/// about eight of each edge.
void BoundaryEdges::cut() {
  bundles_.emplace_back();
  bool any_short = false;
  for (std::uint32_t i = 0; i < edges_.size(); ++i) {
    any_short = any_short || (!is_too_short(i) && !is_long(headings_[i]));
  }
  geometry::Box bounds;
  for (const BoundaryEdge& edge : edges_) {
    bounds.extend(glm::vec3(edge.from));
    bounds.extend(glm::vec3(edge.to));
  }
  // Four times the distance at which edges would stand that filled the bounds evenly.
  const double across = glm::length(glm::dvec3(bounds.size()));
  const double per_length = std::min(8.0, 0.25 * std::cbrt(static_cast<double>(edges_.size())));
  const double longest = std::max(across / per_length, 16 * tolerance_);
  float largest = 0.0f;  // coordinate: pieces end at rounded positions
  for (std::uint32_t i = 0; i < edges_.size(); ++i) {
    if (is_too_short(i)) continue;
    const BoundaryEdge& edge = edges_[i];
    const double length = glm::distance(edge.from, edge.to);
    const int count = longest > 0 ? 1 + static_cast<int>(length / longest) : 1;
    Bundle& bundle = bundle_with(headings_[i]);
    for (int piece = 0; piece < count; ++piece) {
      geometry::Box& box = bundle.boxes.emplace_back();
      for (const int end : {piece, piece + 1})
        box.extend(glm::vec3(glm::mix(edge.from, edge.to, static_cast<double>(end) / count)));
      for (int axis = 0; axis < 3; ++axis)
        largest = std::max({largest, std::abs(box.lower[axis]), std::abs(box.upper[axis])});
      bundle.edge_of.push_back(i);
      if (!any_short) continue;
      bundles_.front().boxes.push_back(box);
      bundles_.front().edge_of.push_back(i);
    }
  }
  // Once for the distance from the line, twice for a longer edge that is shorter along the line.
  reach_ = static_cast<float>(3 * tolerance_) + 0x1p-22f * largest;
}

bool BoundaryEdges::is_beside(const glm::dvec3& point, std::uint32_t edge) const {
  const BoundaryEdge& line = edges_[edge];
  const glm::dvec3 along = line.to - line.from;
  const double foot = glm::dot(point - line.from, along);
  return foot >= 0 && foot <= glm::dot(along, along);
}

}  // namespace photile::surface
