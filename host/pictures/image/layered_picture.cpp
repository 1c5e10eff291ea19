#include "photile/layered_picture.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "image/layer_set.hpp"
#include "image/light_change.hpp"
#include "image/picture_file.hpp"

namespace photile {

namespace {

constexpr float largest = std::numeric_limits<float>::max();
constexpr int rows_per_read = 64;

float finite(float value) {
  return std::isnan(value) ? 0.0f : std::clamp(value, -largest, largest);
}

}  // namespace

std::vector<std::string> LayeredPicture::channel_names(std::size_t light) const {
  const Layer& layer = layers_[light];
  std::vector<std::string> names;
  for (const char* component : {".R", ".G", ".B"}) {
    names.push_back("Combined_" + layer.light + component);
  }
  if (layer.illuminance) names.push_back("Illuminance_" + layer.light + ".Y");
  return names;
}

LightRows LayeredPicture::read(std::size_t light, int first, int end) const {
  LightRows rows = read_any(light, first, end);
  std::vector<bool> lost;  // pixels; empty as long as there are none
  for (std::vector<float>* plane : {&rows.rgb[0], &rows.rgb[1], &rows.rgb[2], &rows.illuminance}) {
    for (std::size_t pixel = 0; pixel < plane->size(); ++pixel) {
      float& value = (*plane)[pixel];
      if (std::isfinite(value)) continue;
      value = finite(value);
      lost.resize(plane->size());
      lost[pixel] = true;
    }
  }
  if (lost.empty()) return rows;
  overflows_[light].add(first, end,
                        static_cast<std::size_t>(std::count(lost.begin(), lost.end(), true)));
  return rows;
}

void LayeredPicture::Overflow::add(int first, int end, std::size_t lost) {
  if (first < counted) return;  // read once more, for another file
  counted = end;
  pixels += lost;
}

Image LayeredPicture::root(int first, int end) const {
  Image image = sum_any(first, end);
  for (float& alpha : image.channels[3]) alpha = finite(alpha);
  std::vector<std::size_t> lost;
  for (std::size_t pixel = 0; pixel < image.pixels(); ++pixel) {
    if (!std::isfinite(image.channels[0][pixel]) || !std::isfinite(image.channels[1][pixel]) ||
        !std::isfinite(image.channels[2][pixel])) {
      lost.push_back(pixel);
    }
  }
  if (lost.empty()) return image;
  lost_sums_.add(first, end, lost.size());
  for (const std::size_t pixel : lost) {
    for (std::size_t i = 0; i < 3; ++i) image.channels[i][pixel] = 0.0f;
  }
  const auto width = static_cast<std::size_t>(image.width);
  for (std::size_t light = 0; light < lights(); ++light) {
    auto pixel = lost.begin();
    for (int row = 0; row < image.height; row += rows_per_read) {
      const int row_end = std::min(row + rows_per_read, image.height);
      const LightRows rows = read(light, first + row, first + row_end);
      const std::size_t begin = static_cast<std::size_t>(row) * width;
      for (; pixel != lost.end() && *pixel < static_cast<std::size_t>(row_end) * width; ++pixel) {
        for (std::size_t i = 0; i < 3; ++i) {
          float& sum = image.channels[i][*pixel];
          sum = finite(sum + rows.rgb[i][*pixel - begin]);
        }
      }
    }
  }
  return image;
}

std::vector<std::string> LayeredPicture::overflows() const {
  std::vector<std::string> lines;
  const auto add = [&](const std::string& what, std::uint64_t pixels) {
    lines.push_back(
        fmt::format("{}: {} of {} pixels exceed {:.2g} or are not numbers; they are written as "
                    "that limit, or as 0; reduce the power",
                    what, pixels, header_.pixels(), largest));
  };
  for (const auto& [light, overflow] : overflows_) {
    add(fmt::format("light '{}'", layers_[light].light), overflow.pixels);
  }
  if (lines.empty() && lost_sums_.pixels > 0) add("the sum of the lights", lost_sums_.pixels);
  return lines;
}

Image to_image(const LayeredPicture& picture) {
  Image image = picture.root();
  for (std::size_t light = 0; light < picture.lights(); ++light) {
    LightRows rows = picture.read(light, 0, image.height);
    std::vector<std::vector<float>> planes;
    for (std::vector<float>& plane : rows.rgb) planes.push_back(std::move(plane));
    planes.push_back(std::move(rows.illuminance));
    const std::vector<std::string> names = picture.channel_names(light);
    for (std::size_t i = 0; i < names.size(); ++i) image.add(names[i]) = std::move(planes[i]);
  }
  return image;
}

// Rendered layers at the powers of a mix.

namespace {

class MixedPicture : public LayeredPicture {
 public:
  MixedPicture(const LightLayers& layers, const LightMix& mix) : source_(layers) {
    header_.width = layers.width;
    header_.height = layers.height;
    image::LightRecords records;
    records.mix.lumen_per_watt = mix.lumen_per_watt;
    for (const LightLayers::Layer& layer : layers.layers) {
      const MixedLight& light = mix.lights[image::index_of(mix, layer.light)];
      layers_.push_back({layer.light, true});
      scales_.emplace_back(mix.power_in_picture(light) * glm::dvec3(light.tint));
      // Without the tint, which leaves the luminance that the light emits as it was.
      illuminance_scales_.push_back(static_cast<float>(mix.lumens_of(light)));
      records.mix.lights.push_back(light);
    }
    image::write_light_records(header_, records);
  }

