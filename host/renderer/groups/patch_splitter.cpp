#include "groups/patch_splitter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <memory>
#include <numeric>
#include <span>
#include <utility>

#include "common/ascii_text.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/scene_builder.hpp"

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

constexpr int most_gap_steps = 1024;

constexpr std::size_t most_judged = 1024;  ///< triangles by which a split is judged

bool is_judged_whole(const PatchPart& part) { return part.triangles.size() < most_judged; }

double angle_excess(double cosine) {
  return std::max(0.0, std::acos(std::min(1.0, cosine)) / std::acos(least_cosine) - 1.0);
}

}  // namespace

PatchSplitter::PatchSplitter(const Scene& scene, double radius)
    : scene_(scene), radius_(radius), facts_(scene) {}

std::vector<PatchPart> PatchSplitter::split() {
  PatchPart all;
  all.triangles.resize(scene_.triangle_count());
  std::iota(all.triangles.begin(), all.triangles.end(), 0u);
  tbb::task_group tasks;
  if (!all.triangles.empty()) {
    all.shape = shape_of(scene_, facts_, all.triangles);
    split(std::move(all), tasks);
  }
  tasks.wait();
  std::vector<PatchPart> parts(std::make_move_iterator(parts_.begin()),
                               std::make_move_iterator(parts_.end()));
  parts_.clear();
  std::sort(parts.begin(), parts.end(), [](const PatchPart& a, const PatchPart& b) {
    return a.triangles.front() < b.triangles.front();
  });
  return parts;
}

void PatchSplitter::split(PatchPart part, tbb::task_group& tasks) {
  for (;;) {
    if (part.triangles.size() == 1 || serves_as_patch(part)) {
      std::sort(part.triangles.begin(), part.triangles.end());
      parts_.push_back(std::move(part));
      return;
    }
    Halves halves = best_split(part);
    if (halves.second.triangles.size() > triangles_per_task) {
      // A task must be copyable and constant: what it consumes is held by pointer.
      auto second = std::make_shared<PatchPart>(std::move(halves.second));
      tasks.run([this, second, &tasks] { split(std::move(*second), tasks); });
    } else {
      split(std::move(halves.second), tasks);
    }
    part = std::move(halves.first);
  }
}

bool PatchSplitter::serves_as_patch(const PatchPart& part) const {
  const PatchShape& shape = part.shape;
  if (shape.diagonal() <= small_diagonal * radius_) return true;
  return shape.thickness() <= most_thickness * radius_ && shape.least_cosine >= least_cosine &&
         covered_part(scene_, shape, part.triangles, radius_) >= least_cover;
}

/// The area of references that a part will need: its own area, which counts more the less the part
/// is fit to be a patch, and a border as wide as the radius. A sample of many triangles says enough
/// to choose between splits; where all are judged, their shape is the part's.
double PatchSplitter::cost(PatchPart& part) const {
  PatchShape shape;
  if (is_judged_whole(part)) {
    shape = part.shape = shape_of(scene_, facts_, part.triangles);
  } else {
    const std::size_t step = part.triangles.size() / most_judged + 1;
    std::vector<std::uint32_t> sample;
    for (std::size_t i = 0; i < part.triangles.size(); i += step) {
      sample.push_back(part.triangles[i]);
    }
    shape = shape_of(scene_, facts_, sample);
    shape.area *= static_cast<double>(part.triangles.size()) / static_cast<double>(sample.size());
  }
  const double height_excess = std::max(0.0, shape.thickness() / (most_thickness * radius_) - 1.0);
  return shape.area * (height_excess + angle_excess(shape.least_cosine)) +
         2 * radius_ * (shape.width(0) + shape.width(1));
}

/// Between the two normals that differ most.
PatchSplitter::Halves PatchSplitter::by_normal(const PatchPart& part) const {
  const auto farthest_from = [&](const glm::dvec3& direction) {
    double least = 2;
    std::uint32_t farthest = part.triangles.front();
    for (const std::uint32_t t : part.triangles) {
      const double cosine = std::abs(glm::dot(glm::dvec3(facts_.normal[t]), direction));
      if (cosine < least) {
        least = cosine;
        farthest = t;
      }
    }
    return glm::dvec3(facts_.normal[farthest]);
  };
  const glm::dvec3 a = farthest_from(part.shape.axis);
  const glm::dvec3 b = farthest_from(a);
  Halves halves;
  for (const std::uint32_t t : part.triangles) {
    const glm::dvec3 normal(facts_.normal[t]);
    const bool nearer_a = std::abs(glm::dot(normal, a)) > std::abs(glm::dot(normal, b));
    (nearer_a ? halves.first : halves.second).triangles.push_back(t);
  }
  return halves;
}

