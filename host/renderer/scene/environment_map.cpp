#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "photile/scene.hpp"

namespace photile {
namespace {

using std::numbers::pi;

}  // namespace

EnvironmentMap::EnvironmentMap(std::string name, int width, int height,
                               std::vector<glm::vec3> texels, double rotation)
    : name_(std::move(name)),
      width_(width),
      height_(height),
      rotation_(rotation * pi / 180.0),
      texels_(std::move(texels)) {
  if (width < 1 || height < 1 ||
      texels_.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    throw std::invalid_argument("EnvironmentMap: the number of texels is not width x height");
  }
  for (int row = 0; row < height; ++row) {
    glm::dvec3 sum(0.0);
    for (int column = 0; column < width; ++column) sum += glm::dvec3(texel(column, row));
    integral_ += solid_angle(row) * sum;
  }
  if (!std::isfinite(integral_.r + integral_.g + integral_.b)) {
    throw std::invalid_argument("EnvironmentMap: a texel is not finite");
  }
}

double EnvironmentMap::solid_angle(int row) const {
  const double top = pi * row / height_, bottom = pi * (row + 1) / height_;
  return 2.0 * pi / width_ * (std::cos(top) - std::cos(bottom));
}

std::size_t EnvironmentMap::texel_towards(const glm::vec3& direction) const {
  const double polar = std::acos(std::clamp(double{direction.y}, -1.0, 1.0));
  const double azimuth = std::atan2(double{direction.x}, -double{direction.z}) - rotation_;
  const double turn = azimuth / (2.0 * pi) + 0.5;
  const int row = std::min(static_cast<int>(polar / pi * height_), height_ - 1);
  const int column = std::min(static_cast<int>((turn - std::floor(turn)) * width_), width_ - 1);
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
         static_cast<std::size_t>(column);
}

glm::dvec3 EnvironmentMap::direction_at(double column, int row, double v) const {
  const double azimuth = 2.0 * pi * (column / width_ - 0.5) + rotation_;
  const double cosine =
      std::lerp(std::cos(pi * row / height_), std::cos(pi * (row + 1) / height_), v);
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  return {sine * std::sin(azimuth), cosine, -sine * std::cos(azimuth)};
}

}  // namespace photile