  LightRows read_any(std::size_t light, int first, int end) const override {
    const auto width = static_cast<std::size_t>(header_.width);
    const std::size_t pixels = static_cast<std::size_t>(end - first) * width;
    LightRows rows;
    for (std::vector<float>& plane : rows.rgb) plane.resize(pixels);
    rows.illuminance.resize(pixels);
    tbb::parallel_for(tbb::blocked_range<int>(first, end), [&](const auto& range) {
      for (int y = range.begin(); y < range.end(); ++y) {
        const std::size_t offset = static_cast<std::size_t>(y - first) * width;
        source_.sparse() ? read_sparse_row(light, y, offset, rows)
                         : read_dense_row(light, y, offset, rows);
      }
    });
    return rows;
  }

  Image sum_any(int first, int end) const override {
    Image image;
    static_cast<PictureHeader&>(image) = header_;
    image.height = end - first;
    std::vector<glm::vec3> sums(image.pixels());
    image::combine_rows(source_, scales_, first, sums);
    for (int component = 0; component < 3; ++component) {
      std::vector<float>& plane = image.add(std::string(1, "RGB"[component]));
      for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = sums[i][component];
    }
    image.add("A").assign(image.pixels(), 1.0f);
    return image;
  }

 private:
  /// Off means black, whatever the layer holds.
  void set(LightRows& rows, std::size_t pixel, std::size_t light, const glm::vec3& radiance,
           float illuminance) const {
    const glm::vec3& scale = scales_[light];
    for (int i = 0; i < 3; ++i) {
      rows.rgb[static_cast<std::size_t>(i)][pixel] =
          scale[i] == 0.0f ? 0.0f : radiance[i] * scale[i];
    }
    rows.illuminance[pixel] = illuminance * illuminance_scales_[light];
  }

  void read_dense_row(std::size_t light, int y, std::size_t offset, LightRows& rows) const {
    const auto width = static_cast<std::size_t>(header_.width);
    const LightLayers::Layer& layer = source_.layers[light];
    const std::size_t first = static_cast<std::size_t>(y) * width;
    for (std::size_t x = 0; x < width; ++x) {
      set(rows, offset + x, light, layer.radiance[first + x], layer.illuminance[first + x]);
    }
  }

  void read_sparse_row(std::size_t light, int y, std::size_t offset, LightRows& rows) const {
    const LightLayers::Row& row = source_.rows[static_cast<std::size_t>(y)];
    const auto requested = static_cast<std::uint16_t>(light);
    for (std::size_t x = 0; x + 1 < row.first.size(); ++x) {
      const auto begin = row.light.begin() + row.first[x],
                 end = row.light.begin() + row.first[x + 1];
      const auto found = std::lower_bound(begin, end, requested);
      if (found == end || *found != requested) continue;
      const auto i = static_cast<std::size_t>(found - row.light.begin());
      set(rows, offset + x, light, row.radiance[i], row.illuminance[i]);
    }
  }

  const LightLayers& source_;
  std::vector<glm::vec3> scales_;          ///< of radiance, per layer
  std::vector<float> illuminance_scales_;  ///< per layer
};

}  // namespace

std::unique_ptr<LayeredPicture> mixed_picture(const LightLayers& layers, const LightMix& mix) {
  return std::make_unique<MixedPicture>(layers, mix);
}

Image mix_layers(const LightLayers& layers, const LightMix& mix) {
  return to_image(MixedPicture(layers, mix));
}

}  // namespace photile
