#include "scene/emission_cells.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace photile::scene {
namespace {

constexpr std::size_t most_cells = std::size_t{1} << 22;
constexpr double most_cuts = 256;
constexpr double least_share = 0.02;  // of the mean luminance

/// Cuts of an edge that make cells of about a texel.
std::uint32_t cuts_of(const Scene& scene, const Light& light, std::uint32_t triangle) {
  const Texture& texture = scene.textures[light.emission_texture];
  const auto& uv = scene.corner_emission_uv[triangle];
  const glm::vec2 size(texture.width(), texture.height());
  float longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    longest = std::max(longest, glm::length(size * (uv[(i + 1) % 3] - uv[i])));
  }
  const double share =
      static_cast<double>(most_cells) / static_cast<double>(light.triangles.size());
  const double limit = std::max(1.0, std::min(most_cuts, std::floor(std::sqrt(share))));
  // A NaN or infinity among the coordinates makes a single cell.
  return longest < 1e9f ? static_cast<std::uint32_t>(
                              std::clamp(std::ceil(static_cast<double>(longest)), 1.0, limit))
                        : 1;
}

/// A cell of a triangle of n cuts: row by row from the edge between the first two corners.
struct Cell {
  std::uint32_t column, row;
  bool inverted;  ///< its tip points to that edge

  std::size_t index(std::uint32_t n) const {
    return std::size_t{row} * (2 * n - row) + 2 * column + (inverted ? 1 : 0);
  }
  static Cell at(std::size_t index, std::uint32_t n) {
    const double left = static_cast<double>(std::size_t{n} * n - index);
    const auto row = n - static_cast<std::uint32_t>(std::ceil(std::sqrt(left)));
    const std::size_t within = index - std::size_t{row} * (2 * n - row);
    return {static_cast<std::uint32_t>(within / 2), row, within % 2 == 1};
  }
  /// Weights of the triangle's second and third corner, of a place in the cell given by those of
  /// the cell's.
  glm::dvec2 place(double u, double v, std::uint32_t n) const {
    if (inverted) return glm::dvec2(column + 1 - u, row + 1 - v) / static_cast<double>(n);
    return glm::dvec2(column + u, row + v) / static_cast<double>(n);
  }
};

/// The cell that holds a place of the triangle.
Cell cell_of(double u, double v, std::uint32_t n) {
  const double x = std::clamp(u, 0.0, 1.0) * n, y = std::clamp(v, 0.0, 1.0) * n;
  const auto row = std::min(static_cast<std::uint32_t>(y), n - 1);
  const auto column = std::min(static_cast<std::uint32_t>(x), n - 1 - row);
  const bool inverted = (x - column) + (y - row) > 1.0 && column + row + 1 < n;
  return {column, row, inverted};
}

/// Mean of the radiance in a cell, from the middles of its quarters.
glm::dvec3 mean_radiance(const Scene& scene, const Light& light, std::uint32_t triangle,
                         const Cell& cell, std::uint32_t n) {
  constexpr std::array<glm::dvec2, 4> middles{
      {{1.0 / 6, 1.0 / 6}, {4.0 / 6, 1.0 / 6}, {1.0 / 6, 4.0 / 6}, {2.0 / 6, 2.0 / 6}}};
  glm::dvec3 sum(0.0);
  for (const glm::dvec2& middle : middles) {
    const glm::dvec2 at = cell.place(middle.x, middle.y, n);
    sum += textured_radiance(scene, light, {triangle, at.x, at.y});
  }
  return 0.25 * sum;
}

}  // namespace

glm::dvec3 textured_radiance(const Scene& scene, const Light& light,
                             const EmissionCells::Place& place) {
  const auto& uv = scene.corner_emission_uv[place.triangle];
  const auto u = static_cast<float>(place.u), v = static_cast<float>(place.v);
  return glm::dvec3(light.texel_radiance * scene.textures[light.emission_texture].sample(
                                               (1.0f - u - v) * uv[0] + u * uv[1] + v * uv[2]));
}

EmissionCells::EmissionCells(const Scene& scene, const Light& light) : light_(&light) {
  double area = 0;
  std::vector<double> bright;  // luminance of each cell
  for (const std::uint32_t triangle : light.triangles) {
    const std::uint32_t n = cuts_of(scene, light, triangle);
    const double whole = triangle_area(scene, triangle);
    const double cell_area = whole / (static_cast<double>(n) * n);
    triangles_.push_back({n, bright.size(), cell_area});
    area += whole;
    for (std::size_t i = 0; i < std::size_t{n} * n; ++i) {
      const glm::dvec3 mean = mean_radiance(scene, light, triangle, Cell::at(i, n), n);
      bright.push_back(luminance(mean));
      integral_ += cell_area * mean;
    }
  }
  const double least = area > 0 ? least_share * luminance(integral_) / area : 0.0;
  double sum = 0;
  for (const Triangle& triangle : triangles_) {
    const std::size_t last = triangle.first_cell + std::size_t{triangle.cuts} * triangle.cuts;
    for (std::size_t cell = triangle.first_cell; cell < last; ++cell) {
      weight_up_to_.push_back(sum += triangle.cell_area * std::max(bright[cell], least));
    }
  }
  const std::size_t shares = std::bit_ceil(weight_up_to_.size());
  for (std::size_t share = 0; share < shares; ++share) {
    first_of_share_.push_back(first_beyond(
        0, weight_up_to_.size(), static_cast<double>(share) / static_cast<double>(shares) * sum));
  }
  first_of_share_.push_back(static_cast<std::uint32_t>(weight_up_to_.size()));
}

std::uint32_t EmissionCells::first_beyond(std::size_t first, std::size_t last,
                                          double weight) const {
  const double* const cells = weight_up_to_.data();
  return static_cast<std::uint32_t>(std::upper_bound(cells + first, cells + last, weight) - cells);
}

EmissionCells::Place EmissionCells::sample(double target, double u1, double u2) const {
  const double below_one = std::min(target, 1.0 - 0x1p-53);
  const auto share = static_cast<std::size_t>(
      below_one * static_cast<double>(first_of_share_.size() - 1));  // exact: a power of two
  const std::size_t cell = first_beyond(first_of_share_[share], first_of_share_[share + 1],
                                        below_one * weight_up_to_.back());
  const auto next = std::upper_bound(
      triangles_.begin(), triangles_.end(), cell,
      [](std::size_t value, const Triangle& triangle) { return value < triangle.first_cell; });
  const auto number = static_cast<std::size_t>(next - triangles_.begin()) - 1;
  const Triangle& triangle = triangles_[number];
  const double root = std::sqrt(u1);
  const glm::dvec2 at = Cell::at(cell - triangle.first_cell, triangle.cuts)
                            .place(root * (1 - u2), root * u2, triangle.cuts);
  return {light_->triangles[number], at.x, at.y};
}

double EmissionCells::density(const Place& place) const {
  const auto found =
      std::lower_bound(light_->triangles.begin(), light_->triangles.end(), place.triangle);
  const Triangle& triangle =
      triangles_[static_cast<std::size_t>(found - light_->triangles.begin())];
  const Cell cell = cell_of(place.u, place.v, triangle.cuts);
  return weight(triangle.first_cell + cell.index(triangle.cuts)) /
         (weight_up_to_.back() * triangle.cell_area);
}

}  // namespace photile::scene
