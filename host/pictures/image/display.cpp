#include "image/display.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/glm.hpp>
#include <string>

#include "common/ascii_text.hpp"
#include "image/light_layers.hpp"
#include "photile/errors.hpp"
#include "photile/scene.hpp"

namespace photile::image {

namespace {

std::uint8_t rounded_code(float linear) {
  return static_cast<std::uint8_t>(std::lround(255.0 * srgb_from_linear(linear)));
}

/// Code values by looking them up: a picture asks millions of times, and a power takes long. The
/// upper half of a float's bits leads to the code of the least value that begins with them; those
/// between it and the value, two at most, are stepped over.
class CodeTable {
 public:
  CodeTable() {
    for (std::uint32_t half = 0; half < code_at_.size(); ++half) {
      code_at_[half] = rounded_code(std::bit_cast<float>(half << 16));
    }
    for (int code = 1; code < 256; ++code) least_[code] = least_value_of(code);
  }

  /// The code of a value in (0, 1].
  std::uint8_t operator()(float linear) const {
    std::uint8_t code = code_at_[std::bit_cast<std::uint32_t>(linear) >> 16];
    while (code < 255 && linear >= least_[code + 1]) ++code;
    return code;
  }

 private:
  /// By bisection among the floats, whose order is that of their bits.
  static float least_value_of(int code) {
    std::uint32_t below = 0, found = std::bit_cast<std::uint32_t>(1.0f);
    while (found - below > 1) {
      const std::uint32_t middle = below + (found - below) / 2;
      (rounded_code(std::bit_cast<float>(middle)) >= code ? found : below) = middle;
    }
    return std::bit_cast<float>(found);
  }

  static constexpr std::uint32_t halves = (std::bit_cast<std::uint32_t>(1.0f) >> 16) + 1;
  std::array<std::uint8_t, halves> code_at_;
  std::array<float, 256> least_{};  ///< value of each code; of 0, 0
};

}  // namespace

double srgb_from_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

std::uint8_t srgb8_from_linear(float linear) {
  static const CodeTable table;
  if (!(linear > 0.0f)) return 0;  // NaN too
  return table(std::min(linear, 1.0f));
}

std::vector<std::uint8_t> srgb8_texels(const Image& display_referred) {
  std::vector<std::uint8_t> texels(3 * display_referred.pixels());
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const std::vector<float>& plane = *display_referred.find(std::string(1, "RGB"[channel]));
    for_each_pixel(plane.size(), [&](std::size_t pixel) {
      texels[3 * pixel + channel] = srgb8_from_linear(plane[pixel]);
    });
  }
  return texels;
}

}  // namespace photile::image

namespace photile {

namespace {

using image::display_transform;

struct RootPlanes {
  const std::vector<float>&r, &g, &b;
  glm::dvec3 operator[](std::size_t pixel) const { return {r[pixel], g[pixel], b[pixel]}; }
};

RootPlanes root_of(const Image& image) {
  const std::vector<float>*r = image.find("R"), *g = image.find("G"), *b = image.find("B");
  if (!r || !g || !b) {
    throw InputError("the picture has no channels R, G and B to show; relight it first");
  }
  return {*r, *g, *b};
}

void check_exposure(double stops) {
  if (!std::isfinite(stops)) throw UsageError("exposure must be a finite number of stops");
}

/// DisplayView::standard of values from 0 to `brightest`.
glm::dvec3 standard(const glm::dvec3& rgb) {
  const double largest = std::max({rgb.r, rgb.g, rgb.b});
  return largest > 1.0 ? rgb / largest : rgb;
}

/// DisplayView::neutral of values from 0 to `brightest`. Names are those of the specification.
glm::dvec3 neutral(const glm::dvec3& rgb) {
  constexpr double f90 = display_transform.f90, ks = display_transform.ks;
  const double x = std::min({rgb.r, rgb.g, rgb.b});
  const double f = x <= 2 * f90 ? x - x * x / (4 * f90) : f90;
  const glm::dvec3 base = rgb - f;
  const double p = std::max({base.r, base.g, base.b});
  if (p <= ks) return base;
  const double pn = 1 - (1 - ks) * (1 - ks) / (p + 1 - 2 * ks);
  const double g = 1 / (display_transform.kd * (p - pn) + 1);
  return glm::mix(glm::dvec3(pn), base * (pn / p), g);
}

/// Into [0,1].
glm::dvec3 displayed(glm::dvec3 rgb, DisplayView view) {
  constexpr double brightest = 1e30;  // for infinities: as bright as any, and fit to compute with
  for (int channel = 0; channel < 3; ++channel) {
    double& value = rgb[channel];
    value = value > 0.0 ? std::min(value, brightest) : 0.0;  // NaN too
  }
  // Rounding may leave a little more than 1, or less than 0.
  return glm::clamp(view == DisplayView::neutral ? neutral(rgb) : standard(rgb), 0.0, 1.0);
}

double largest_of(const glm::dvec3& rgb) { return std::max({rgb.r, rgb.g, rgb.b}); }

/// The displayed values of a pixel of an image, in [0,1]. On the border of a lamp or a window,
/// where one sample of many makes a pixel white and borders would be staircases, the two sides are
/// mixed as they are displayed: in the parts of which the pixel's light is the mix, taken from the
/// brightest and the darkest of the pixels around.
///   light   (x, y) of pixels in multiples of white
template <class Light>
glm::dvec3 shown(const Light& light, int width, int height, int x, int y, DisplayView view) {
  const glm::dvec3 own = light(x, y);
  glm::dvec3 dark = own, bright = own;
  const double here = largest_of(own);
  if (!(here > 1.0)) return displayed(own, view);
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i) {
      const glm::dvec3 other = light(i, j);
      if (largest_of(other) < largest_of(dark)) dark = other;
      if (largest_of(other) > largest_of(bright)) bright = other;
    }
  const double least = std::max(0.0, largest_of(dark)), most = largest_of(bright);
  if (!(most > display_transform.least_of_light) || !(least < 1.0) || !std::isfinite(most))
    return displayed(own, view);
  return glm::mix(displayed(dark, view), displayed(bright, view), (here - least) / (most - least));
}

glm::dvec3 scaled_to_white(double scale, const ToneMapping& parameters) {
  return scale / glm::dvec3(parameters.white[0], parameters.white[1], parameters.white[2]);
}

}  // namespace

