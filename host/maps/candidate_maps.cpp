#include "maps/candidate_maps.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <span>

namespace photile::maps {
namespace {

constexpr std::size_t few_members = 24;  ///< a list this short is not worth splitting
constexpr std::size_t few_photons = 16;  ///< nor is one for this many photons

struct Box {
  glm::vec3 low{std::numeric_limits<float>::infinity()};
  glm::vec3 high{-std::numeric_limits<float>::infinity()};

  void include(const glm::vec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  bool is_within(float reach, const Box& other) const {
    const glm::vec3 gap = glm::max(glm::max(low - other.high, other.low - high), glm::vec3(0.0f));
    return glm::dot(gap, gap) <= reach * reach;
  }
};

/// The lists of one sided triangle.
struct Lists {
  std::vector<std::uint32_t> list_of_photon;  ///< numbered from 0
  std::vector<std::uint64_t> sizes;
  std::vector<std::uint32_t> members;
};

class Splitter {
 public:
  Splitter(const std::vector<Box>& triangle_boxes, std::span<const glm::vec3> positions,
           float reach, Lists& lists)
      : boxes_(triangle_boxes), positions_(positions), reach_(reach), lists_(lists) {}

  void split(std::span<std::uint32_t> photons, std::span<const std::uint32_t> members) {
    Box box;
    for (const std::uint32_t photon : photons) box.include(positions_[photon]);
    std::vector<std::uint32_t> near;
    near.reserve(members.size());
    for (const std::uint32_t member : members) {
      if (boxes_[triangle_of(member)].is_within(reach_, box)) near.push_back(member);
    }
    const glm::vec3 extent = box.high - box.low;
    const bool small = glm::length(extent) <= 0.5f * reach_;
    if (near.size() <= few_members || photons.size() <= few_photons || small) {
      add_list(photons, near);
      return;
    }
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    const float middle = 0.5f * (box.low[axis] + box.high[axis]);
    const auto half = std::partition(photons.begin(), photons.end(), [&](std::uint32_t photon) {
      return positions_[photon][axis] < middle;
    });
    split({photons.begin(), half}, near);
    split({half, photons.end()}, near);
  }

 private:
  void add_list(std::span<const std::uint32_t> photons, const std::vector<std::uint32_t>& members) {
    for (const std::uint32_t photon : photons) {
      lists_.list_of_photon[photon] = static_cast<std::uint32_t>(lists_.sizes.size());
    }
    lists_.sizes.push_back(members.size());
    lists_.members.insert(lists_.members.end(), members.begin(), members.end());
  }

  const std::vector<Box>& boxes_;
  std::span<const glm::vec3> positions_;
  float reach_;
  Lists& lists_;
};

std::vector<Box> triangle_boxes(const Scene& scene) {
  std::vector<Box> boxes(scene.triangle_count());
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    for (const glm::vec3& corner : scene.corners(t)) boxes[t].include(corner);
  }
  return boxes;
}

}  // namespace

CandidateMaps find_candidate_maps(const Scene& scene, const Photons& photons,
                                  const NeighbourGroups& groups, float reach) {
  const std::vector<Box> boxes = triangle_boxes(scene);
  const std::size_t map_total = groups.offsets.size() - 1;
  std::vector<Lists> lists(map_total);
  tbb::parallel_for(std::size_t{0}, map_total, [&](std::size_t map) {
    const std::uint32_t first = photons.first_of[map];
    const std::uint32_t count = photons.first_of[map + 1] - first;
    if (count == 0) return;
    lists[map].list_of_photon.resize(count);
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    Splitter(boxes, {photons.position.data() + first, count}, reach, lists[map])
        .split(order, groups.of(static_cast<std::uint32_t>(map)));
  });

  CandidateMaps result;
  result.list_of_photon.resize(photons.size());
  result.first_list_of.reserve(map_total + 1);
  result.first_list_of.push_back(0);
  result.offsets.push_back(0);
  std::vector<std::uint64_t> first_member_of(map_total + 1, 0);
  for (std::size_t map = 0; map < map_total; ++map) {
    for (const std::uint64_t size : lists[map].sizes) {
      result.offsets.push_back(result.offsets.back() + size);
    }
    result.first_list_of.push_back(result.offsets.size() - 1);
    first_member_of[map + 1] = result.offsets.back();
  }
  result.members.resize(result.offsets.back());
  tbb::parallel_for(std::size_t{0}, map_total, [&](std::size_t map) {
    std::copy(lists[map].members.begin(), lists[map].members.end(),
              result.members.begin() + static_cast<std::ptrdiff_t>(first_member_of[map]));
    const auto first_list = static_cast<std::uint32_t>(result.first_list_of[map]);
    for (std::size_t i = 0; i < lists[map].list_of_photon.size(); ++i) {
      result.list_of_photon[photons.first_of[map] + i] = first_list + lists[map].list_of_photon[i];
    }
    lists[map] = Lists{};
  });
  return result;
}

}  // namespace photile::maps
