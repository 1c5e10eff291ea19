#include "report/isolines.hpp"

#include <cmath>
#include <cstddef>

namespace photile::report {
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

/// Calls work(square) for each square of four middles.
template <class Work>
void for_each_square(std::span<const double> values, int columns, int rows, const Work& work) {
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      Square square;
      for (std::size_t i = 0; i < 4; ++i) {
        const int x = column + (i == 1 || i == 2 ? 1 : 0), y = row + (i >= 2 ? 1 : 0);
        square.place[i] = {x + 0.5, y + 0.5};
        square.value[i] = values[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                                 static_cast<std::size_t>(x)];
      }
      work(square);
    }
  }
}

/// A corner of a polygon over which values are linear.
struct ValuedCorner {
  glm::dvec2 place;
  double value;
};

/// The part of a convex polygon where sign x (value - level) >= 0 (Sutherland and Hodgman, 1974).
std::vector<ValuedCorner> clipped(const std::vector<ValuedCorner>& corners, double level,
                                  double sign) {
  std::vector<ValuedCorner> kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const ValuedCorner &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const bool a_in = sign * (a.value - level) >= 0, b_in = sign * (b.value - level) >= 0;
    if (a_in) kept.push_back(a);
    if (a_in != b_in) {
      const double share = (level - a.value) / (b.value - a.value);
      kept.push_back({a.place + share * (b.place - a.place), level});
    }
  }
  return kept;
}

}  // namespace

std::vector<Segment> isoline(std::span<const double> values, int columns, int rows, double level) {
  std::vector<Segment> segments;
  for_each_square(values, columns, rows,
                  [&](const Square& square) { add_segments(square, level, segments); });
  return segments;
}

std::vector<Polygon> isoband(std::span<const double> values, int columns, int rows, double low,
                             double high) {
  std::vector<Polygon> polygons;
  for_each_square(values, columns, rows, [&](const Square& square) {
    ValuedCorner middle{glm::dvec2(0.0), 0};
    for (std::size_t i = 0; i < 4; ++i) {
      middle.place += 0.25 * square.place[i];
      middle.value += 0.25 * square.value[i];
    }
    if (std::isnan(middle.value)) return;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) % 4;
      const auto part = clipped(
          clipped({{square.place[i], square.value[i]}, {square.place[j], square.value[j]}, middle},
                  low, 1),
          high, -1);
      if (part.size() < 3) continue;
      Polygon& polygon = polygons.emplace_back();
      for (const ValuedCorner& corner : part) polygon.push_back(corner.place);
    }
  });
  return polygons;
}

}  // namespace photile::report
