#include "report/plan_surroundings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "trace/ray_query.hpp"
#include "trace/room.hpp"

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

}  // namespace

std::vector<Segment> isoline(std::span<const double> values, int columns, int rows, double level) {
  std::vector<Segment> segments;
  for_each_square(values, columns, rows,
                  [&](const Square& square) { add_segments(square, level, segments); });
  return segments;
}

namespace {

constexpr double shown_around = 1.0;  ///< metres
/// The longest cuts of a detailed scene are drawn: the rest are ornaments of less than a pixel.
constexpr std::size_t most_walls = 20'000;
constexpr int samples_along = 300;  ///< that find furniture, along the longer side

/// The plane in the scene's coordinates, with positions in cells.
class Frame {
 public:
  explicit Frame(const measuring::PlaneLayout& layout)
      : layout_(layout),
        cells_(layout.columns, layout.rows),
        beyond_(shown_around / glm::length(layout.u), shown_around / glm::length(layout.v)) {}

  glm::dvec3 normal() const { return layout_.normal(); }
  double height_of(const glm::dvec3& point) const {
    return glm::dot(point - layout_.origin, normal());
  }
  glm::dvec2 cells_of(const glm::dvec3& point) const { return layout_.in_cells(point); }
  glm::dvec3 point_at(const glm::dvec2& cells) const { return layout_.at(cells); }
  glm::dvec2 low() const { return -beyond_ * cells_; }
  glm::dvec2 high() const { return (1.0 + beyond_) * cells_; }
  bool shows(const glm::dvec2& cells) const {
    return glm::all(glm::greaterThanEqual(cells, low())) &&
           glm::all(glm::lessThanEqual(cells, high()));
  }

