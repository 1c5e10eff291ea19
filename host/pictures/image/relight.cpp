#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/files.hpp"
#include "image/layer_set.hpp"
#include "image/light_change.hpp"
#include "image/picture_file.hpp"
#include "image/white.hpp"
#include "photile/errors.hpp"
#include "photile/layered_picture.hpp"
#include "photile/limits.hpp"

namespace photile {
namespace {

/// new / old, where the old value is what the picture was multiplied with.
/// Errors: UsageError when nothing is left to multiply.
double ratio(double now, double before, const std::string& light) {
  if (now == before) return 1.0;  // keeps the bits, and 0 of 0
  if (before == 0.0) {
    throw UsageError(
        fmt::format("light '{}' is off in the picture, or black in a channel, and cannot be turned "
                    "up; render it with power above 0",
                    light));
  }
  return now / before;
}

void apply_to_picture(image::LightRecords& records, const std::vector<LightChange>& changes) {
  for (const LightChange& change : changes) {
    const image::Request request = image::understand(change);
    for (const std::size_t index : image::indices_of(records.mix, change.name)) {
      MixedLight& light = records.mix.lights[index];
      if (std::holds_alternative<image::SetPower>(request) &&
          records.relative.contains(light.name)) {
        throw UsageError(fmt::format(
            "light '{}': the picture does not state its power; use xFACTOR, #RRGGBB or off",
            light.name));
      }
      image::apply(light, request, records.mix.lumen_per_watt);
    }
  }
}

void scale(std::vector<float>& values, float factor) {
  if (factor == 1.0f) return;
  for (float& value : values) {
    value = factor == 0.0f ? 0.0f : value * factor;  // off, whatever the layer holds
  }
}

/// The factors on a layer's channels.
struct Factors {
  std::array<float, 3> rgb{1, 1, 1};
  float illuminance = 1.0f;
};

Factors factors_of(const MixedLight& before, const MixedLight& now, bool illuminance) {
  Factors factors;
  for (int i = 0; i < 3; ++i) {
    factors.rgb[static_cast<std::size_t>(i)] =
        static_cast<float>(ratio(now.power * now.tint[i], before.power * before.tint[i], now.name));
  }
  if (illuminance) {
    factors.illuminance = static_cast<float>(ratio(now.power, before.power, now.name));
  }
  return factors;
}

class RelitPicture final : public LayeredPicture {
 public:
  RelitPicture(std::unique_ptr<image::ChannelRows> source, const std::vector<LightChange>& changes)
      : source_(std::move(source)), before_(image::find_layers(source_->header())) {
    image::LightRecords now = before_.records;
    apply_to_picture(now, changes);
    std::vector<Factors> factors;
    for (std::size_t i = 0; i < now.mix.lights.size(); ++i) {
      const bool illuminance = before_.channels[i].illuminance.has_value();
      layers_.push_back({now.mix.lights[i].name, illuminance});
      factors.push_back(factors_of(before_.records.mix.lights[i], now.mix.lights[i], illuminance));
    }
    header_ = source_->header();
    header_.channel_names.clear();
    if (!image::kept_white(header_) && !changes.empty()) keep_white_before();
    factors_ = std::move(factors);
    image::write_light_records(header_, now);
  }

  LightRows read_any(std::size_t light, int first, int end) const override {
    LightRows rows = read_rgb(light, first, end);
    if (const auto channel = before_.channels[light].illuminance) {
      rows.illuminance = source_->read(*channel, first, end);
      scale(rows.illuminance, factors_[light].illuminance);
    }
    return rows;
  }

  Image sum_any(int first, int end) const override {
    Image image;
    static_cast<PictureHeader&>(image) = header_;
    image.height = end - first;
    for (const char* component : {"R", "G", "B"}) image.add(component);
    std::vector<float>& alpha = image.add("A");
    // All lights of some rows: those of one part are decoded together.
    for (int row = first; row < end; row += rows_per_read) {
      const int row_end = std::min(row + rows_per_read, end);
      for (std::size_t light = 0; light < lights(); ++light) {
        add_rows(read_rgb(light, row, row_end), row - first, image);
      }
      const std::vector<float> rows = read_alpha(row, row_end);
      std::copy(rows.begin(), rows.end(),
                alpha.begin() + std::ptrdiff_t{row - first} * image.width);
    }
    return image;
  }

 private:
  /// That of the lights as the file has them, since no change of a light is to move it.
  void keep_white_before() {
    factors_.assign(before_.records.mix.lights.size(), Factors{});
    image::write_light_records(header_, before_.records);
    image::keep_white(header_, image::white_of(*this));
  }

