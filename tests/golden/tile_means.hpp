// Pictures as means of their tiles over seeds, and whether two sets of them may be of one program.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <sstream>
#include <stdexcept>
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

struct TileComparison {
  /// Largest difference over the one that is allowed, and where: above 1 the pictures differ.
  double most = 0;
  std::string where;
  double change = 0;   ///< of the illuminance in the whole picture, relative
  double visible = 0;  ///< the least such change that would fail
};

/// Student's t for 30 degrees of freedom, two-sided, at 1 - (1 - 1e-6)^(1/1000).
inline constexpr double t_critical = 8.72;
/// The tolerance of the whole picture: float sums in another order, where no seed differs from
/// another.
inline constexpr double rounding = 1e-5;

inline TileMean over_seeds(const std::string& tile, const std::vector<glm::dvec4>& values) {
  TileMean result{.tile = tile};
  for (const glm::dvec4& value : values) result.mean += value / double{golden_seeds};
  glm::dvec4 squares(0);
  for (const glm::dvec4& value : values) {
    squares += (value - result.mean) * (value - result.mean);
  }
  result.deviation = glm::sqrt(squares / double{golden_seeds - 1});
  return result;
}

/// How far the means may lie apart, where the whole picture has the mean `all`.
inline double allowed(double before, double now, double all) {
  const double pooled = std::sqrt((before * before + now * now) / 2);
  return t_critical * pooled * std::sqrt(2.0 / golden_seeds) + rounding * all;
}

/// Means of tiles of `side` x `side` pixels, which must divide the picture, and of all pixels.
inline TileMeans tile_means(const std::string& picture, const std::vector<Pixels>& seeds, int width,
                            int side) {
  const int height = static_cast<int>(seeds.front().size()) / width;
  if (seeds.size() != golden_seeds || width % side != 0 || height % side != 0) {
    throw std::logic_error("tiles need 16 seeds, and have to divide the picture");
  }
  const auto mean_of = [&](const Pixels& pixels, int left, int top, int columns, int rows) {
    glm::dvec4 sum(0);
    for (int y = top; y < top + rows; ++y) {
      for (int x = left; x < left + columns; ++x) {
        sum += pixels[static_cast<std::size_t>(y * width + x)];
      }
    }
    return sum / double(columns * rows);
  };
  const auto add = [&](TileMeans& means, const std::string& tile, int left, int top, int columns,
                       int rows) {
    std::vector<glm::dvec4> values;
    for (const Pixels& pixels : seeds) values.push_back(mean_of(pixels, left, top, columns, rows));
    means.tiles.push_back(over_seeds(tile, values));
  };
  TileMeans means{.picture = picture, .tiles = {}};
  add(means, "all", 0, 0, width, height);
  for (int row = 0; row < height / side; ++row) {
    for (int column = 0; column < width / side; ++column) {
      add(means, fmt::format("{}:{}", column, row), column * side, row * side, side, side);
    }
  }
  return means;
}

/// Student's test of two means with one variance, for each tile and channel: error probability 1e-6
/// over a thousand of them (Sidak). Throws std::logic_error where the tiles are not the same.
inline TileComparison compare(const TileMeans& before, const TileMeans& now) {
  if (before.tiles.size() != now.tiles.size() || before.picture != now.picture) {
    throw std::logic_error(now.picture + " has other tiles than the golden one");
  }
  TileComparison result;
  const glm::dvec4 all = before.tiles.front().mean;
  for (std::size_t i = 0; i < now.tiles.size(); ++i) {
    const TileMean &a = before.tiles[i], &b = now.tiles[i];
    for (int channel = 0; channel < 4; ++channel) {
      const double most = std::abs(b.mean[channel] - a.mean[channel]) /
                          allowed(a.deviation[channel], b.deviation[channel], all[channel]);
      if (most <= result.most) continue;
      result.most = most;
      result.where = fmt::format("tile {}, {}: {:.5g} in place of {:.5g}", b.tile, "RGBE"[channel],
                                 b.mean[channel], a.mean[channel]);
    }
  }
  const TileMean& whole = before.tiles.front();
  result.change = now.tiles.front().mean[3] / all[3] - 1;
  result.visible = allowed(whole.deviation[3], whole.deviation[3], all[3]) / all[3];
  return result;
}

/// The means as CSV: picture, tile, and mean and deviation of R, G, B and E.
inline std::string to_csv(const std::vector<TileMeans>& pictures) {
  std::string text = "picture,tile,R,G,B,E,deviation R,deviation G,deviation B,deviation E\n";
  for (const TileMeans& picture : pictures) {
    for (const TileMean& tile : picture.tiles) {
      text += picture.picture + "," + tile.tile;
      for (int i = 0; i < 4; ++i) text += fmt::format(",{:.7g}", tile.mean[i]);
      for (int i = 0; i < 4; ++i) text += fmt::format(",{:.3g}", tile.deviation[i]);
      text += "\n";
    }
  }
  return text;
}

inline std::vector<TileMeans> from_csv(const std::string& text) {
  std::vector<TileMeans> pictures;
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);  // the header
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string picture, tile, number;
    std::getline(fields, picture, ',');
    std::getline(fields, tile, ',');
    std::vector<double> numbers;
    while (std::getline(fields, number, ',')) numbers.push_back(std::stod(number));
    if (numbers.size() != 8) throw std::logic_error("no line of tiles: " + line);
    if (pictures.empty() || pictures.back().picture != picture) {
      pictures.push_back({.picture = picture, .tiles = {}});
    }
    pictures.back().tiles.push_back(
        {.tile = tile,
         .mean = {numbers[0], numbers[1], numbers[2], numbers[3]},
         .deviation = {numbers[4], numbers[5], numbers[6], numbers[7]}});
  }
  return pictures;
}

}  // namespace photile::test
