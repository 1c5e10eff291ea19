// A subsample of the photons, for exact distances to their nearest.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace photile::groups {

/// The most photons among which distances are found.
inline constexpr std::size_t max_subsample = 1u << 18;

/// Index of the i-th of `count` samples spread over `size` elements, each in the
/// middle of its part.
inline std::size_t spread_index(std::size_t i, std::size_t count, std::size_t size) {
  return (2 * i + 1) * size / (2 * count);
}

/// Photons in blocks of neighbours along the Morton curve, each with its box: most blocks are
/// excluded from a query by their boxes alone. Structures of arrays, so that loops over boxes and
/// over the photons of a block run in vectors.
class PhotonBlocks {
 public:
  /// Takes `most` of the positions, in equal steps, or all where there are fewer.
  PhotonBlocks(const std::vector<glm::vec3>& positions, std::size_t most);

  std::size_t size() const { return position_on_curve_.size(); }

  /// Squared distance from photon i of the subsample to its m-th nearest, itself the 0th; m is
  /// below size().
  float squared_distance(std::size_t i, std::size_t m, std::vector<float>& scratch) const;

 private:
  static constexpr std::size_t block_size = 32;

  std::size_t end_of(std::size_t block) const { return std::min((block + 1) * block_size, size()); }
  /// From the query to blocks `first` and those after it.
  void find_squared_gaps(const glm::vec3& query, std::size_t first, std::span<float> gaps) const;
  void append_distances(const glm::vec3& query, std::size_t first, std::size_t last,
                        std::vector<float>& distances) const;

  std::vector<std::uint32_t> position_on_curve_;  ///< of each photon
  std::array<std::vector<float>, 3> coordinate_;  ///< per axis, along the curve
  std::array<std::vector<float>, 3> low_, high_;  ///< per axis, of the blocks
};

}  // namespace photile::groups
