#include "maps/candidate_maps.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <span>

#include "common/touched_memory.hpp"
#include "geometry/box.hpp"
#include "photile/scene.hpp"

namespace photile::maps {

namespace {

constexpr std::size_t few_members = 24;  ///< a list this short is not worth splitting
constexpr std::size_t few_photons = 16;  ///< nor is one for this many photons

constexpr std::size_t triangles_per_chunk = 1024;  ///< of oriented faces

/// The lists of some oriented faces in a row.
struct Lists {
  std::vector<std::uint32_t> lists_of_triangle;  ///< their number
  std::vector<std::uint32_t> list_of_photon;     ///< numbered from 0 in the chunk
  std::vector<std::uint32_t> sizes;
  std::vector<std::uint32_t> members;
};

bool is_requested(std::span<const std::uint8_t> requested, std::uint32_t map) {
  return requested.empty() || requested[map] != 0;
}

class Splitter {
 public:
  /// `positions`: of the photons that the next lists are for; the last of `lists.list_of_photon`.
  Splitter(const std::vector<geometry::Box>& map_boxes, std::span<const glm::vec3> positions,
           float reach, std::span<const std::uint8_t> requested, Lists& lists)
      : boxes_(map_boxes),
        positions_(positions),
        reach_(reach),
        requested_(requested),
        lists_(lists),
        first_photon_(lists.list_of_photon.size() - positions.size()) {}

  void split(std::span<std::uint32_t> photons, std::span<const std::uint32_t> members) {
    geometry::Box box;
    for (const std::uint32_t photon : photons) box.extend(positions_[photon]);
    std::vector<std::uint32_t> near;
    near.reserve(members.size());
    for (const std::uint32_t member : members) {
      if (geometry::squared_distance(boxes_[member / 2], box) <= reach_ * reach_) {
        near.push_back(member);
      }
    }
    const bool small = glm::length(box.size()) <= 0.5f * reach_;
    if (near.size() <= few_members || photons.size() <= few_photons || small) {
      add_list(photons, near);
      return;
    }
    const int axis = box.longest_axis();
    const float middle = 0.5f * (box.lower[axis] + box.upper[axis]);
    const auto half = std::partition(photons.begin(), photons.end(), [&](std::uint32_t photon) {
      return positions_[photon][axis] < middle;
    });
    split({photons.begin(), half}, near);
    split({half, photons.end()}, near);
  }

 private:
  void add_list(std::span<const std::uint32_t> photons, std::vector<std::uint32_t>& members) {
    std::erase_if(members, [&](std::uint32_t map) { return !is_requested(requested_, map); });
    for (const std::uint32_t photon : photons) {
      lists_.list_of_photon[first_photon_ + photon] =
          static_cast<std::uint32_t>(lists_.sizes.size());
    }
    lists_.sizes.push_back(static_cast<std::uint32_t>(members.size()));
    lists_.members.insert(lists_.members.end(), members.begin(), members.end());
  }

  const std::vector<geometry::Box>& boxes_;
  std::span<const glm::vec3> positions_;
  float reach_;
  std::span<const std::uint8_t> requested_;
  Lists& lists_;
  std::size_t first_photon_;
};

}  // namespace

std::vector<geometry::Box> map_boxes(const Scene& scene, const Patches& patches) {
  std::vector<geometry::Box> boxes(patches.empty() ? scene.triangle_count() : patches.count());
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    geometry::Box& box = boxes[patches.map(oriented(t, 0)) / 2];
    for (const glm::vec3& corner : scene.corners(t)) box.extend(corner);
  }
  return boxes;
}

