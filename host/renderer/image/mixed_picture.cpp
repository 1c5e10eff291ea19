// Rendered layers at the powers of a mix.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "image/channel_rows.hpp"
#include "image/layer_set.hpp"
#include "image/light_change.hpp"
#include "photile/layered_picture.hpp"

namespace photile {
namespace {

/// What a layer's illuminance is multiplied with. The tint is not in it: it leaves the luminance
/// that the light emits as it was.
float illuminance_scale(const MixedLight& light, double lumen_per_watt) {
  return static_cast<float>(light.power * (light.unit == PowerUnit::lumen ? 1.0 : lumen_per_watt));
}

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
      scales_.emplace_back(light.power * glm::dvec3(light.tint));
      illuminance_scales_.push_back(illuminance_scale(light, mix.lumen_per_watt));
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
    const auto wanted = static_cast<std::uint16_t>(light);
    for (std::size_t x = 0; x + 1 < row.first.size(); ++x) {
      const auto begin = row.light.begin() + row.first[x],
                 end = row.light.begin() + row.first[x + 1];
      const auto found = std::lower_bound(begin, end, wanted);
      if (found == end || *found != wanted) continue;
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
