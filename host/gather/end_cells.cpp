#include "gather/end_cells.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace photile::gathering {
namespace {

constexpr float sides_away = 20;  ///< cells seen from less shrink
constexpr int most_halvings = 2;
/// Cells lie about surfaces at no multiple of their sides, on which walls like to stand: rounding
/// would cut such walls' cells in two.
constexpr float shift_along_normal = 0.29f;

}  // namespace

CellKey cell_of(const glm::vec3& position, const glm::vec3& normal, std::uint32_t map, double side,
                float distance) {
  int halvings = 0;
  auto own = static_cast<float>(side);
  while (halvings < most_halvings && distance < sides_away * own) {
    own *= 0.5f;
    ++halvings;
  }
  const glm::vec3 voxel = glm::floor(position / own + shift_along_normal * normal);
  constexpr float most = 2e9f;
  std::uint32_t direction = 0;
  CellKey key{};
  for (int axis = 0; axis < 3; ++axis) {
    key.voxel[static_cast<std::size_t>(axis)] =
        static_cast<std::int32_t>(std::clamp(voxel[axis], -most, most));
    direction = 5 * direction + static_cast<std::uint32_t>(std::lround(2 * normal[axis]) + 2);
  }
  key.size_and_normal = direction << 2 | static_cast<std::uint32_t>(halvings);
  key.map = map;
  return key;
}

std::size_t EndCells::Hash::operator()(const CellKey& key) const {
  std::uint64_t hash = 0;
  const auto mix = [&](std::uint64_t value) {  // the finaliser of MurmurHash3
    hash = (hash ^ value) * 0xFF51'AFD7'ED55'8CCDull;
    hash ^= hash >> 33;
  };
  mix(static_cast<std::uint32_t>(key.voxel[0]) |
      std::uint64_t{static_cast<std::uint32_t>(key.voxel[1])} << 32);
  mix(static_cast<std::uint32_t>(key.voxel[2]) | std::uint64_t{key.map} << 32);
  mix(key.size_and_normal);
  return hash * 0xC4CE'B9FE'1A85'EC53ull >> 3;
}

EndCells::Numbers EndCells::number(std::span<const CellKey> keys,
                                   std::span<const std::uint8_t> left_out) {
  constexpr std::size_t keys_per_task = 4096;
  const std::size_t tasks = (keys.size() + keys_per_task - 1) / keys_per_task;
  const auto in_tasks = [&](const auto& visit) {
    tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
      const std::size_t last = std::min(keys.size(), (task + 1) * keys_per_task);
      for (std::size_t i = task * keys_per_task; i < last; ++i) {
        if (!left_out[i]) visit(i);
      }
    });
  };
  // High bits of the hash choose the shard: the low ones choose the place in its table.
  std::vector<std::uint8_t> shard_of(keys.size(), shards);
  in_tasks([&](std::size_t i) {
    shard_of[i] = static_cast<std::uint8_t>(Hash()(keys[i]) >> 40 & (shards - 1));
  });

  Numbers numbers;
  numbers.cell.resize(keys.size());
  std::array<std::vector<std::uint32_t>, shards> met;  // keys of new cells
  tbb::parallel_for(std::size_t{0}, shards, [&](std::size_t s) {
    Shard& shard = shards_[s];
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (shard_of[i] != s) continue;
      const auto next = static_cast<std::uint32_t>(shard.number.size() + met[s].size());
      const auto [entry, is_new] = shard.index.try_emplace(keys[i], next);
      if (is_new) met[s].push_back(static_cast<std::uint32_t>(i));
      numbers.cell[i] = entry->second;
    }
  });
  for (const auto& keys_of_shard : met) {
    numbers.first_key.insert(numbers.first_key.end(), keys_of_shard.begin(), keys_of_shard.end());
  }
  std::sort(numbers.first_key.begin(), numbers.first_key.end());
  for (std::size_t s = 0; s < shards; ++s) {
    for (const std::uint32_t key : met[s]) {
      const auto place = std::lower_bound(numbers.first_key.begin(), numbers.first_key.end(), key);
      shards_[s].number.push_back(static_cast<std::uint32_t>(
          size_ + static_cast<std::size_t>(place - numbers.first_key.begin())));
    }
  }
  in_tasks([&](std::size_t i) { numbers.cell[i] = shards_[shard_of[i]].number[numbers.cell[i]]; });
  size_ += numbers.first_key.size();
  return numbers;
}

}  // namespace photile::gathering