CandidateMaps find_candidate_maps(const Scene& scene, const Photons& photons,
                                  const NeighbourGroups& groups, float reach,
                                  std::span<const std::uint8_t> requested) {
  const std::vector<geometry::Box> boxes = map_boxes(scene, groups.patches);
  const std::size_t triangle_total = groups.offsets.size() - 1;
  std::vector<Lists> chunks((triangle_total + triangles_per_chunk - 1) / triangles_per_chunk);
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
    Lists& lists = chunks[c];
    const std::size_t first = c * triangles_per_chunk;
    const std::size_t last = std::min(first + triangles_per_chunk, triangle_total);
    std::vector<std::uint32_t> order;
    for (std::size_t triangle = first; triangle < last; ++triangle) {
      const std::uint32_t first_photon = photons.first_of[triangle];
      const std::uint32_t count = photons.first_of[triangle + 1] - first_photon;
      const std::size_t lists_before = lists.sizes.size();
      if (count > 0) {
        lists.list_of_photon.resize(lists.list_of_photon.size() + count);
        order.resize(count);
        std::iota(order.begin(), order.end(), 0u);
        std::span<const std::uint32_t> group = groups.of(static_cast<std::uint32_t>(triangle));
        const bool any = std::any_of(group.begin(), group.end(), [&](std::uint32_t map) {
          return is_requested(requested, map);
        });
        if (!any) group = {};  // one list without members for all
        Splitter(boxes, {photons.position.data() + first_photon, count}, reach, requested, lists)
            .split(order, group);
      }
      lists.lists_of_triangle.push_back(
          static_cast<std::uint32_t>(lists.sizes.size() - lists_before));
    }
  });

  CandidateMaps result;
  result.list_of_photon = touched_vector<std::uint32_t>(photons.size());
  result.first_list_of.reserve(triangle_total + 1);
  result.first_list_of.push_back(0);
  result.offsets.push_back(0);
  std::vector<std::uint64_t> first_member_of;
  for (const Lists& lists : chunks) {
    first_member_of.push_back(result.offsets.back());
    for (const std::uint32_t count : lists.lists_of_triangle) {
      result.first_list_of.push_back(result.first_list_of.back() + count);
    }
    for (const std::uint32_t size : lists.sizes) {
      result.offsets.push_back(result.offsets.back() + size);
    }
  }
  result.members = touched_vector<std::uint32_t>(result.offsets.back());
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
    std::copy(chunks[c].members.begin(), chunks[c].members.end(),
              result.members.begin() + static_cast<std::ptrdiff_t>(first_member_of[c]));
    const std::size_t first = c * triangles_per_chunk;
    const auto first_list = static_cast<std::uint32_t>(result.first_list_of[first]);
    for (std::size_t i = 0; i < chunks[c].list_of_photon.size(); ++i) {
      result.list_of_photon[photons.first_of[first] + i] = first_list + chunks[c].list_of_photon[i];
    }
    chunks[c] = Lists{};
  });
  return result;
}

namespace {

template <class Visit>
void for_each_member(std::vector<std::uint32_t>& members, const Visit& visit) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, members.size(), 1 << 14),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) visit(members[i]);
                    });
}

}  // namespace

MapNumbers number_maps(CandidateMaps& candidates, const Patches& patches, std::size_t face_count) {
  constexpr std::uint32_t reached = 0;
  std::vector<std::uint32_t> number_of(patches.empty() ? face_count / 2 : patches.count(), none);
  for_each_member(candidates.members, [&](std::uint32_t map) {
    // Reading first keeps the cache lines of pairs with many photons shared.
    const std::atomic_ref<std::uint32_t> number(number_of[map / 2]);
    if (number.load(std::memory_order_relaxed) == none) {
      number.store(reached, std::memory_order_relaxed);
    }
  });
  MapNumbers numbers;
  for (std::uint32_t pair = 0; pair < number_of.size(); ++pair) {
    if (number_of[pair] == none) continue;
    number_of[pair] = static_cast<std::uint32_t>(numbers.pairs.size());
    numbers.pairs.push_back(pair);
  }
  for_each_member(candidates.members,
                  [&](std::uint32_t& map) { map = 2 * number_of[map / 2] + map % 2; });
  numbers.map_of.resize(face_count);
  for (std::uint32_t own = 0; own < face_count; ++own) {
    const std::uint32_t map = patches.map(own);
    const std::uint32_t number = number_of[map / 2];
    numbers.map_of[own] = number == none ? none : 2 * number + map % 2;
  }
  return numbers;
}

std::vector<float> of_numbered(const MapNumbers& numbers, std::span<const float> values) {
  std::vector<float> result;
  result.reserve(numbers.map_count());
  for (const std::uint32_t pair : numbers.pairs) {
    result.insert(result.end(), {values[2 * pair], values[2 * pair + 1]});
  }
  return result;
}

}  // namespace photile::maps
