#include "report/picture_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "image/layer_set.hpp"
#include "photile/errors.hpp"
#include "photile/scene.hpp"
#include "report/false_colour.hpp"
#include "report/palette.hpp"
#include "report/sheet.hpp"
#include "report/tables.hpp"

namespace photile::report {

namespace {

/// The layers of a picture by light; none where it has none.
image::LayerSet layers_of(const Image& image) {
  try {
    return image::find_layers(image);
  } catch (const InputError&) {
    return {};
  }
}

std::optional<std::size_t> index_in(const image::LayerSet& layers, const std::string& light) {
  const auto& lights = layers.records.mix.lights;
  const auto found = std::find_if(lights.begin(), lights.end(),
                                  [&](const MixedLight& each) { return each.name == light; });
  if (found == lights.end()) return std::nullopt;
  return static_cast<std::size_t>(found - lights.begin());
}

/// A layer as a picture of its own.
Image layer_picture(const Image& image, const image::LayerChannels& channels) {
  constexpr std::array names{"R", "G", "B"};
  Image layer;
  layer.width = image.width;
  layer.height = image.height;
  for (std::size_t i = 0; i < names.size(); ++i) {
    layer.add(names[i]) = image.channels[channels.rgb[i]];
  }
  return layer;
}

constexpr double high_percentile = 0.95;

template <class Number>
double quantile(std::vector<Number>& values, double share) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return static_cast<double>(*place);
}

void add_levels(const std::string& what, const std::string& unit, std::vector<float> a,
                std::vector<float> b, LevelComparison& result) {
  const auto mean = [](const std::vector<float>& values) {
    double sum = 0;
    for (const float value : values) sum += static_cast<double>(value);
    return sum / static_cast<double>(std::max<std::size_t>(1, values.size()));
  };
  if (a.empty() || b.empty()) return;
  result.levels.push_back({what + ", mean", unit, mean(a), mean(b)});
  result.levels.push_back({what + ", median", unit, quantile(a, 0.5), quantile(b, 0.5)});
  result.levels.push_back(
      {what + ", 95% below", unit, quantile(a, high_percentile), quantile(b, high_percentile)});
}

/// Illuminance of the pixels that see a surface in either picture; empty where it is not known.
std::vector<float> surface_illuminance(const LayeredPicture& picture) {
  try {
    return illuminance_of(picture);
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace

LevelComparison compare_levels(const LayeredPicture& a, const LayeredPicture& b,
                               const PictureHeader& header_a, const PictureHeader& header_b) {
  if (a.header().width != b.header().width || a.header().height != b.header().height) {
    throw UsageError("the pictures differ in size; render them with the same --size");
  }
  LevelComparison result;
  add_levels("luminance", "cd/m2", luminance_of(a.root()), luminance_of(b.root()), result);
  add_levels("illuminance", "lux", surface_illuminance(a), surface_illuminance(b), result);
  const LightMix of_a = read_light_mix(header_a), of_b = read_light_mix(header_b);
  for (const MixedLight& light : of_a.lights) {
    const auto other = std::find_if(of_b.lights.begin(), of_b.lights.end(),
                                    [&](const auto& each) { return each.name == light.name; });
    if (other == of_b.lights.end()) continue;
    const double power = in_unit(other->power, other->unit, light.unit, of_b.lumen_per_watt);
    result.powers.push_back({light.name, light.power, power, light.unit});
  }
  return result;
}

bool lights_differ(const PictureHeader& a, const PictureHeader& b) {
  try {
    const LightMix of_a = read_light_mix(a), of_b = read_light_mix(b);
    for (const MixedLight& light : of_a.lights) {
      for (const MixedLight& other : of_b.lights) {
        if (light.name != other.name) continue;
        const double power = in_unit(other.power, other.unit, light.unit, of_b.lumen_per_watt);
        if (std::abs(light.power - power) > 1e-6 * std::max(light.power, power)) return true;
        if (glm::length(light.tint - other.tint) > 1e-4f) return true;
      }
    }
  } catch (const InputError&) {  // no lights
  }
  return false;
}

PictureComparison compare_pictures(const Image& a, const Image& b) {
  PictureComparison result;
  result.parts.push_back({"", picture_error(a, b)});
  const image::LayerSet of_a = layers_of(a), of_b = layers_of(b);
  for (std::size_t i = 0; i < of_a.channels.size(); ++i) {
    const std::string& light = of_a.records.mix.lights[i].name;
    const auto other = index_in(of_b, light);
    if (!other) {
      result.only_a.push_back(light);
      continue;
    }
    ComparedPart part{light, std::nullopt};
    try {
      part.error = picture_error(layer_picture(a, of_a.channels[i]),
                                 layer_picture(b, of_b.channels[*other]));
    } catch (const InputError&) {  // b is black: off, say
    }
    result.parts.push_back(std::move(part));
  }
  for (const MixedLight& light : of_b.records.mix.lights) {
    if (!index_in(of_a, light.name)) result.only_b.push_back(light.name);
  }
  return result;
}

namespace {

// Sizes in pixels.
constexpr int legend_width = 90;
constexpr int legend_numbers = 5;
constexpr double percentile = 0.99;

const std::vector<float>& plane_of(const Image& image, const char* name) {
  const auto* plane = image.find(name);
  if (!plane) throw UsageError("a picture without channels R, G and B cannot be compared");
  return *plane;
}

double luminance_at(const Image& image, std::size_t pixel) {
  return luminance(
      {plane_of(image, "R")[pixel], plane_of(image, "G")[pixel], plane_of(image, "B")[pixel]});
}

/// The 99th percentile of the pixels that see no light in `b`: a light that moved would leave
/// nothing else to see.
double automatic_scale(const std::vector<double>& all, const Image& b) {
  const RelativeErrorWeights weights(b);
  std::vector<double> differences;
  for (std::size_t pixel = 0; pixel < all.size(); ++pixel) {
    if (weights.counts(pixel) && std::isfinite(all[pixel])) {
      differences.push_back(std::abs(all[pixel]));
    }
  }
  if (differences.empty()) return 1;
  const double most = quantile(differences, percentile);
  return most > 0 ? rounded_up(most, {1.0, 2.0, 5.0}) : 1;
}

void draw_legend(Sheet& sheet, int x, int height, double scale, const Palette& palette) {
  for (int y = 0; y < height; ++y) {
    const double share = 1 - (y + 0.5) / height;
    for (int u = 0; u < bar_width; ++u) sheet.set(x + u, title_height + y, palette.at(share));
  }
  for (int i = 0; i < legend_numbers; ++i) {
    const double share = static_cast<double>(i) / (legend_numbers - 1);
    const double value = (2 * share - 1) * scale;
    const int middle = title_height + static_cast<int>((1 - share) * height);
    const int y = std::clamp(middle + Sheet::font_size / 3, title_height + Sheet::font_size,
                             title_height + height);
    sheet.write(x + bar_width + 6, y, x + legend_width, fmt::format("{:+.4g}", value));
  }
}

}  // namespace

Image draw_comparison(const Image& a, const Image& b, const ComparisonDrawing& options) {
  if (a.width != b.width || a.height != b.height) {
    throw UsageError("pictures of different sizes cannot be compared");
  }
  std::vector<double> differences(a.pixels());
  for (std::size_t i = 0; i < differences.size(); ++i) {
    differences[i] = luminance_at(a, i) - luminance_at(b, i);
  }
  const double scale = options.scale > 0 ? options.scale : automatic_scale(differences, b);
  const Palette palette("blue-red");
  const std::array pictures{&a, &b};
  const ToneMapping shared = with_one_exposure(options.tone_mapping, pictures);
  const std::array displayed{tone_map(a, shared), tone_map(b, shared)};

  const int step = a.width + gap;
  Sheet sheet(3 * step + legend_width, title_height + a.height + gap);
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) +
                         static_cast<std::size_t>(x);
      for (int panel = 0; panel < 2; ++panel) {
        const auto& rgb = displayed[static_cast<std::size_t>(panel)].channels;
        sheet.set(panel * step + x, title_height + y,
                  std::array{rgb[0][pixel], rgb[1][pixel], rgb[2][pixel]});
      }
      sheet.set(2 * step + x, title_height + y, palette.at(0.5 + 0.5 * differences[pixel] / scale));
    }
  }
  constexpr int baseline = title_height - 7;
  sheet.write(2, baseline, step, options.name_a);
  sheet.write(step + 2, baseline, 2 * step, options.name_b);
  sheet.write(2 * step + 2, baseline, 3 * step + legend_width, "first - second, " + options.unit);
  draw_legend(sheet, 3 * step, a.height, scale, palette);
  return sheet.take();
}

}  // namespace photile::report
