#include "cache/charts.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "photile/defaults.hpp"

namespace photile::cache {

namespace {

/// Tiles of the coarsest level of a scene: 4 bytes each, whether they are filled or not.
constexpr double most_roots = 1 << 22;

/// With fewer triangles, testing all of them is as fast as a tree.
constexpr std::size_t least_triangles_of_tree = 16;

struct Rectangle {
  glm::dvec2 low{std::numeric_limits<double>::infinity()};
  glm::dvec2 high{-std::numeric_limits<double>::infinity()};

  void extend(const glm::dvec2& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  double area() const { return (high.x - low.x) * (high.y - low.y); }
};

using Corners2 = std::array<glm::dvec2, 3>;

/// A point of a triangle by the weights of its second and third corner.
struct NearestPoint {
  double squared_distance;
  double u, v;
};

NearestPoint nearest_on_edge(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 edge = b - a;
  const double squared = glm::dot(edge, edge);
  const double t = squared > 0 ? std::clamp(glm::dot(p - a, edge) / squared, 0.0, 1.0) : 0.0;
  const glm::dvec2 d = p - (a + t * edge);
  return {glm::dot(d, d), t, 0};
}

NearestPoint nearest_on(const Corners2& c, const glm::dvec2& p) {
  const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
  const double area = cross(c[1] - c[0], c[2] - c[0]);
  if (area != 0) {
    const double u = cross(p - c[0], c[2] - c[0]) / area, v = cross(c[1] - c[0], p - c[0]) / area;
    if (u >= 0 && v >= 0 && u + v <= 1) return {0, u, v};
  }
  const NearestPoint a = nearest_on_edge(p, c[0], c[1]);
  const NearestPoint b = nearest_on_edge(p, c[1], c[2]);
  const NearestPoint d = nearest_on_edge(p, c[2], c[0]);
  if (a.squared_distance <= b.squared_distance && a.squared_distance <= d.squared_distance) {
    return {a.squared_distance, a.u, 0};
  }
  if (b.squared_distance <= d.squared_distance) return {b.squared_distance, 1 - b.u, b.u};
  return {d.squared_distance, 0, 1 - d.u};
}

/// Directions that the frame of a chart is chosen from: those of a triangle's edges, and the axes.
std::vector<glm::dvec3> directions_in_plane(const Scene& scene, std::uint32_t triangle,
                                            const glm::dvec3& normal) {
  const auto corners = scene.corners(triangle);
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < 3; ++i) {
    directions.push_back(glm::dvec3(corners[(i + 1) % 3]) - glm::dvec3(corners[i]));
  }
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 direction(0.0);
    direction[axis] = 1;
    if (std::abs(normal[axis]) < 0.9) directions.push_back(direction);
  }
  for (glm::dvec3& direction : directions) {
    direction = glm::normalize(direction - glm::dot(direction, normal) * normal);
  }
  return directions;
}

/// The nearest point of a triangle that is at least this far from its edges, or half as far as its
/// middle is: nearest to a point a little towards the middle, because walls may stand on the
/// triangle itself.
NearestPoint nearest_within(const Corners2& c, glm::dvec2 p, double inset) {
  const double opposite[3] = {glm::distance(c[1], c[2]), glm::distance(c[2], c[0]),
                              glm::distance(c[0], c[1])};
  const double around = opposite[0] + opposite[1] + opposite[2];
  const glm::dvec2 u = c[1] - c[0], v = c[2] - c[0];
  const double radius = std::abs(u.x * v.y - u.y * v.x) / around;  // of the circle in the triangle
  const glm::dvec3 weights = glm::dvec3(opposite[0], opposite[1], opposite[2]) / around;
  const glm::dvec2 middle = weights.x * c[0] + weights.y * c[1] + weights.z * c[2];
  const double way = glm::distance(p, middle);
  if (way > 0) p += std::min(inset, way) / way * (middle - p);
  const double kept = 1 - std::min(0.5, inset / radius);
  NearestPoint nearest =
      nearest_on({middle + kept * (c[0] - middle), middle + kept * (c[1] - middle),
                  middle + kept * (c[2] - middle)},
                 p);
  nearest.u = kept * nearest.u + (1 - kept) * weights.y;
  nearest.v = kept * nearest.v + (1 - kept) * weights.z;
  return nearest;
}

}  // namespace

Charts::Charts(const Scene& scene, double spacing, double angle_degrees)
    : scene_(scene), coincident_(scene), spacing_(spacing) {
  ChartGrowth growth = grow_charts(scene, spacing, angle_degrees);
  chart_of_ = std::move(growth.chart_of);
  charts_.resize(growth.seed.size());
  lattices_.resize(charts_.size());
  trees_.resize(charts_.size());
  members_ = rows_of(charts_.size(), [&](const auto& put) {
    for (std::uint32_t s = 0; s < chart_of_.size(); ++s) {
      if (chart_of_[s] != none) put(chart_of_[s], s);
    }
  });
  tbb::parallel_for(std::size_t{0}, charts_.size(), [&](std::size_t chart) {
    frame(static_cast<std::uint32_t>(chart), growth.seed[chart]);
  });
  const auto root_count = [&] {
    double count = 0;
    for (const Chart& chart : charts_) {
      count +=
          std::ceil(chart.spacing.x / spacing_ / 8) * std::ceil(chart.spacing.y / spacing_ / 8);
    }
    return count;
  };
  while (root_count() > std::max(most_roots, 2.0 * static_cast<double>(charts_.size()))) {
    spacing_ *= 2;
  }
  for (std::size_t i = 0; i < charts_.size(); ++i) {
    Chart& chart = charts_[i];
    const glm::dvec2 size = chart.spacing;
    // A hundredth of a cell more is rounding: no lattice has a column for it.
    chart.columns = static_cast<std::uint32_t>(std::max(1.0, std::ceil(size.x / spacing_ - 0.01)));
    chart.rows = static_cast<std::uint32_t>(std::max(1.0, std::ceil(size.y / spacing_ - 0.01)));
    chart.spacing = {size.x > 0 ? size.x / chart.columns : spacing_,
                     size.y > 0 ? size.y / chart.rows : spacing_};
    chart.first_root = roots_;
    roots_ += chart.root_columns() * chart.root_rows();
    const glm::dvec3 across = chart.across / chart.spacing.x, along = chart.along / chart.spacing.y;
    lattices_[i] = {glm::vec3(across), static_cast<float>(-glm::dot(across, chart.origin)),
                    glm::vec3(along), static_cast<float>(-glm::dot(along, chart.origin))};
  }
}

