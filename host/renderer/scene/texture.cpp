// Texture lookup.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "photile/scene.hpp"

namespace photile {

namespace {

/// Linear values of the 256 sRGB bytes (IEC 61966-2-1).
const std::array<float, 256>& linear_of_srgb() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double c = static_cast<double>(i) / 255.0;
      values[i] = static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    }
    return values;
  }();
  return table;
}

/// The two texels beside a coordinate that repeats, and the weight of the second.
struct Neighbours {
  std::size_t first, second;
  float weight;
};

/// The floor of a number that fits an int.
float floor_of(float x) {
  const auto whole = static_cast<float>(static_cast<int>(x));
  return whole > x ? whole - 1.0f : whole;
}

Neighbours neighbours(float coordinate, int size) {
  // Beyond 2^24 a float has no fraction left, and infinity and NaN have no texel.
  if (!(std::abs(coordinate) < 16'777'216.0f)) coordinate = 0.0f;
  const float repeated = coordinate - floor_of(coordinate);
  const float texel = repeated * static_cast<float>(size) - 0.5f;  // texel centres lie at 0.5
  const float floor = floor_of(texel);
  const int first = floor < 0.0f ? size - 1 : static_cast<int>(floor);
  const int second = first + 1 == size ? 0 : first + 1;
  return {static_cast<std::size_t>(first), static_cast<std::size_t>(second), texel - floor};
}

using Texel = std::array<std::uint8_t, 4>;

/// Weighs what `value` makes of the four texels around `uv`.
template <class Value>
auto bilinear(const std::vector<Texel>& texels, int width, int height, const glm::vec2& uv,
              Value value) {
  const Neighbours x = neighbours(uv.x, width), y = neighbours(uv.y, height);
  const auto at = [&](std::size_t column, std::size_t row) {
    return value(texels[row * static_cast<std::size_t>(width) + column]);
  };
  const auto upper = glm::mix(at(x.first, y.first), at(x.second, y.first), x.weight);
  const auto lower = glm::mix(at(x.first, y.second), at(x.second, y.second), x.weight);
  return glm::mix(upper, lower, y.weight);
}

}  // namespace

Texture::Texture(std::string name, int width, int height,
                 std::vector<std::array<std::uint8_t, 4>> texels)
    : name_(std::move(name)), width_(width), height_(height), texels_(std::move(texels)) {
  if (width < 1 || height < 1 ||
      texels_.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    throw std::invalid_argument("Texture: the number of texels is not width x height");
  }
}

glm::vec3 Texture::sample(glm::vec2 uv) const {
  const std::array<float, 256>& linear = linear_of_srgb();
  return bilinear(texels_, width_, height_, uv, [&](const Texel& texel) {
    return glm::vec3(linear[texel[0]], linear[texel[1]], linear[texel[2]]);
  });
}

bool Texture::opaque() const {
  return std::all_of(texels_.begin(), texels_.end(),
                     [](const Texel& texel) { return texel[3] == 255; });
}

glm::vec4 Texture::sample_data(glm::vec2 uv) const {
  return bilinear(texels_, width_, height_, uv, [](const Texel& texel) {
    return glm::vec4(texel[0], texel[1], texel[2], texel[3]) / 255.0f;
  });
}

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
