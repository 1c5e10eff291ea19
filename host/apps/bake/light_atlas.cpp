#include "bake/light_atlas.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "photile/errors.hpp"
#include "trace/surface.hpp"

namespace photile::bake {

namespace {

/// A lookup between the outermost texels stays within them; the border is for lookups outside.
constexpr std::uint32_t border = 1;

/// The factor by which the distance of texels grows where the picture is too small.
constexpr double coarser = 1.25;

/// Metres: no surface is as large.
constexpr double widest_texel = 1e6;

}  // namespace

bool is_drawn(const Scene& scene, const cache::Charts& charts, std::uint32_t oriented_face) {
  const scene::CoincidentFaces& coincident = charts.coincident();
  return coincident.before(oriented_face).empty() ||
         !coincident.parts_of(scene, oriented_face).counted.empty();
}

LightAtlas::LightAtlas(const Scene& scene, const cache::Charts& charts,
                       std::vector<std::uint32_t> sides, const BakeParameters& parameters)
    : scene_(scene), charts_(charts), sides_(std::move(sides)) {
  const auto most_side = static_cast<std::uint32_t>(parameters.most_side);
  texel_ = parameters.texel > 0 ? parameters.texel : charts.spacing() / 2;
  const auto fits = [&] {
    return place_charts(texel_, most_side) &&
           std::uint64_t{atlas_.width} * atlas_.height <= parameters.most_texels;
  };
  while (!fits()) {
    if (texel_ > widest_texel) {
      const bool bounded = parameters.most_texels != std::numeric_limits<std::uint64_t>::max();
      throw UsageError(fmt::format(
          "a picture of {} x {}{} has no room for {} surfaces; give a larger --most-texels",
          most_side, most_side,
          bounded ? fmt::format(" and {} texels", parameters.most_texels) : "", charts.size()));
    }
    if (parameters.texel > 0 && parameters.exact) {
      throw UsageError(fmt::format("texels {} m apart do not fit in {} x {}; give a larger --texel",
                                   texel_, most_side, most_side));
    }
    texel_ *= coarser;
  }
}

std::vector<DrawnTriangle> LightAtlas::drawn(std::uint32_t oriented_face) const {
  const std::uint32_t triangle = triangle_of(oriented_face);
  const std::size_t second = 1 + side_of(oriented_face), third = 2 - side_of(oriented_face);
  const scene::CoincidentFaces& coincident = charts_.coincident();
  if (coincident.before(oriented_face).empty()) {
    const std::array<glm::vec3, 3> corner{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    return {{corner[0], corner[second], corner[third]}};
  }
  std::vector<DrawnTriangle> triangles;
  for (const auto& part : coincident.parts_of(scene_, oriented_face).counted) {
    const auto weights = [&](std::size_t corner) {
      const auto [number, u, v, other, before] =
          trace::nearest_on_triangle(scene_, triangle, glm::dvec3(part[corner]));
      return glm::vec3(1.0f - u - v, u, v);
    };
    triangles.push_back({weights(0), weights(second), weights(third)});
  }
  return triangles;
}

bool LightAtlas::place_charts(double texel, std::uint32_t most_side) {
  const cache::Charts& charts = charts_;
  placed_.clear();
  place_of_chart_.assign(charts.size(), none);
  member_.assign(charts.size(), none);
  for (const std::uint32_t side : sides_) {
    const std::uint32_t chart = charts.chart_of()[side];
    if (chart == none || place_of_chart_[chart] != none) continue;
    member_[chart] = side;
    place_of_chart_[chart] = static_cast<std::uint32_t>(placed_.size());
    const cache::Chart& lattice = charts[chart];
    const glm::dvec2 size = lattice.spacing * glm::dvec2(lattice.columns, lattice.rows);
    // A hundredth of a cell more is rounding.
    const glm::dvec2 cells = glm::max(glm::ceil(size / texel - 0.01), glm::dvec2(1.0));
    if (std::max(cells.x, cells.y) > most_side) return false;
    const glm::uvec2 counted(cells);
    const std::uint32_t more = 1 + 2 * border;
    placed_.push_back({chart, counted, {0, 0, counted.x + more, counted.y + more}});
  }
  std::vector<TexelRectangle> rectangles;
  for (const Placed& placed : placed_) rectangles.push_back(placed.rectangle);
  const std::optional<Atlas> atlas = pack(rectangles, most_side);
  if (!atlas) return false;
  for (std::size_t i = 0; i < placed_.size(); ++i) placed_[i].rectangle = rectangles[i];
  atlas_ = *atlas;
  return true;
}

/// The position of a texel of the rectangle: metres from the chart's origin.
glm::dvec2 LightAtlas::place(const Placed& placed, std::uint32_t x, std::uint32_t y) const {
  const cache::Chart& lattice = charts_[placed.chart];
  const glm::uvec2 within(std::clamp(x, border, placed.cells.x + border) - border,
                          std::clamp(y, border, placed.cells.y + border) - border);
  const glm::dvec2 size = lattice.spacing * glm::dvec2(lattice.columns, lattice.rows);
  return glm::dvec2(within) / glm::dvec2(placed.cells) * size;
}

glm::vec3 LightAtlas::point(const Placed& placed, std::uint32_t x, std::uint32_t y) const {
  const cache::Chart& lattice = charts_[placed.chart];
  const glm::dvec2 at = place(placed, x, y);
  return glm::vec3(lattice.origin + at.x * lattice.across + at.y * lattice.along);
}

std::array<glm::vec2, 3> LightAtlas::corners(std::uint32_t oriented_face) const {
  const cache::Charts& charts = charts_;
  const std::uint32_t chart = charts.chart_of()[oriented_face];
  std::array<glm::vec2, 3> corners{};
  if (chart == none) return corners;
  const Placed& placed = placed_[place_of_chart_[chart]];
  const cache::Chart& lattice = charts[chart];
  const auto positions = scene_.corners(triangle_of(oriented_face));
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 offset = glm::dvec3(positions[i]) - lattice.origin;
    const glm::dvec2 place(glm::dot(offset, lattice.across), glm::dot(offset, lattice.along));
    const glm::dvec2 size = lattice.spacing * glm::dvec2(lattice.columns, lattice.rows);
    const glm::dvec2 texel = glm::dvec2(placed.rectangle.x, placed.rectangle.y) + (border + 0.5) +
                             glm::clamp(place / size, 0.0, 1.0) * glm::dvec2(placed.cells);
    corners[i] = glm::vec2(texel / glm::dvec2(atlas_.width, atlas_.height));
  }
  return corners;
}

/// A texel that no triangle covers has the light of the surface nearest to it, so that a lookup at
/// an edge blends light of the surface alone.
void LightAtlas::add_points(std::size_t i, TexelPoints& points) const {
  const Placed& placed = placed_[i];
  const TexelRectangle& rectangle = placed.rectangle;
  const std::size_t first = points.texels.size();
  const std::size_t count = std::size_t{rectangle.width} * rectangle.height;
  points.texels.resize(first + count);
  points.hits.position.resize(first + count);
  points.hits.oriented_face.resize(first + count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t texel) {
    const auto x = static_cast<std::uint32_t>(texel % rectangle.width);
    const auto y = static_cast<std::uint32_t>(texel / rectangle.width);
    const cache::Charts::Support owner =
        charts_.support(placed.chart, place(placed, x, y), 2 * texel_);
    points.texels[first + texel] = std::size_t{rectangle.y + y} * atlas_.width + rectangle.x + x;
    points.hits.oriented_face[first + texel] = oriented(owner.where.triangle, owner.side);
    points.hits.position[first + texel] =
        trace::surface_point(scene_, owner.where, owner.side).position;
  });
}