/// Leaves the size of the rectangle in `spacing`.
void Charts::frame(std::uint32_t index, std::uint32_t seed) {
  Chart& chart = charts_[index];
  const glm::dvec3 normal = face_normal(scene_, seed);
  chart.origin = glm::dvec3(scene_.corners(triangle_of(seed))[0]);
  double least = std::numeric_limits<double>::infinity();
  Chart best = chart;
  Rectangle enclosing;
  for (const glm::dvec3& direction : directions_in_plane(scene_, triangle_of(seed), normal)) {
    chart.across = direction;
    chart.along = glm::cross(normal, direction);
    Rectangle rectangle;
    for (const std::uint32_t member : members_.of(index)) {
      for (const glm::vec3& corner : scene_.corners(triangle_of(member))) {
        rectangle.extend(in_plane(chart, corner));
      }
    }
    if (!(rectangle.area() < (1 - 1e-6) * least)) continue;
    least = rectangle.area();
    best = chart;
    enclosing = rectangle;
  }
  best.origin += enclosing.low.x * best.across + enclosing.low.y * best.along;
  best.spacing = enclosing.high - enclosing.low;
  chart = best;
}

glm::dvec2 Charts::in_plane(const Chart& chart, const glm::vec3& point) const {
  const glm::dvec3 offset = glm::dvec3(point) - chart.origin;
  return {glm::dot(offset, chart.across), glm::dot(offset, chart.along)};
}

void Charts::prepare(std::uint32_t index) {
  if (trees_[index] || members_.of(index).size() < least_triangles_of_tree) return;
  std::vector<geometry::Box> boxes;
  for (const std::uint32_t member : members_.of(index)) {
    geometry::Box box;
    for (const glm::vec3& corner : scene_.corners(triangle_of(member))) {
      box.extend(glm::vec3(in_plane(charts_[index], corner), 0.0f));
    }
    boxes.push_back(box);
  }
  trees_[index] = std::make_unique<geometry::BoxTree>(boxes);
}

Charts::Support Charts::support(const NodeCoordinates& node, int levels) const {
  const Chart& chart = charts_[node.chart];
  const glm::dvec2 finest = chart.spacing / static_cast<double>(std::uint32_t{1} << (levels - 1));
  // A cell that surface lies in is no farther from it than the cell's diagonal.
  const glm::dvec2 position(node.x * finest.x, node.y * finest.y);
  Support found = support(node.chart, position, glm::length(finest));
  const auto corners = scene_.corners(found.where.triangle);
  const NearestPoint within = nearest_within(
      {in_plane(chart, corners[0]), in_plane(chart, corners[1]), in_plane(chart, corners[2])},
      position, defaults::node_inset * std::min(finest.x, finest.y));
  found.where.u = static_cast<float>(within.u);
  found.where.v = static_cast<float>(within.v);
  return found;
}

Charts::Support Charts::support(std::uint32_t index, const glm::dvec2& position,
                                double nearby) const {
  const Chart& chart = charts_[index];
  const std::span<const std::uint32_t> triangles = members_.of(index);
  NearestPoint nearest{std::numeric_limits<double>::infinity(), 0, 0};
  std::uint32_t support = none;
  const auto look_at = [&](std::uint32_t i) {
    const auto corners = scene_.corners(triangle_of(triangles[i]));
    const NearestPoint point = nearest_on(
        {in_plane(chart, corners[0]), in_plane(chart, corners[1]), in_plane(chart, corners[2])},
        position);
    if (point.squared_distance > nearest.squared_distance) return;
    if (point.squared_distance == nearest.squared_distance && triangles[i] > support) return;
    nearest = point;
    support = triangles[i];
  };
  if (const geometry::BoxTree* tree = trees_[index].get()) {
    geometry::Box at;
    at.extend(glm::vec3(position, 0.0f));
    for (double reach = nearby; support == none || nearest.squared_distance > reach * reach;
         reach *= 2) {
      // Room for boxes rounded to floats.
      const double limit = 1.01 * reach + 1e-6 * glm::length(position);
      tree->visit_within(at, static_cast<float>(limit * limit), [&](std::uint32_t i) {
        look_at(i);
        return false;
      });
    }
  } else {
    for (std::uint32_t i = 0; i < triangles.size(); ++i) look_at(i);
  }
  return {{triangle_of(support), static_cast<float>(nearest.u), static_cast<float>(nearest.v)},
          side_of(support)};
}

std::uint64_t Charts::bytes() const {
  return (chart_of_.size() + members_.first.size() + members_.items.size()) *
             sizeof(std::uint32_t) +
         charts_.size() * (sizeof(Chart) + sizeof(LatticeCoordinates));
}

}  // namespace photile::cache