std::string_view name_of(DisplayView view) { return name_in({"neutral", "standard"}, view); }

double automatic_exposure(const Image& scene_referred) {
  const Image* const one = &scene_referred;
  return automatic_exposure(std::span(&one, 1));
}

double automatic_exposure(std::span<const Image* const> scene_referred) {
  std::vector<double> luminances;
  for (const Image* const picture : scene_referred) {
    const RootPlanes root = root_of(*picture);
    for (std::size_t pixel = 0; pixel < root.r.size(); ++pixel) {
      const double value = luminance(root[pixel]);
      if (value > 0.0 && std::isfinite(value)) luminances.push_back(value);
    }
  }
  if (luminances.empty()) return 1.0;
  std::sort(luminances.begin(), luminances.end());
  const auto share_of = [](auto first, auto last) {
    return static_cast<std::ptrdiff_t>(display_transform.light_share *
                                       static_cast<double>(last - first));
  };
  const double outliers = display_transform.outlier_factor;
  const auto end = luminances.end();
  const double bright = end[-1 - share_of(luminances.begin(), end)];
  const auto seen =
      std::lower_bound(luminances.begin(), end, bright / display_transform.black_factor);
  const double median = seen[(end - seen) / 2];
  const auto first = std::lower_bound(seen, end, median / outliers);
  const auto lights = std::upper_bound(first, end, median * outliers);
  const auto last = std::max(lights, end - share_of(seen, end));
  double sum_of_logs = 0.0;
  std::for_each(first, last, [&](double value) { sum_of_logs += std::log(value); });
  return std::min(display_transform.key / std::exp(sum_of_logs / static_cast<double>(last - first)),
                  display_transform.highlights / lights[-1 - share_of(first, lights)]);
}

ToneMapping with_one_exposure(ToneMapping parameters,
                              std::span<const Image* const> scene_referred) {
  if (parameters.automatic_exposure) {
    parameters.exposure += std::log2(automatic_exposure(scene_referred));
  }
  parameters.automatic_exposure = false;
  return parameters;
}

Image tone_map(const Image& scene_referred, const ToneMapping& parameters) {
  check_exposure(parameters.exposure);
  const RootPlanes root = root_of(scene_referred);
  const double scale = std::exp2(parameters.exposure) *
                       (parameters.automatic_exposure ? automatic_exposure(scene_referred) : 1.0);

  Image display;
  display.width = scene_referred.width;
  display.height = scene_referred.height;
  for (const char* channel : {"R", "G", "B"}) display.add(channel);
  const glm::dvec3 to_white = scaled_to_white(scale, parameters);
  const auto row = static_cast<std::size_t>(display.width);
  const auto light = [&](int x, int y) {
    return to_white * root[static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x)];
  };
  image::for_each_pixel(root.r.size(), [&](std::size_t pixel) {
    const glm::dvec3 rgb =
        shown(light, display.width, display.height, static_cast<int>(pixel % row),
              static_cast<int>(pixel / row), parameters.view);
    for (int channel = 0; channel < 3; ++channel) {
      display.channels[static_cast<std::size_t>(channel)][pixel] = static_cast<float>(rgb[channel]);
    }
  });
  return display;
}

}  // namespace photile

namespace photile::image {

std::vector<std::uint8_t> png_bytes(const OutputFile& output, int width, int height,
                                    std::span<const std::uint8_t> texels) {
  png_image picture{};
  picture.version = PNG_IMAGE_VERSION;
  picture.width = static_cast<png_uint_32>(width);
  picture.height = static_cast<png_uint_32>(height);
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  picture.format = texels.size() == 4 * pixels ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(picture);
  std::vector<std::uint8_t> encoded(size);
  if (png_image_write_to_memory(&picture, encoded.data(), &size, 0, texels.data(), 0, nullptr) ==
      0) {
    output.fail(picture.message);
  }
  encoded.resize(size);
  return encoded;
}

void encode_png(OutputFile& output, int width, int height, std::span<const std::uint8_t> texels) {
  const std::vector<std::uint8_t> encoded = png_bytes(output, width, height, texels);
  output.write(encoded.data(), encoded.size());
}

}  // namespace photile::image

namespace photile {

void write_png(const std::filesystem::path& file, const Image& display_referred) {
  OutputFile output(file);
  for (const char* channel : {"R", "G", "B"}) {
    const std::vector<float>* plane = display_referred.find(channel);
    if (!plane) output.fail("the picture has no channels R, G, B");
    if (plane->empty()) output.fail("the picture has no pixels");
  }
  const std::vector<std::uint8_t> texels = image::srgb8_texels(display_referred);
  image::encode_png(output, display_referred.width, display_referred.height, texels);
  output.commit();
}

}  // namespace photile
