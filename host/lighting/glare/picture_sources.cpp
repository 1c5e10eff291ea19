#include "glare/picture_sources.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <map>

#include "geometry/disjoint_sets.hpp"

namespace photile::glare {
namespace {

constexpr double half_circle = glm::half_pi<double>();  // radians from the middle to the border
constexpr double largest_factor = 100;                  // up to this a threshold is a factor

/// The offset of a pixel's middle from the picture's: 1 at the border.
glm::dvec2 place_of(int side, int x, int y) {
  return {(2.0 * x + 1.0) / side - 1.0, 1.0 - (2.0 * y + 1.0) / side};
}

/// Pixels that are accepted, joined where they are nearer than an angle.
class Groups {
 public:
  Groups(const LuminancePicture& picture, double angle,
         const std::function<bool(std::size_t)>& accepts)
      : picture_(picture), member_(picture.luminance.size()), joined_(picture.luminance.size()) {
    for (std::size_t i = 0; i < member_.size(); ++i) member_[i] = accepts(i) ? 1 : 0;
    join_neighbours();
    join_borders(angle);
  }

  /// Their pixels, by the first of each.
  std::map<std::uint32_t, std::vector<std::uint32_t>> lists() {
    std::map<std::uint32_t, std::vector<std::uint32_t>> all;
    for (std::uint32_t i = 0; i < member_.size(); ++i) {
      if (member_[i]) all[joined_.find(i)].push_back(i);
    }
    return all;
  }

 private:
  int side() const { return picture_.side; }
  std::uint32_t index(int x, int y) const {
    return static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(side()) +
           static_cast<std::uint32_t>(x);
  }
  bool holds(int x, int y) const {
    return x >= 0 && y >= 0 && x < side() && y < side() && member_[index(x, y)] != 0;
  }

  void join_neighbours() {
    for (int y = 0; y < side(); ++y) {
      for (int x = 0; x < side(); ++x) {
        if (!holds(x, y)) continue;
        if (holds(x + 1, y)) joined_.join(index(x, y), index(x + 1, y));
        if (holds(x, y + 1)) joined_.join(index(x, y), index(x, y + 1));
      }
    }
  }

  /// What is left to join lies across a gap: only pixels at one matter.
  void join_borders(double angle) {
    const double least_cosine = std::cos(angle);
    // A pixel across the middle spans pi / side; towards the border it spans less round the circle.
    const int reach = static_cast<int>(std::ceil(angle * side() / glm::pi<double>() * half_circle));
    std::vector<glm::i32vec2> borders;
    for (int y = 0; y < side(); ++y) {
      for (int x = 0; x < side(); ++x) {
        const bool inside =
            holds(x - 1, y) && holds(x + 1, y) && holds(x, y - 1) && holds(x, y + 1);
        if (holds(x, y) && !inside) borders.emplace_back(x, y);
      }
    }
    for (std::size_t a = 0; a < borders.size(); ++a) {
      const glm::dvec3 direction = picture_.direction(borders[a].x, borders[a].y);
      for (std::size_t b = a + 1; b < borders.size(); ++b) {
        if (borders[b].y - borders[a].y > reach) break;  // they are in rows
        if (std::abs(borders[b].x - borders[a].x) > reach) continue;
        const std::uint32_t first = index(borders[a].x, borders[a].y),
                            second = index(borders[b].x, borders[b].y);
        if (joined_.find(first) == joined_.find(second)) continue;
        if (glm::dot(direction, picture_.direction(borders[b].x, borders[b].y)) >= least_cosine) {
          joined_.join(first, second);
        }
      }
    }
  }

  const LuminancePicture& picture_;
  std::vector<std::uint8_t> member_;
  geometry::DisjointSets joined_;
};

struct Sums {
  double light = 0, solid_angle = 0, illuminance = 0;
  glm::dvec3 direction{0.0};  ///< weighed by light

  void add(const LuminancePicture& picture, std::uint32_t pixel) {
    const int x = static_cast<int>(pixel) % picture.side,
              y = static_cast<int>(pixel) / picture.side;
    const double part = picture.solid_angle(x, y);
    const glm::dvec3 towards = picture.direction(x, y);
    const double flux = part * static_cast<double>(picture.luminance[pixel]);
    light += flux;
    solid_angle += part;
    illuminance += flux * std::max(0.0, towards.z);
    direction += flux * towards;
  }
};

PictureSource source_of(const Sums& sums) {
  const Observer ahead{"", glm::dvec3(0.0), {0, 0, 1}, {0, 1, 0}};
  const glm::dvec3 direction = glm::normalize(sums.direction);
  return {{sums.light / sums.solid_angle, sums.solid_angle,
           std::min(position_index(ahead, direction), defaults::largest_position_index)},
          direction};
}

}  // namespace

double LuminancePicture::solid_angle(int x, int y) const {
  const double radius = glm::length(place_of(side, x, y));
  if (radius > 1) return 0;
  const double angle = half_circle * radius;
  const double scale = 2.0 * half_circle / side;
  return scale * scale * (angle > 0 ? std::sin(angle) / angle : 1.0);
}

glm::dvec3 LuminancePicture::direction(int x, int y) const {
  const glm::dvec2 place = place_of(side, x, y);
  const double radius = glm::length(place);
  if (!(radius > 0)) return {0, 0, 1};
  return {glm::dvec2(place / radius * std::sin(half_circle * radius)),
          std::cos(half_circle * radius)};
}

std::vector<Source> PictureGlare::plain_sources() const {
  std::vector<Source> plain;
  for (const PictureSource& each : sources) plain.push_back(each.source);
  return plain;
}

PictureGlare find_sources(const LuminancePicture& picture, const SourceSearch& search) {
  Sums whole;
  for (std::uint32_t i = 0; i < picture.luminance.size(); ++i) whole.add(picture, i);
  const double threshold = search.threshold > largest_factor
                               ? search.threshold
                               : search.threshold * whole.light / whole.solid_angle;
  const auto value = [&](std::size_t i) { return static_cast<double>(picture.luminance[i]); };

  PictureGlare glare;
  double of_sources = 0;
  const auto add = [&](const std::vector<std::uint32_t>& pixels) {
    Sums sums;
    for (const std::uint32_t pixel : pixels) sums.add(picture, pixel);
    if (!(sums.solid_angle > 0)) return;
    of_sources += sums.illuminance;
    glare.sources.push_back(source_of(sums));
  };
  for (auto& [first, pixels] :
       Groups(picture, search.angle, [&](std::size_t i) { return value(i) > threshold; }).lists()) {
    const auto peaks = std::stable_partition(
        pixels.begin(), pixels.end(), [&](std::uint32_t i) { return value(i) < search.peak; });
    if (peaks != pixels.end()) {
      std::vector<std::uint8_t> is_peak(picture.luminance.size(), 0);
      for (auto peak = peaks; peak != pixels.end(); ++peak) is_peak[*peak] = 1;
      for (const auto& [peak, of_peak] :
           Groups(picture, search.angle, [&](std::size_t i) { return is_peak[i] != 0; }).lists()) {
        add(of_peak);
      }
      pixels.erase(peaks, pixels.end());
    }
    add(pixels);
  }
  glare.illuminance = whole.illuminance;
  glare.background = (whole.illuminance - of_sources) / glm::pi<double>();
  return glare;
}

}  // namespace photile::glare
