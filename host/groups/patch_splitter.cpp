#include "groups/patch_splitter.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

namespace photile::groups {
namespace {

/// Height of a patch at most, in radii: photons of other heights are candidates in vain.
constexpr double most_thickness = 0.5;

/// Normals lean at most 26 degrees: what photons of other normals a map holds besides, its queries
/// read in vain. Measured on living room, kitchen and classroom: 45 degrees has a query read up to
/// 12% more, and 18 no less than 26.
constexpr double least_cosine = 0.9;

/// Parts this small, in radii, are not split for their normals: every map around would hold the
/// same photons.
constexpr double small_diagonal = 1.0;

/// A patch covers at least this part of its rectangle: photons that lie in the rest enter in vain.
constexpr double least_cover = 0.5;

constexpr std::size_t triangles_per_task = 2048;

double angle_excess(double cosine) {
  return std::max(0.0, std::acos(std::min(1.0, cosine)) / std::acos(least_cosine) - 1.0);
}

}  // namespace

PatchSplitter::PatchSplitter(const Scene& scene, double radius)
    : scene_(scene), radius_(radius), facts_(scene) {}

std::vector<PatchPart> PatchSplitter::split() {
  std::vector<std::uint32_t> all(scene_.triangle_count());
  std::iota(all.begin(), all.end(), 0u);
  tbb::task_group tasks;
  if (!all.empty()) split(std::move(all), tasks);
  tasks.wait();
  std::vector<PatchPart> parts(std::make_move_iterator(parts_.begin()),
                               std::make_move_iterator(parts_.end()));
  parts_.clear();
  std::sort(parts.begin(), parts.end(), [](const PatchPart& a, const PatchPart& b) {
    return a.triangles.front() < b.triangles.front();
  });
  return parts;
}

void PatchSplitter::split(std::vector<std::uint32_t> triangles, tbb::task_group& tasks) {
  for (;;) {
    const PatchShape shape = shape_of(scene_, facts_, triangles);
    if (triangles.size() == 1 || serves_as_patch(shape, triangles)) {
      std::sort(triangles.begin(), triangles.end());
      parts_.push_back({std::move(triangles), shape});
      return;
    }
    Halves halves = best_split(shape, triangles);
    if (halves.second.size() > triangles_per_task) {
      // A task must be copyable and constant: what it consumes is held by pointer.
      auto second = std::make_shared<std::vector<std::uint32_t>>(std::move(halves.second));
      tasks.run([this, second, &tasks] { split(std::move(*second), tasks); });
    } else {
      split(std::move(halves.second), tasks);
    }
    triangles = std::move(halves.first);
  }
}

bool PatchSplitter::serves_as_patch(const PatchShape& shape,
                                    std::span<const std::uint32_t> triangles) const {
  if (shape.diagonal() <= small_diagonal * radius_) return true;
  return shape.thickness() <= most_thickness * radius_ && shape.least_cosine >= least_cosine &&
         covered_part(scene_, shape, triangles, radius_) >= least_cover;
}

/// The area of references that a part will need: its own, more of it the farther the part is from
/// serving as a patch, and a border as wide as the radius.
double PatchSplitter::cost(std::span<const std::uint32_t> triangles) const {
  const PatchShape shape = shape_of(scene_, facts_, triangles);
  const double height_excess = std::max(0.0, shape.thickness() / (most_thickness * radius_) - 1.0);
  return shape.area * (height_excess + angle_excess(shape.least_cosine)) +
         2 * radius_ * (shape.width(0) + shape.width(1));
}

/// Between the two normals that differ most.
PatchSplitter::Halves PatchSplitter::by_normal(const PatchShape& shape,
                                               std::span<const std::uint32_t> triangles) const {
  const auto farthest_from = [&](const glm::dvec3& direction) {
    double least = 2;
    std::uint32_t farthest = triangles.front();
    for (const std::uint32_t t : triangles) {
      const double cosine = std::abs(glm::dot(glm::dvec3(facts_.normal[t]), direction));
      if (cosine < least) {
        least = cosine;
        farthest = t;
      }
    }
    return glm::dvec3(facts_.normal[farthest]);
  };
  const glm::dvec3 a = farthest_from(shape.axis);
  const glm::dvec3 b = farthest_from(a);
  Halves halves;
  for (const std::uint32_t t : triangles) {
    const glm::dvec3 normal(facts_.normal[t]);
    const bool nearer_a = std::abs(glm::dot(normal, a)) > std::abs(glm::dot(normal, b));
    (nearer_a ? halves.first : halves.second).push_back(t);
  }
  return halves;
}

/// At the widest gap between triangles along an axis of the shape, or in the middle of the box
/// where there is none.
PatchSplitter::Halves PatchSplitter::along(const PatchShape& shape, int axis,
                                           std::span<const std::uint32_t> triangles) const {
  struct Interval {
    double low, high;
  };
  std::vector<Interval> intervals;
  intervals.reserve(triangles.size());
  for (const std::uint32_t t : triangles) {
    const auto corners = local_corners(scene_, shape, t);
    intervals.push_back({std::min({corners[0][axis], corners[1][axis], corners[2][axis]}),
                         std::max({corners[0][axis], corners[1][axis], corners[2][axis]})});
  }
  std::vector<Interval> sorted = intervals;
  std::sort(sorted.begin(), sorted.end(),
            [](const Interval& a, const Interval& b) { return a.low < b.low; });
  double border = 0.5 * (shape.low[axis] + shape.high[axis]);
  double widest = 0, reached = sorted.front().high;
  for (const Interval& interval : sorted) {
    if (interval.low - reached > widest) {
      widest = interval.low - reached;
      border = 0.5 * (interval.low + reached);
    }
    reached = std::max(reached, interval.high);
  }
  Halves halves;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const bool below = 0.5 * (intervals[i].low + intervals[i].high) < border;
    (below ? halves.first : halves.second).push_back(triangles[i]);
  }
  return halves;
}

PatchSplitter::Halves PatchSplitter::best_split(const PatchShape& shape,
                                                std::span<const std::uint32_t> triangles) const {
  std::vector<Halves> splits;
  splits.push_back(along(shape, shape.width(0) >= shape.width(1) ? 0 : 1, triangles));
  const bool leaning = shape.least_cosine < least_cosine;
  const bool thick = shape.thickness() > most_thickness * radius_;
  if (leaning || thick) {
    splits.push_back(along(shape, 2, triangles));
    splits.push_back(by_normal(shape, triangles));
  }
  Halves* best = nullptr;
  for (Halves& halves : splits) {
    if (!halves.valid()) continue;
    halves.cost = cost(halves.first) + cost(halves.second);
    if (best == nullptr || halves.cost < best->cost) best = &halves;
  }
  if (best != nullptr) return std::move(*best);
  // Coincident layers that no plane divides.
  const std::size_t half = triangles.size() / 2;
  return {{triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(half)},
          {triangles.begin() + static_cast<std::ptrdiff_t>(half), triangles.end()},
          0};
}

}  // namespace photile::groups
