#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "photile/errors.hpp"
#include "photile/image.hpp"
#include "photile/scene.hpp"

namespace photile {
namespace {

constexpr double light_level = 20;       ///< medians
constexpr double floor_fraction = 0.01;  ///< of the squared mean, below the squared error
constexpr int tiles_per_height = 16;
constexpr double dark_tile = 0.1;  ///< of the mean
constexpr double middle_grey = 0.18;

using Planes = std::array<const std::vector<float>*, 3>;

Planes planes_of(const Image& image) {
  const Planes planes{image.find("R"), image.find("G"), image.find("B")};
  for (const auto* plane : planes) {
    if (!plane) throw UsageError("a picture without channels R, G and B cannot be compared");
  }
  return planes;
}

void check_sizes(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height) {
    throw UsageError("pictures of " + std::to_string(a.width) + "x" + std::to_string(a.height) +
                     " and " + std::to_string(b.width) + "x" + std::to_string(b.height) +
                     " pixels cannot be compared; render the size of the reference");
  }
}

double luminance_of(const Planes& planes, std::size_t pixel) {
  return luminance(glm::dvec3((*planes[0])[pixel], (*planes[1])[pixel], (*planes[2])[pixel]));
}

/// The pixels of a mask and the eight around each.
std::vector<bool> grown(const std::vector<bool>& mask, int width, int height) {
  std::vector<bool> result(mask.size());
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!mask[index(x, y)]) continue;
      for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v) {
        for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) {
          result[index(u, v)] = true;
        }
      }
    }
  }
  return result;
}

struct Tile {
  double picture = 0, reference = 0;
  std::size_t counted = 0, pixels = 0;
};

/// Fills in the worst tile and its position.
void find_worst_region(const Image& picture, const Image& reference,
                       const RelativeErrorWeights& weights, PictureError& error) {
  const int side = std::max(1, reference.height / tiles_per_height);
  const int columns = (reference.width + side - 1) / side;
  const int rows = (reference.height + side - 1) / side;
  std::vector<Tile> tiles(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const Planes a = planes_of(picture), b = planes_of(reference);
  for (int y = 0; y < reference.height; ++y) {
    for (int x = 0; x < reference.width; ++x) {
      const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(reference.width) +
                         static_cast<std::size_t>(x);
      Tile& tile = tiles[static_cast<std::size_t>((y / side) * columns + x / side)];
      ++tile.pixels;
      if (!weights.counts(pixel)) continue;
      ++tile.counted;
      for (std::size_t channel = 0; channel < 3; ++channel) {
        tile.picture += (*a[channel])[pixel];
        tile.reference += (*b[channel])[pixel];
      }
    }
  }
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const Tile& tile = tiles[i];
    const double mean = tile.reference / (3.0 * static_cast<double>(tile.counted));
    if (2 * tile.counted < tile.pixels || mean < dark_tile * weights.mean()) continue;
    const double deviation = std::abs(tile.picture / tile.reference - 1);
    if (!(deviation > error.worst_region)) continue;
    const int x = side * (static_cast<int>(i) % columns),
              y = side * (static_cast<int>(i) / columns);
    error.worst_region = deviation;
    error.worst_area = {x, y, std::min(side, reference.width - x),
                        std::min(side, reference.height - y)};
  }
}

/// The error of what a screen, whose white is 1, shows of the pixels that count; black elsewhere.
double psnr(const Image& picture, const Image& reference, const RelativeErrorWeights& weights) {
  const Planes a = planes_of(picture), b = planes_of(reference);
  const double factor = middle_grey / weights.mean();
  const auto displayed = [&](double value) { return std::clamp(factor * value, 0.0, 1.0); };
  double sum = 0;
  for (std::size_t pixel = 0; pixel < picture.pixels(); ++pixel) {
    if (!weights.counts(pixel)) continue;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double difference = displayed((*a[channel])[pixel]) - displayed((*b[channel])[pixel]);
      sum += difference * difference;
    }
  }
  const double mean_square = sum / (3.0 * static_cast<double>(picture.pixels()));
  return mean_square > 0 ? -10.0 * std::log10(mean_square)
                         : std::numeric_limits<double>::infinity();
}

}  // namespace

RelativeErrorWeights::RelativeErrorWeights(const Image& reference) {
  const Planes planes = planes_of(reference);
  std::vector<double> luminances(reference.pixels());
  for (std::size_t pixel = 0; pixel < luminances.size(); ++pixel) {
    luminances[pixel] = luminance_of(planes, pixel);
  }
  std::vector<double> sorted = luminances;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  if (middle != sorted.end()) std::nth_element(sorted.begin(), middle, sorted.end());
  const double least = middle != sorted.end() ? light_level * *middle : 0.0;

  std::vector<bool> lights(luminances.size());
  for (std::size_t pixel = 0; pixel < lights.size(); ++pixel) {
    lights[pixel] = !(luminances[pixel] <= least);
  }
  counts_ = grown(lights, reference.width, reference.height);
  counts_.flip();
  double sum = 0;
  for (std::size_t pixel = 0; pixel < luminances.size(); ++pixel) {
    if (!counts_[pixel]) continue;
    ++counted_;
    for (const auto* plane : planes) sum += (*plane)[pixel];
  }
  mean_ = sum / (3.0 * static_cast<double>(counted_));
  if (!(mean_ > 0)) {
    throw InputError("the reference is black except for visible lights; give a brighter one");
  }
  divisor_.resize(3 * luminances.size());
  for (std::size_t pixel = 0; pixel < luminances.size(); ++pixel) {
    if (!counts_[pixel]) continue;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double value = (*planes[channel])[pixel];
      divisor_[3 * pixel + channel] = value * value + floor_fraction * mean_ * mean_;
    }
  }
}

double RelativeErrorWeights::relative_mse(const Image& picture, const Image& reference) const {
  const Planes a = planes_of(picture), b = planes_of(reference);
  double sum = 0;
  for (std::size_t pixel = 0; pixel < counts_.size(); ++pixel) {
    if (!counts_[pixel]) continue;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double difference = double{(*a[channel])[pixel]} - double{(*b[channel])[pixel]};
      sum += difference * difference / divisor_[3 * pixel + channel];
    }
  }
  return sum / (3.0 * static_cast<double>(counted_));
}

double PictureError::relative_error() const { return std::sqrt(relative_mse); }

PictureError picture_error(const Image& picture, const Image& reference) {
  check_sizes(picture, reference);
  const RelativeErrorWeights weights(reference);
  const Planes a = planes_of(picture);
  double sum = 0;
  for (std::size_t pixel = 0; pixel < picture.pixels(); ++pixel) {
    if (!weights.counts(pixel)) continue;
    for (const auto* plane : a) sum += (*plane)[pixel];
  }
  PictureError error;
  error.relative_mse = weights.relative_mse(picture, reference);
  error.mean_ratio = sum / (3.0 * static_cast<double>(weights.counted())) / weights.mean();
  find_worst_region(picture, reference, weights, error);
  error.psnr = psnr(picture, reference, weights);
  return error;
}

}  // namespace photile
