#include "measuring/isolines.hpp"

#include <cmath>
#include <cstddef>

namespace photile::measuring {
namespace {

/// Four neighbouring middles, counter-clockwise from the lowest column and row.
struct Square {
  std::array<glm::dvec2, 4> place;
  std::array<double, 4> value;

  /// Where the level crosses the side from corner i to the next.
  glm::dvec2 crossing(std::size_t i, double level) const {
    const std::size_t j = (i + 1) % 4;
    const double share = (level - value[i]) / (value[j] - value[i]);
    return place[i] + share * (place[j] - place[i]);
  }
};

void add_segments(const Square& square, double level, std::vector<Segment>& segments) {
  std::vector<std::size_t> crossed;  // sides, ascending
  double mean = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (std::isnan(square.value[i])) return;
    if ((square.value[i] >= level) != (square.value[(i + 1) % 4] >= level)) crossed.push_back(i);
    mean += square.value[i] / 4;
  }
  const auto join = [&](std::size_t a, std::size_t b) {
    segments.push_back({square.crossing(crossed[a], level), square.crossing(crossed[b], level)});
  };
  if (crossed.size() == 2) join(0, 1);
  if (crossed.size() < 4) return;
  // Sides 0 and 1 meet in corner 1: cut it off where it differs from the middle.
  const bool corner_1_alone = (square.value[1] >= level) != (mean >= level);
  join(0, corner_1_alone ? 1 : 3);
  join(corner_1_alone ? 2 : 1, corner_1_alone ? 3 : 2);
}

}  // namespace

std::vector<Segment> isoline(std::span<const double> values, int columns, int rows, double level) {
  std::vector<Segment> segments;
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      Square square;
      for (std::size_t i = 0; i < 4; ++i) {
        const int x = column + (i == 1 || i == 2 ? 1 : 0), y = row + (i >= 2 ? 1 : 0);
        square.place[i] = {x + 0.5, y + 0.5};
        square.value[i] = values[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                                 static_cast<std::size_t>(x)];
      }
      add_segments(square, level, segments);
    }
  }
  return segments;
}

}  // namespace photile::measuring
