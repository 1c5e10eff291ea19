// Cells of surface: rays that end in the same cell look one estimate up.
#pragma once

#include <tsl/robin_map.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace photile::gathering {

/// What ends that share an estimate have in common: the voxel, its size, the direction of the
/// surface to about 30 degrees, and the photon map.
struct CellKey {
  std::array<std::int32_t, 3> voxel;
  std::uint32_t size_and_normal;
  std::uint32_t map;

  friend bool operator==(const CellKey&, const CellKey&) = default;
};

/// The cell of a ray's end. Cells seen from less than 20 of their sides shrink to a half, and once
/// more to a quarter: what is near looks large.
///   side       of the largest cells, metres
///   normal     of the surface, unit
///   distance   that the ray went, metres
CellKey cell_of(const glm::vec3& position, const glm::vec3& normal, std::uint32_t map, double side,
                float distance);

/// Numbers cells in the order in which they are met first. Work is shared by TBB, the numbers do
/// not depend on it.
class EndCells {
 public:
  struct Numbers {
    std::vector<std::uint32_t> cell;       ///< of each key; of keys left out it means nothing
    std::vector<std::uint32_t> first_key;  ///< of each new cell, by number: where it was met first
  };
  /// Cells met before keep their numbers, new ones follow.
  ///   left_out   of each key: 1 where it has no cell, else 0
  Numbers number(std::span<const CellKey> keys, std::span<const std::uint8_t> left_out);

  std::size_t size() const { return size_; }

 private:
  struct Hash {
    std::size_t operator()(const CellKey& key) const;
  };
  /// The cells of some hashes: one task's.
  struct Shard {
    tsl::robin_map<CellKey, std::uint32_t, Hash> index;  ///< into `number`
    std::vector<std::uint32_t> number;
  };
  static constexpr std::size_t shards = 16;

  std::array<Shard, shards> shards_;
  std::size_t size_ = 0;
};

}  // namespace photile::gathering
