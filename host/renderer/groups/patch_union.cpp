#include "groups/patch_union.hpp"

#include <algorithm>

namespace photile::groups {

PatchUnion::PatchUnion(std::size_t patch_count) : parent_(patch_count) {
  for (std::uint32_t patch = 0; patch < patch_count; ++patch) parent_[patch] = 2 * patch;
}

void PatchUnion::join(std::uint32_t patch, std::uint32_t other, std::uint32_t turned) {
  parent_[patch] = 2 * other + turned;
}

std::uint32_t PatchUnion::map(std::uint32_t map) const {
  while (parent_[map / 2] / 2 != map / 2) map = parent_[map / 2] ^ (map & 1u);
  return number_.empty() ? map : 2 * number_[map / 2] + (map & 1u);
}

void PatchUnion::number() {
  std::vector<std::uint32_t> numbers(parent_.size(), none);
  std::uint32_t next = 0;
  for (std::uint32_t patch = 0; patch < parent_.size(); ++patch) {
    const std::uint32_t representative = map(2 * patch) / 2;
    if (numbers[representative] == none) numbers[representative] = next++;
  }
  number_ = std::move(numbers);
}

Patches PatchUnion::apply(const Patches& patches) const {
  Patches joined;
  joined.map_of.resize(patches.map_of.size());
  std::transform(patches.map_of.begin(), patches.map_of.end(), joined.map_of.begin(),
                 [this](std::uint32_t old) { return map(old); });
  std::uint32_t count = 0;
  for (const std::uint32_t map : joined.map_of) count = std::max(count, map / 2 + 1);
  joined.first_of.assign(count + 1, 0);
  for (std::uint32_t s = 0; s < joined.map_of.size(); s += 2) {
    ++joined.first_of[joined.map_of[s] / 2 + 1];
  }
  for (std::uint32_t patch = 0; patch < count; ++patch) {
    joined.first_of[patch + 1] += joined.first_of[patch];
  }
  joined.members.resize(joined.map_of.size() / 2);
  std::vector<std::uint32_t> next(joined.first_of.begin(), joined.first_of.end() - 1);
  for (std::uint32_t s = 0; s < joined.map_of.size(); s += 2) {
    const std::uint32_t map = joined.map_of[s];
    joined.members[next[map / 2]++] = s + (map & 1u);  // the side that map 2 p holds
  }
  return joined;
}

}  // namespace photile::groups
