#include "render/lobe_filter.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <numeric>
#include <vector>

#include "photile/defaults.hpp"
#include "render/film.hpp"

namespace photile {
namespace {

/// What a half of a pixel's samples finds, as that of a whole pixel, and its variance.
struct HalfPixel {
  glm::vec3 found, variance;
};

float sum(const glm::vec3& value) { return value.x + value.y + value.z; }

class LobeFilter {
 public:
  LobeFilter(const LightLayers& picture, const LobeFilm& film, std::span<const double> powers,
             std::span<const int> samples)
      : width_(picture.width), height_(picture.height), lobes_(film.lobes) {
    for (PixelLobes& lobe : lobes_) {
      if (!(lobe.weight > 0)) continue;
      lobe.position /= lobe.weight;
      lobe.normal /= lobe.weight;
      lobe.reflectance /= lobe.weight;
      lobe.roughness /= lobe.weight;
    }
    std::array<float, LobeFilm::runs> scale{};
    const int all = std::accumulate(samples.begin(), samples.end(), 0);
    for (std::size_t run = 0; run < scale.size(); ++run) {
      scale[run] = static_cast<float>(all) / static_cast<float>(samples[run]);
    }
    brightness_ = mixed(picture, powers);
    const std::vector<glm::vec3>& runs = film.mixed.layers.front().radiance;
    halves_.resize(lobes_.size());
    for (std::size_t pixel = 0; pixel < lobes_.size(); ++pixel) {
      for (std::size_t half = 0; half < 2; ++half) {
        const std::size_t first = LobeFilm::runs * pixel + 2 * half;
        const glm::vec3 one = scale[2 * half] * runs[first],
                        other = scale[2 * half + 1] * runs[first + 1];
        halves_[pixel][half] = {0.5f * (one + other), 0.25f * (one - other) * (one - other)};
        brightness_[pixel] += runs[first] + runs[first + 1];
      }
    }
    // One pixel tells little of its variance, those around it on surfaces that are alike more.
    const std::vector<std::array<HalfPixel, 2>> alone = halves_;
    tbb::parallel_for(0, height_, [&](int y) {
      for (int x = 0; x < width_; ++x) set_variance(alone, x, y);
    });
  }

  /// What the halves of pixels count in the pixels of a row.
  RowWeights weights(int y) const {
    RowWeights row;
    std::vector<Like> alike;
    for (int x = 0; x < width_; ++x) {
      const std::size_t pixel = index(x, y);
      glm::vec2 all(0.0f);
      alike.clear();
      if (shows_noise(pixel)) {
        for_each_around(x, y, reach_, [&](int u, int v) {
          const std::size_t other = index(u, v);
          const float surfaces = difference(pixel, other);
          if (!(surfaces < farthest)) return;
          const glm::vec2 weight{std::exp(-surfaces - difference(x, y, u, v, 1)),
                                 std::exp(-surfaces - difference(x, y, u, v, 0))};
          if (std::max(weight.x, weight.y) < least_weight) return;
          alike.push_back({static_cast<std::uint32_t>(other), weight});
          all += weight;
        });
      } else {
        alike.push_back({static_cast<std::uint32_t>(pixel), all = glm::vec2(1.0f)});
      }
      for (const Like& like : alike) {
        for (int half = 0; half < 2; ++half) {
          row.pixel.push_back(2 * like.pixel + static_cast<std::uint32_t>(half));
          row.weight.push_back(like.weight[half] / all[half]);
        }
      }
      row.first.push_back(static_cast<std::uint32_t>(row.pixel.size()));
    }
    return row;
  }

 private:
  struct Like {
    std::uint32_t pixel;
    glm::vec2 weight;  ///< of its halves
  };

  /// Pixels count next to nothing beyond.
  static constexpr float farthest = 6, least_weight = 1e-3f;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  template <class Visit>
  void for_each_around(int x, int y, int reach, const Visit& visit) const {
    for (int v = std::max(0, y - reach); v <= std::min(height_ - 1, y + reach); ++v) {
      for (int u = std::max(0, x - reach); u <= std::min(width_ - 1, x + reach); ++u) visit(u, v);
    }
  }