  /// Rows that are held at a time.
  static constexpr int rows_per_read = 64;

  LightRows read_rgb(std::size_t light, int first, int end) const {
    LightRows rows;
    for (std::size_t i = 0; i < 3; ++i) {
      rows.rgb[i] = source_->read(before_.channels[light].rgb[i], first, end);
      scale(rows.rgb[i], factors_[light].rgb[i]);
    }
    return rows;
  }

  static void add_rows(const LightRows& rows, int first, Image& image) {
    const std::size_t offset =
        static_cast<std::size_t>(first) * static_cast<std::size_t>(image.width);
    for (std::size_t i = 0; i < 3; ++i) {
      float* const sums = &image.channels[i][offset];
      for (std::size_t p = 0; p < rows.rgb[i].size(); ++p) sums[p] += rows.rgb[i][p];
    }
  }

  std::vector<float> read_alpha(int first, int end) const {
    const auto& names = source_->header().channel_names;
    const auto found = std::find(names.begin(), names.end(), "A");
    const auto rows = static_cast<std::size_t>(end - first);
    if (found == names.end()) {
      return std::vector<float>(rows * static_cast<std::size_t>(header_.width), 1.0f);
    }
    return source_->read(static_cast<std::size_t>(found - names.begin()), first, end);
  }

  const std::unique_ptr<image::ChannelRows> source_;
  const image::LayerSet before_;
  std::vector<Factors> factors_;  ///< per light
};

}  // namespace

Image relight(const Image& layered, const std::vector<LightChange>& changes) {
  const std::shared_ptr<const Image> borrowed(std::shared_ptr<const Image>(), &layered);
  return to_image(RelitPicture(std::make_unique<image::ImageRows>(borrowed), changes));
}

std::unique_ptr<LayeredPicture> relit_picture(const std::filesystem::path& file,
                                              const std::vector<LightChange>& changes) {
  auto source = std::make_unique<image::PictureFile>(file);
  // To read one light's rows is to decode those of its whole part.
  constexpr std::size_t few = 4 + 4 * limits::max_single_part_lights;
  constexpr std::uint64_t little = 256ull << 20;  // bytes
  const std::size_t channels = source->header().channel_names.size();
  const bool much = channels > few || source->header().pixels() * channels > little / sizeof(float);
  if (much && source->channels_of_largest_part() <= few) {
    return about_file(file,
                      [&] { return std::make_unique<RelitPicture>(std::move(source), changes); });
  }
  auto image = std::make_shared<const Image>(read_image(file));
  return about_file(file, [&] {
    return std::make_unique<RelitPicture>(std::make_unique<image::ImageRows>(std::move(image)),
                                          changes);
  });
}

LightLayers light_layers(const Image& layered) {
  const image::LayerSet set = image::find_layers(layered);
  std::vector<std::string> names;
  for (const MixedLight& light : set.records.mix.lights) names.push_back(light.name);
  LightLayers layers = LightLayers(layered.width, layered.height, names).dense();
  for (std::size_t l = 0; l < names.size(); ++l) {
    const MixedLight& light = set.records.mix.lights[l];
    const image::LayerChannels& channels = set.channels[l];
    for (int c = 0; c < 3; ++c) {
      const double power = set.records.mix.power_in_picture(light) * light.tint[c];
      if (power == 0) continue;
      const auto& plane = layered.channels[channels.rgb[static_cast<std::size_t>(c)]];
      for (std::size_t p = 0; p < plane.size(); ++p) {
        layers.layers[l].radiance[p][c] = static_cast<float>(plane[p] / power);
      }
    }
    if (!channels.illuminance || light.power == 0) continue;
    const auto& plane = layered.channels[*channels.illuminance];
    const double lumens = set.records.mix.lumens_of(light);
    for (std::size_t p = 0; p < plane.size(); ++p) {
      layers.layers[l].illuminance[p] = static_cast<float>(plane[p] / lumens);
    }
  }
  return layers;
}

LightMix relit_mix(const PictureHeader& layered, const std::vector<LightChange>& changes) {
  const image::LayerSet before = image::find_layers(layered);
  image::LightRecords now = before.records;
  apply_to_picture(now, changes);
  for (std::size_t i = 0; i < now.mix.lights.size(); ++i) {
    factors_of(before.records.mix.lights[i], now.mix.lights[i], false);  // refuses
  }
  return std::move(now.mix);
}

LightMix read_light_mix(const std::filesystem::path& file) {
  const PictureHeader header = read_header(file);
  return about_file(file, [&] { return read_light_mix(header); });
}

LightMix read_light_mix(const PictureHeader& layered) {
  return image::find_layers(layered).records.mix;
}

}  // namespace photile