/// In the widest gap between triangles along an axis of the shape, or in the middle of the box
/// where there is none. Gaps are looked for in steps of the box, from an eighth of a triangle on
/// average down to a thousandth of the box.
PatchSplitter::Halves PatchSplitter::along(const PatchPart& part, int axis) const {
  struct Interval {
    double low, high;
  };
  const PatchShape& shape = part.shape;
  const glm::dvec3& direction = shape.direction(axis);
  std::vector<Interval> intervals;
  intervals.reserve(part.triangles.size());
  for (const std::uint32_t t : part.triangles) {
    const auto corners = scene_.corners(t);
    const double a = glm::dot(glm::dvec3(corners[0]), direction);
    const double b = glm::dot(glm::dvec3(corners[1]), direction);
    const double c = glm::dot(glm::dvec3(corners[2]), direction);
    intervals.push_back({std::min({a, b, c}), std::max({a, b, c})});
  }
  const int steps = static_cast<int>(std::min<std::size_t>(8 * intervals.size(), most_gap_steps));
  const double step = shape.width(axis) / steps;
  const auto step_of = [&](double height) {
    return std::clamp(static_cast<int>((height - shape.low[axis]) / step), 0, steps - 1);
  };
  std::array<int, most_gap_steps + 1>
      begins{};  // intervals that begin in a step less those that end
  for (const Interval& interval : intervals) {
    ++begins[step_of(interval.low)];
    --begins[step_of(interval.high) + 1];
  }
  double border = 0.5 * (shape.low[axis] + shape.high[axis]);
  int widest = 0;
  for (int i = 0, covering = 0, reached = 0; i < steps; ++i) {
    covering += begins[i];
    if (covering == 0) continue;
    if (i - reached > widest) {
      widest = i - reached;
      border = shape.low[axis] + 0.5 * (reached + i) * step;
    }
    reached = i + 1;
  }
  Halves halves;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const bool below = 0.5 * (intervals[i].low + intervals[i].high) < border;
    (below ? halves.first : halves.second).triangles.push_back(part.triangles[i]);
  }
  return halves;
}

PatchSplitter::Halves PatchSplitter::best_split(const PatchPart& part) const {
  const PatchShape& shape = part.shape;
  std::vector<Halves> splits;
  splits.push_back(along(part, shape.width(0) >= shape.width(1) ? 0 : 1));
  const bool leaning = shape.least_cosine < least_cosine;
  const bool thick = shape.thickness() > most_thickness * radius_;
  if (leaning || thick) {
    splits.push_back(along(part, 2));
    splits.push_back(by_normal(part));
  }
  std::erase_if(splits, [](const Halves& halves) { return !halves.valid(); });
  if (splits.empty()) {  // coincident layers that no plane divides
    const auto begin = part.triangles.begin(), end = part.triangles.end();
    const auto middle = begin + static_cast<std::ptrdiff_t>(part.triangles.size() / 2);
    splits.push_back({{{begin, middle}, {}}, {{middle, end}, {}}});
  }
  Halves best = std::move(splits.front());
  const bool several = splits.size() > 1;
  if (several) best.cost = cost(best.first) + cost(best.second);
  for (Halves& halves : std::span(splits).subspan(1)) {
    halves.cost = cost(halves.first) + cost(halves.second);
    if (halves.cost < best.cost) best = std::move(halves);
  }
  for (PatchPart* half : {&best.first, &best.second}) {
    if (several && is_judged_whole(*half)) continue;  // its cost told its shape
    half->shape = shape_of(scene_, facts_, half->triangles);
  }
  return best;
}

}  // namespace photile::groups

namespace photile {

namespace {

using groups::PatchPart;
using groups::TriangleFacts;

/// Normals that lean farther from the axis have no common side.
constexpr double least_common_cosine = 0.17;

/// Whether single maps would hold fewer photons: the area within the radius of each triangle (its
/// Minkowski sum with a disc) against that of the patch's rectangle.
bool single_maps_cost_less(const Scene& scene, const TriangleFacts& facts, const PatchPart& part,
                           double radius) {
  double singles = 0;
  for (const std::uint32_t t : part.triangles) {
    const auto corners = scene.corners(t);
    double perimeter = 0;
    for (int i = 0; i < 3; ++i) perimeter += glm::distance(corners[i], corners[(i + 1) % 3]);
    singles += facts.area[t] + perimeter * radius + glm::pi<double>() * radius * radius;
  }
  return singles < part.shape.grown_area(radius);
}

class Collector {
 public:
  Collector(const Scene& scene, const TriangleFacts& facts) : scene_(scene), facts_(facts) {
    patches_.map_of.resize(2 * scene.triangle_count());
    patches_.members.reserve(scene.triangle_count());
    patches_.first_of.push_back(0);
  }

  void add(std::span<const std::uint32_t> triangles, const groups::PatchShape& shape) {
    const auto patch = static_cast<std::uint32_t>(patches_.count());
    for (const std::uint32_t t : triangles) {
      const std::uint32_t member = oriented(t, side_of_member(t, shape));
      patches_.members.push_back(member);
      patches_.map_of[member] = 2 * patch;
      patches_.map_of[member ^ 1u] = 2 * patch + 1;
    }
    patches_.first_of.push_back(static_cast<std::uint32_t>(patches_.members.size()));
  }

  Patches take() { return std::move(patches_); }

 private:
  /// Sides that face along the axis belong together; on small bodies, the sides that face outwards.
  std::uint32_t side_of_member(std::uint32_t triangle, const groups::PatchShape& shape) const {
    if (shape.least_cosine < least_common_cosine) return scene_.front_side[triangle];
    return glm::dot(glm::dvec3(facts_.normal[triangle]), shape.axis) < 0 ? 1 : 0;
  }

  const Scene& scene_;
  const TriangleFacts& facts_;
  Patches patches_;
};

}  // namespace

std::string_view name_of(MapMode mode) {
  return name_in({"naive", "triangle", "patch", "auto"}, mode);
}

Patches find_patches(const Scene& scene, double radius, MapMode mode) {
  if (mode == MapMode::naive || mode == MapMode::triangle) return {};
  check_scene(scene);
  groups::PatchSplitter splitter(scene, radius);
  const std::vector<PatchPart> parts = splitter.split();
  Collector collector(scene, splitter.facts());
  for (const PatchPart& part : parts) {
    if (mode == MapMode::automatic &&
        single_maps_cost_less(scene, splitter.facts(), part, radius)) {
      for (const std::uint32_t& t : part.triangles) collector.add({&t, 1}, part.shape);
    } else {
      collector.add(part.triangles, part.shape);
    }
  }
  return collector.take();
}

}  // namespace photile