  void set_variance(const std::vector<std::array<HalfPixel, 2>>& alone, int x, int y) {
    const std::size_t pixel = index(x, y);
    if (!(lobes_[pixel].weight > 0)) return;
    glm::vec3 variance[2] = {glm::vec3(0.0f), glm::vec3(0.0f)};
    float weights = 0;
    for_each_around(x, y, defaults::filter_noise_reach, [&](int u, int v) {
      const std::size_t other = index(u, v);
      const float surfaces = difference(pixel, other);
      if (!(surfaces < farthest)) return;
      const float weight = std::exp(-surfaces);
      for (std::size_t half = 0; half < 2; ++half) {
        variance[half] += weight * alone[other][half].variance;
      }
      weights += weight;
    });
    for (std::size_t half = 0; half < 2; ++half) {
      halves_[pixel][half].variance = variance[half] / weights;
    }
  }

  bool shows_noise(std::size_t pixel) const {
    const auto& [first, second] = halves_[pixel];
    const float noise = std::sqrt(0.25f * sum(first.variance + second.variance));
    return noise > defaults::filter_shown_noise * sum(brightness_[pixel]);
  }

  /// Between the surfaces of two pixels, in units at which their lobes no longer show the same: of
  /// normals in relation to the width of the lobe, of distance from each other's plane, of what the
  /// lobes reflect, of their width, and of the part of the pixels that they cover.
  float difference(std::size_t pixel, std::size_t other) const {
    const PixelLobes &a = lobes_[pixel], &b = lobes_[other];
    if (pixel == other) return 0;
    if (!(a.weight > 0) || !(b.weight > 0)) return std::numeric_limits<float>::infinity();
    const float alpha = std::max(0.02f, std::min(a.roughness, b.roughness));
    const glm::vec3 turned = a.normal - b.normal, apart = a.position - b.position;
    const glm::vec3 reflects = (a.reflectance - b.reflectance) / (0.001f + sum(a.reflectance) / 3);
    const float off_plane =
        std::max(std::abs(glm::dot(apart, a.normal)), std::abs(glm::dot(apart, b.normal)));
    const float wider = (a.roughness - b.roughness) / alpha;
    const float covers = a.weight - b.weight;
    return 20 * glm::dot(turned, turned) / std::min(1.0f, 4 * alpha) +
           30 * off_plane / (0.05f + glm::length(apart)) + 20 * glm::dot(reflects, reflects) +
           4 * wider * wider + 8 * covers * covers;
  }

  /// Between what half `half` finds in and around two pixels, in squares of their noise and beyond
  /// it (Rousselle and others, equation 3).
  float difference(int x, int y, int u, int v, std::size_t half) const {
    constexpr int patch = defaults::filter_patch;
    constexpr float tolerance = defaults::filter_tolerance * defaults::filter_tolerance;
    float squares = 0, count = 0;
    for (int j = std::max({-patch, -y, -v});
         j <= std::min({patch, height_ - 1 - y, height_ - 1 - v}); ++j) {
      for (int i = std::max({-patch, -x, -u});
           i <= std::min({patch, width_ - 1 - x, width_ - 1 - u}); ++i) {
        const std::size_t here = index(x + i, y + j), there = index(u + i, v + j);
        const HalfPixel &a = halves_[here][half], &b = halves_[there][half];
        const glm::vec3 apart = a.found - b.found;
        const float least = defaults::filter_least_noise * sum(brightness_[here]);
        squares += sum((apart * apart - a.variance - glm::min(a.variance, b.variance)) /
                       (least * least + tolerance * (a.variance + b.variance) + smallest));
        count += 3;
      }
    }
    return std::max(0.0f, squares / count);
  }

  static constexpr float smallest = std::numeric_limits<float>::min();  ///< where all is black

  int width_, height_;
  int reach_ = std::clamp(height_ / defaults::filter_rows, 1, defaults::filter_most_reach);
  std::vector<PixelLobes> lobes_;      ///< means of those that rays follow
  std::vector<glm::vec3> brightness_;  ///< of all that the pixel shows
  std::vector<std::array<HalfPixel, 2>> halves_;
};

}  // namespace

void add_filtered(LightLayers& picture, const LobeFilm& film, std::span<const double> powers,
                  std::span<const int> samples) {
  const LobeFilter filter(picture, film, powers, samples);
  tbb::parallel_for(0, picture.height,
                    [&](int y) { add_weighted(picture, y, film.halves, filter.weights(y)); });
}

}  // namespace photile
