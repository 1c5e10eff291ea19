#include "geometry/triangle_bvh.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <bit>
#include <cmath>
#include <tuple>

#include "geometry/radix_sort.hpp"

namespace photile::geometry {
namespace {

constexpr int bits_per_axis = 20;
constexpr int size_classes = 16;  ///< octaves, counted down from the largest triangle

struct CodedTriangle {
  std::uint64_t code;
  std::uint32_t triangle;
  bool operator<(const CodedTriangle& other) const {
    return std::tie(code, triangle) < std::tie(other.code, other.triangle);
  }
};

std::uint64_t code_of(const glm::dvec3& position, const Box& bounds) {
  const glm::dvec3 lower(bounds.lower);
  const glm::dvec3 extent = glm::max(glm::dvec3(bounds.upper) - lower, glm::dvec3(1e-300));
  const glm::dvec3 cell = glm::clamp((position - lower) / extent, 0.0, 1.0) *
                          static_cast<double>((1u << bits_per_axis) - 1);
  return morton_code(glm::uvec3(cell));
}

double diagonal(const Box& box) {
  return glm::distance(glm::dvec3(box.lower), glm::dvec3(box.upper));
}

std::uint64_t size_class(double size, double largest) {
  if (!(size > 0)) return size_classes - 1;
  return std::min(size_classes - 1, std::ilogb(largest) - std::ilogb(size));
}

std::vector<std::uint32_t> spatial_order(const std::vector<Box>& triangle_boxes) {
  Box bounds;
  double largest = 0;
  for (const Box& box : triangle_boxes) {
    bounds.extend(box);
    largest = std::max(largest, diagonal(box));
  }
  std::vector<CodedTriangle> coded(triangle_boxes.size());
  tbb::parallel_for(std::size_t{0}, coded.size(), [&](std::size_t i) {
    const Box& box = triangle_boxes[i];
    const glm::dvec3 centre = 0.5 * (glm::dvec3(box.lower) + glm::dvec3(box.upper));
    coded[i] = {size_class(diagonal(box), largest) << (3 * bits_per_axis) | code_of(centre, bounds),
                static_cast<std::uint32_t>(i)};
  });
  tbb::parallel_sort(coded.begin(), coded.end());
  std::vector<std::uint32_t> order(coded.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = coded[i].triangle;
  return order;
}

}  // namespace

Box triangle_box(const Scene& scene, std::uint32_t triangle) {
  Box box;
  for (const glm::vec3& corner : scene.corners(triangle)) box.extend(corner);
  return box;
}

TriangleBvh::TriangleBvh(const Scene& scene) {
  const std::size_t count = scene.triangle_count();
  if (count == 0) return;
  std::vector<Box> triangle_boxes(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    triangle_boxes[i] = triangle_box(scene, static_cast<std::uint32_t>(i));
  });
  order_ = spatial_order(triangle_boxes);

  const std::size_t leaves = (count + leaf_size - 1) / leaf_size;
  leaf_count_ = static_cast<std::uint32_t>(std::bit_ceil(leaves));
  boxes_.resize(2 * std::size_t{leaf_count_});
  for (std::size_t i = 0; i < count; ++i) {
    boxes_[leaf_count_ + i / leaf_size].extend(triangle_boxes[order_[i]]);
  }
  for (std::size_t node = leaf_count_ - 1; node >= 1; --node) {
    boxes_[node].extend(boxes_[2 * node]);
    boxes_[node].extend(boxes_[2 * node + 1]);
  }
}

}  // namespace photile::geometry
