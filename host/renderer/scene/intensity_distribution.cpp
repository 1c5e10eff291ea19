#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "photile/scene.hpp"

namespace photile {
namespace {

using std::numbers::pi;

std::vector<double> in_radians(const std::vector<double>& degrees) {
  if (degrees.size() < 2) throw std::invalid_argument("IntensityDistribution: too few angles");
  std::vector<double> radians;
  for (const double angle : degrees) {
    if (!radians.empty() && !(angle * pi / 180.0 > radians.back())) {
      throw std::invalid_argument("IntensityDistribution: angles do not ascend");
    }
    radians.push_back(angle * pi / 180.0);
  }
  return radians;
}

/// The interval of `angles` that holds `angle`, which lies between the first and the last.
std::size_t interval_of(const std::vector<double>& angles, double angle) {
  const auto above = std::upper_bound(angles.begin() + 1, angles.end() - 1, angle);
  return static_cast<std::size_t>(above - angles.begin()) - 1;
}

}  // namespace

double LuminousOpening::projected_area(const glm::dvec3& direction) const {
  // Faces of the box around it, in projection.
  const glm::dvec3 d = glm::abs(direction);
  const double across_x = y * heights[direction.x < 0 ? 2 : 0] * d.x;
  const double across_y = x * heights[direction.y < 0 ? 3 : 1] * d.y;
  const double across_z = x * y * d.z;
  // An ellipse covers pi / 4 of its rectangle, and the outline of a cylinder's side is as wide as
  // its ellipse is in that direction.
  switch (shape) {
    case Shape::box:
      return across_x + across_y + across_z;
    case Shape::upright_cylinder:
      return 0.25 * pi * across_z + std::hypot(across_x, across_y);
    case Shape::cylinder_along_x:
      return 0.25 * pi * across_x + std::hypot(across_y, across_z);
    case Shape::cylinder_along_y:
      return 0.25 * pi * across_y + std::hypot(across_x, across_z);
    case Shape::ellipsoid:
      return 0.25 * pi * std::hypot(across_x, across_y, across_z);
  }
  return 0;
}

IntensityDistribution::IntensityDistribution(std::string name, const PhotometricAxes& axes,
                                             const std::vector<double>& polar,
                                             const std::vector<double>& azimuth,
                                             std::vector<float> intensity)
    : name_(std::move(name)),
      axes_(axes),
      polar_(in_radians(polar)),
      azimuth_(in_radians(azimuth)),
      intensity_(std::move(intensity)) {
  const auto valid = [](float value) { return std::isfinite(value) && value >= 0.0f; };
  if (polar.front() < 0.0 || polar.back() > 180.0 || azimuth.back() - azimuth.front() > 360.0 ||
      intensity_.size() != polar.size() * azimuth.size() ||
      !std::all_of(intensity_.begin(), intensity_.end(), valid)) {
    throw std::invalid_argument("IntensityDistribution: no grid of intensities on a sphere");
  }
  for (std::size_t column = 0; column < columns(); ++column) {
    for (std::size_t row = 0; row < rows(); ++row) flux_ += cell_flux(column, row);
  }
}

double IntensityDistribution::interpolated(std::size_t column, std::size_t row, double azimuth,
                                           double polar) const {
  const double u = (azimuth - azimuth_[column]) / (azimuth_[column + 1] - azimuth_[column]);
  const double v = (polar - polar_[row]) / (polar_[row + 1] - polar_[row]);
  const double first = std::lerp(at(column, row), at(column, row + 1), v);
  const double second = std::lerp(at(column + 1, row), at(column + 1, row + 1), v);
  return std::lerp(first, second, u);
}

double IntensityDistribution::intensity(const glm::dvec3& direction) const {
  const double polar = std::acos(std::clamp(glm::dot(direction, axes_.pole), -1.0, 1.0));
  if (polar < polar_.front() || polar > polar_.back()) return 0.0;
  double azimuth = std::atan2(glm::dot(direction, axes_.quarter), glm::dot(direction, axes_.zero));
  azimuth -= 2.0 * pi * std::floor((azimuth - azimuth_.front()) / (2.0 * pi));
  // A full circle may end a rounding before the angle that stands for its start.
  const double gap = azimuth_.front() + 2.0 * pi - azimuth_.back();
  if (azimuth > azimuth_.back() && gap < 1e-9) azimuth = azimuth_.back();
  if (azimuth > azimuth_.back()) return 0.0;
  return interpolated(interval_of(azimuth_, azimuth), interval_of(polar_, polar), azimuth, polar);
}

double IntensityDistribution::cell_flux(std::size_t column, std::size_t row) const {
  // Over the azimuth the mean of the two columns counts. Over the polar angle p the integral of
  // (a + s (p - p0)) sin p is a cos p0 - b cos p1 + s (sin p1 - sin p0), where b is the value at
  // p1.
  const double a = 0.5 * (at(column, row) + at(column + 1, row));
  const double b = 0.5 * (at(column, row + 1) + at(column + 1, row + 1));
  const double p0 = polar_[row], p1 = polar_[row + 1];
  const double slope = (b - a) / (p1 - p0);
  const double over_polar =
      a * std::cos(p0) - b * std::cos(p1) + slope * (std::sin(p1) - std::sin(p0));
  return std::max(0.0, over_polar) * (azimuth_[column + 1] - azimuth_[column]);
}

double IntensityDistribution::cell_maximum(std::size_t column, std::size_t row) const {
  return std::max(
      {at(column, row), at(column, row + 1), at(column + 1, row), at(column + 1, row + 1)});
}

IntensityDistribution::Sample IntensityDistribution::in_cell(std::size_t column, std::size_t row,
                                                             double u, double v) const {
  const double azimuth = std::lerp(azimuth_[column], azimuth_[column + 1], u);
  const double cosine = std::lerp(std::cos(polar_[row]), std::cos(polar_[row + 1]), v);
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const double polar = std::clamp(std::acos(cosine), polar_[row], polar_[row + 1]);
  return {cosine * axes_.pole +
              sine * (std::cos(azimuth) * axes_.zero + std::sin(azimuth) * axes_.quarter),
          interpolated(column, row, azimuth, polar)};
}

}  // namespace photile
