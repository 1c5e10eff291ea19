// Pictures as means of their tiles over seeds, and whether two sets of them may be of one program.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace photile::test {

inline constexpr int golden_seeds = 16;  ///< that a picture is rendered with

/// Mean over the seeds, and standard deviation from one to another, of some pixels of a picture.
struct TileMean {
  std::string tile;  ///< "column:row", or "all"
  glm::dvec4 mean{0}, deviation{0};
};

/// One picture by one method.
struct TileMeans {
  std::string picture;
  std::vector<TileMean> tiles;  ///< "all" first
};

/// Pixels of one seed, row by row: radiance as linear R, G, B, and illuminance E of what is seen,
/// which lamps in the picture do not drown.
using Pixels = std::vector<glm::dvec4>;

/// Means of tiles of `side` x `side` pixels, which must divide the picture, and of all pixels.
TileMeans tile_means(const std::string& picture, const std::vector<Pixels>& seeds, int width,
                     int side);

struct TileComparison {
  /// Largest difference over the one that is allowed, and where: above 1 the pictures differ.
  double most = 0;
  std::string where;
  double change = 0;   ///< of the illuminance in the whole picture, relative
  double visible = 0;  ///< the least such change that would fail
};

/// Student's test of two means with one variance, for each tile and channel: error probability 1e-6
/// over a thousand of them (Sidak). Throws std::logic_error where the tiles are not the same.
TileComparison compare(const TileMeans& before, const TileMeans& now);

/// The means as CSV: picture, tile, and mean and deviation of R, G, B and E.
std::string to_csv(const std::vector<TileMeans>& pictures);
std::vector<TileMeans> from_csv(const std::string& text);

}  // namespace photile::test
