#include "surface/plane_tree.hpp"

#include <algorithm>

namespace photile::surface {

PlaneTree::PlaneTree(const SurfaceMesh& mesh, const Facets& facets)
    : mesh_(mesh), facets_(facets), tree_(mesh.scene) {
  const auto join = [](std::uint32_t a, std::uint32_t b) {
    if (a == nothing || a == b) return b;
    return b == nothing ? a : several;
  };
  const std::size_t leaves = tree_.leaf_count();
  plane_.assign(2 * leaves, nothing);
  for (std::size_t i = 0; i < tree_.order().size(); ++i) {
    const std::uint32_t triangle = tree_.order()[i];
    std::uint32_t& leaf = plane_[leaves + i / geometry::TriangleBvh::leaf_size];
    if (mesh.counts(triangle)) leaf = join(leaf, facets.plane[triangle]);
  }
  for (std::size_t node = leaves; node-- > 1;) {
    plane_[node] = join(plane_[2 * node], plane_[2 * node + 1]);
  }
}

}  // namespace photile::surface
