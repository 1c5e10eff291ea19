#include "maps/map_numbers.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>

#include "photile/scene.hpp"

namespace photile::maps {
namespace {

template <class Visit>
void for_each_member(std::vector<std::uint32_t>& members, const Visit& visit) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, members.size(), 1 << 14),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) visit(members[i]);
                    });
}

}  // namespace

MapNumbers number_maps(CandidateMaps& candidates, const Patches& patches, std::size_t sided_count) {
  constexpr std::uint32_t reached = 0;
  std::vector<std::uint32_t> number_of(patches.empty() ? sided_count / 2 : patches.count(), none);
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
  numbers.map_of.resize(sided_count);
  for (std::uint32_t own = 0; own < sided_count; ++own) {
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
