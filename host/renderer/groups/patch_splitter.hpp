// Clustering from the top down: all triangles, split until each part is flat enough and has no
// large gaps, so that it can be a patch.
#pragma once

#include <tbb/concurrent_vector.h>
#include <tbb/task_group.h>

#include <cstdint>
#include <vector>

#include "groups/patch_shape.hpp"

namespace photile::groups {

/// A finished part: triangles in ascending order, and the box they fill.
struct PatchPart {
  std::vector<std::uint32_t> triangles;
  PatchShape shape;
};

/// Splits the triangles of a scene. Each split is the one of three that leaves the least expected
/// work: by normal, by height along the shared normal, or across the longer side of the box.
class PatchSplitter {
 public:
  /// `radius`: metres, the search radius of the maps.
  PatchSplitter(const Scene& scene, double radius);

  /// Parts in the order of their first triangles, whatever the number of threads.
  std::vector<PatchPart> split();

  const TriangleFacts& facts() const { return facts_; }

 private:
  struct Halves {
    PatchPart first, second;
    double cost = 0;
    bool valid() const { return !first.triangles.empty() && !second.triangles.empty(); }
  };

  void split(PatchPart part, tbb::task_group& tasks);
  bool serves_as_patch(const PatchPart& part) const;
  double cost(PatchPart& part) const;
  Halves by_normal(const PatchPart& part) const;
  Halves along(const PatchPart& part, int axis) const;
  Halves best_split(const PatchPart& part) const;

  const Scene& scene_;
  double radius_;
  TriangleFacts facts_;
  tbb::concurrent_vector<PatchPart> parts_;
};

}  // namespace photile::groups