 private:
  const measuring::PlaneLayout& layout_;
  glm::dvec2 cells_, beyond_;
};

/// The part of a segment that is shown (Liang and Barsky, "A new concept and method for line
/// clipping", 1984).
std::optional<Segment> clipped(const Segment& segment, const Frame& frame) {
  double begin = 0, end = 1;
  const glm::dvec2 along = segment[1] - segment[0];
  for (int axis = 0; axis < 2; ++axis) {
    const double to_low = frame.low()[axis] - segment[0][axis];
    const double to_high = frame.high()[axis] - segment[0][axis];
    if (along[axis] == 0) {
      if (to_low > 0 || to_high < 0) return std::nullopt;
      continue;
    }
    const double at_low = to_low / along[axis], at_high = to_high / along[axis];
    begin = std::max(begin, std::min(at_low, at_high));
    end = std::min(end, std::max(at_low, at_high));
  }
  if (begin >= end) return std::nullopt;
  return Segment{segment[0] + begin * along, segment[0] + end * along};
}

/// Where the plane cuts a triangle.
std::optional<Segment> cut(const std::array<glm::vec3, 3>& corners, const Frame& frame) {
  std::array<glm::dvec3, 2> ends;
  std::size_t found = 0;
  for (std::size_t i = 0; i < 3 && found < 2; ++i) {
    const glm::dvec3 a(corners[i]), b(corners[(i + 1) % 3]);
    const double above_a = frame.height_of(a), above_b = frame.height_of(b);
    if ((above_a > 0) == (above_b > 0)) continue;
    ends[found++] = a + above_a / (above_a - above_b) * (b - a);
  }
  if (found < 2) return std::nullopt;
  return clipped({frame.cells_of(ends[0]), frame.cells_of(ends[1])}, frame);
}

std::vector<Segment> walls_of(const Scene& scene, const Frame& frame) {
  std::vector<Segment> walls;
  for (std::uint32_t triangle = 0; triangle < scene.triangles.size(); ++triangle) {
    if (const auto segment = cut(scene.corners(triangle), frame)) walls.push_back(*segment);
  }
  if (walls.size() <= most_walls) return walls;
  const auto is_longer = [](const Segment& a, const Segment& b) {
    return glm::distance(a[0], a[1]) > glm::distance(b[0], b[1]);
  };
  std::nth_element(walls.begin(), walls.begin() + most_walls, walls.end(), is_longer);
  walls.resize(most_walls);
  return walls;
}

/// Metres from the plane to what lies below, at the middles of columns x rows.
std::vector<double> depths_below(const RayScene& rays, const Frame& frame, int columns, int rows) {
  const trace::FlushDenormals flush_denormals;
  const glm::dvec3 down = -frame.normal();
  const glm::dvec2 extent = frame.high() - frame.low();
  std::vector<double> depths;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const glm::dvec2 place =
          frame.low() + extent * glm::dvec2((x + 0.5) / columns, (y + 0.5) / rows);
      const auto hit = trace::intersect(rays, glm::vec3(frame.point_at(place)), glm::vec3(down));
      depths.push_back(hit ? -frame.height_of(trace::position_of(rays.scene(), *hit))
                           : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return depths;
}

std::vector<Segment> furniture_of(const RayScene& rays, const measuring::PlaneLayout& layout,
                                  const Frame& frame) {
  const glm::dvec2 metres(glm::length(layout.u) + 2 * shown_around,
                          glm::length(layout.v) + 2 * shown_around);
  const double step = std::max(metres.x, metres.y) / samples_along;
  const int columns = std::max(2, static_cast<int>(std::lround(metres.x / step)));
  const int rows = std::max(2, static_cast<int>(std::lround(metres.y / step)));
  const std::vector<double> depths = depths_below(rays, frame, columns, rows);
  std::vector<double> known;
  std::ranges::copy_if(depths, std::back_inserter(known),
                       [](double depth) { return !std::isnan(depth); });
  if (known.empty()) return {};
  const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
  std::nth_element(known.begin(), middle, known.end());
  const double to_floor = *middle;  // most of a floor is free
  std::vector<Segment> outlines;
  for (const double share : {0.2, 0.5, 0.8}) {
    for (const Segment& segment : isoline(depths, columns, rows, share * to_floor)) {
      const auto in_cells = [&](const glm::dvec2& place) {
        return frame.low() + (frame.high() - frame.low()) * place / glm::dvec2(columns, rows);
      };
      outlines.push_back({in_cells(segment[0]), in_cells(segment[1])});
    }
  }
  return outlines;
}

/// The convex hull of an area light's surface, or of the opening that its photometric file states.
std::vector<glm::dvec2> outline_of(const Scene& scene, const Light& light, const Frame& frame) {
  std::vector<glm::dvec2> corners;
  for (const std::uint32_t triangle : light.triangles) {
    for (const glm::vec3& corner : scene.corners(triangle)) {
      corners.push_back(frame.cells_of(glm::dvec3(corner)));
    }
  }
  if (light.has_position() && light.distribution != none) {
    const LuminousOpening& opening = scene.distributions[light.distribution].opening();
    const glm::dvec3 x(light.x_axis), y = glm::cross(x, glm::dvec3(light.direction));
    for (const double right : {-0.5, 0.5}) {
      for (const double ahead : {-0.5, 0.5}) {
        corners.push_back(frame.cells_of(glm::dvec3(light.position) + right * opening.x * x +
                                         ahead * opening.y * y));
      }
    }
  }
  std::vector<glm::dvec2> hull;  // corners that lie farthest in one of many directions
  constexpr int directions = 64;
  for (int i = 0; i < directions && !corners.empty(); ++i) {
    const double angle = glm::two_pi<double>() * (i + 0.5) / directions;
    const glm::dvec2 there(std::cos(angle), std::sin(angle));
    const auto farthest = std::ranges::max_element(corners, [&](const auto& a, const auto& b) {
      return glm::dot(a, there) < glm::dot(b, there);
    });
    if (hull.empty() || hull.back() != *farthest) hull.push_back(*farthest);
  }
  if (hull.size() > 1 && hull.front() == hull.back()) hull.pop_back();
  return hull;
}

}  // namespace

std::optional<glm::dvec3> place_of(const Scene& scene, const Light& light) {
  if (light.is_distant()) return std::nullopt;
  if (light.kind != LightKind::area) return glm::dvec3(light.position);
  glm::dvec3 sum(0.0);
  double total = 0;
  for (const std::uint32_t triangle : light.triangles) {
    const auto corners = scene.corners(triangle);
    const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
    const double area = glm::length(glm::cross(b - a, c - a));
    sum += area * (a + b + c) / 3.0;
    total += area;
  }
  if (!(total > 0)) return std::nullopt;
  return sum / total;
}

PlanSurroundings surroundings_of(const RayScene& rays, const measuring::PlaneLayout& in_file) {
  constexpr double least_cosine = 0.999;
  const Scene& scene = rays.scene();
  const measuring::PlaneLayout layout = measuring::in_scene(scene, in_file);
  if (layout.normal().y < least_cosine) return {};
  const Frame frame(layout);
  PlanSurroundings around{
      shown_around, walls_of(scene, frame), furniture_of(rays, layout, frame), {}};
  for (std::size_t light = 0; light < scene.lights.size(); ++light) {
    const auto place = place_of(scene, scene.lights[light]);
    if (!place || !frame.shows(frame.cells_of(*place))) continue;
    around.lamps.push_back(
        {light + 1, frame.cells_of(*place), outline_of(scene, scene.lights[light], frame)});
  }
  const trace::PlanAxes axes;
  glm::dvec3 middle = layout.origin + 0.5 * (layout.u + layout.v);
  if (!layout.cells
           .empty()) {  // the middle itself may lie in a cupboard: those points have no cell
    const auto away = [&](std::uint32_t cell) {
      return glm::distance(layout.middle_of(cell), middle);
    };
    middle = layout.middle_of(*std::ranges::min_element(
        layout.cells, [&](std::uint32_t a, std::uint32_t b) { return away(a) < away(b); }));
  }
  if (const auto room = trace::Room::around(rays, axes, middle)) {
    const auto cells = [&](const glm::dvec2& plan) {
      return frame.cells_of(plan.x * axes.right + plan.y * axes.ahead);
    };
    around.room = Segment{cells(room->low()), cells(room->high())};
  }
  return around;
}

namespace {

/// In metres, to a millimetre. Segments that meet are one line, and a straight run of them is one
/// segment.
std::string path_of(const std::vector<Segment>& segments, const glm::dvec2& cell) {
  const auto key = [&](const glm::dvec2& end) {
    const glm::dvec2 millimetres = glm::round(1000.0 * end * cell);
    return std::pair(millimetres.x, millimetres.y);
  };
  std::multimap<std::pair<double, double>, std::size_t> meeting;
  std::vector<bool> drawn(segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const auto [begin, end] = segments[i];
    drawn[i] = key(begin) == key(end);  // no length
    meeting.emplace(key(begin), i);
    meeting.emplace(key(end), i);
  }
  // The other end of a segment that goes on from here.
  const auto next = [&](const glm::dvec2& end) -> std::optional<glm::dvec2> {
    const auto [first, last] = meeting.equal_range(key(end));
    const auto found = std::find_if(first, last, [&](const auto& at) { return !drawn[at.second]; });
    if (found == last) return std::nullopt;
    drawn[found->second] = true;
    const Segment& segment = segments[found->second];
    return segment[key(segment[0]) == key(end) ? 1 : 0];
  };
  std::string path;
  const auto add = [&](char command, const glm::dvec2& place) {
    fmt::format_to(std::back_inserter(path), "{}{:.3f} {:.3f}", command, place.x * cell.x,
                   place.y * cell.y);
  };
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (drawn[i]) continue;
    drawn[i] = true;
    glm::dvec2 begin = segments[i][0], end = segments[i][1];
    glm::dvec2 along = glm::normalize((end - begin) * cell);
    add('M', begin);
    while (const auto on = next(end)) {
      constexpr double aside = 1e-3;  // metres
      const glm::dvec2 way = (*on - begin) * cell;
      if (std::abs(along.x * way.y - along.y * way.x) > aside ||
          glm::dot(along, way) < glm::dot(along, (end - begin) * cell)) {
        add('L', end);
        begin = end;
        along = glm::normalize((*on - begin) * cell);
      }
      end = *on;
    }
    add('L', end);
  }
  return path;
}

}  // namespace