std::uint64_t LightAtlas::used_texels() const {
  std::uint64_t count = 0;
  for (const Placed& placed : placed_) {
    count += std::uint64_t{placed.rectangle.width} * placed.rectangle.height;
  }
  return count;
}

std::optional<Atlas> pack(std::span<TexelRectangle> rectangles, std::uint32_t most_side) {
  std::vector<std::size_t> order(rectangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(rectangles[b].height, rectangles[b].width, a) <
           std::tuple(rectangles[a].height, rectangles[a].width, b);
  });
  double area = 0;
  std::uint32_t widest = 1;
  for (const TexelRectangle& rectangle : rectangles) {
    area += double{static_cast<double>(rectangle.width)} * rectangle.height;
    widest = std::max(widest, rectangle.width);
  }
  if (widest > most_side) return std::nullopt;
  const double square = std::ceil(std::sqrt(area));
  const auto width = static_cast<std::uint32_t>(
      std::clamp(square, static_cast<double>(widest), static_cast<double>(most_side)));
  std::uint64_t shelf = 0, x = 0, height = 0;
  for (const std::size_t i : order) {
    TexelRectangle& rectangle = rectangles[i];
    if (x + rectangle.width > width) {
      shelf = height;
      x = 0;
    }
    if (x == 0) height = shelf + rectangle.height;
    if (height > most_side) return std::nullopt;
    rectangle.x = static_cast<std::uint32_t>(x);
    rectangle.y = static_cast<std::uint32_t>(shelf);
    x += rectangle.width;
  }
  return Atlas{width, static_cast<std::uint32_t>(std::max<std::uint64_t>(height, 1))};
}

}  // namespace photile::bake