nlohmann::ordered_json plan_json(const RayScene& rays, const measuring::PlaneLayout& layout,
                                 std::optional<double> north) {
  const PlanSurroundings around = surroundings_of(rays, layout);
  const glm::dvec2 cell(glm::length(layout.u) / layout.columns,
                        glm::length(layout.v) / layout.rows);
  const auto metres = [&](const glm::dvec2& place) -> nlohmann::ordered_json {
    return {place.x * cell.x, place.y * cell.y};
  };
  nlohmann::ordered_json json{{"reach", around.reach},
                              {"walls", path_of(around.walls, cell)},
                              {"furniture", path_of(around.furniture, cell)},
                              {"lamps", nlohmann::ordered_json::array()}};
  for (const LampMark& lamp : around.lamps) {
    auto outline = nlohmann::ordered_json::array();
    for (const glm::dvec2& corner : lamp.outline) outline.push_back(metres(corner));
    json["lamps"].push_back(
        {{"number", lamp.number}, {"position", metres(lamp.place)}, {"outline", outline}});
  }
  if (north && around.reach > 0) {
    const measuring::PlaneLayout placed = measuring::in_scene(rays.scene(), layout);
    const glm::dvec3 there(std::sin(glm::radians(*north)), 0, -std::cos(glm::radians(*north)));
    json["north"] = {glm::dot(there, glm::normalize(placed.u)),
                     glm::dot(there, glm::normalize(placed.v))};
  }
  if (const auto& room = around.room) json["room"] = {metres((*room)[0]), metres((*room)[1])};
  return json;
}

}  // namespace photile::report
