#include "import/texture_decoder.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "import/resource_error.hpp"
#include "photile/limits.hpp"

namespace photile::scene_io {
namespace {

/// OpenImageIO's name of the format, by signature, or else by the extension of the few formats
/// without one. Empty when unknown: OpenImageIO's own guessing would also try video and archives.
std::string format_of(const std::string& name, std::span<const unsigned char> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  using namespace std::string_view_literals;
  if (text.starts_with("\x89PNG"sv)) return "png";
  if (text.starts_with("\xFF\xD8"sv)) return "jpeg";
  if (text.starts_with("\x76\x2F\x31\x01"sv)) return "openexr";
  if (text.starts_with("#?"sv)) return "hdr";
  if (text.starts_with("II*\0"sv) || text.starts_with("MM\0*"sv)) return "tiff";
  if (text.starts_with("BM"sv)) return "bmp";
  if (text.starts_with("GIF8"sv)) return "gif";
  if (text.starts_with("RIFF"sv) && text.substr(8).starts_with("WEBP"sv)) return "webp";
  const std::string extension =
      OIIO::Strutil::lower(std::filesystem::path(name).extension().string());
  if (extension == ".tga") return "targa";
  if (extension == ".ppm" || extension == ".pgm" || extension == ".pnm") return "pnm";
  return "";
}

void check_limits(const OIIO::ImageSpec& spec, std::size_t encoded_bytes) {
  if (spec.width <= 0 || spec.height <= 0 || spec.depth > 1 || spec.deep || spec.nchannels <= 0) {
    throw ResourceError("not a plain two-dimensional picture");
  }
  const auto pixels =
      static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height);
  if (spec.width > limits::max_image_side || spec.height > limits::max_image_side ||
      pixels > limits::max_image_pixels) {
    throw ResourceError(fmt::format("{} x {} pixels; the limit is {} a side and {} in all",
                                    spec.width, spec.height, limits::max_image_side,
                                    limits::max_image_pixels));
  }
  if (spec.nchannels > limits::max_image_channels) {
    throw ResourceError(
        fmt::format("{} channels; the limit is {}", spec.nchannels, limits::max_image_channels));
  }
  const std::uint64_t decoded = spec.image_bytes(true);
  if (decoded > limits::max_image_bytes) {
    throw ResourceError(
        fmt::format("{} bytes decoded; the limit is {}", decoded, limits::max_image_bytes));
  }
  if (decoded > limits::unchecked_image_bytes &&
      decoded / std::max<std::size_t>(encoded_bytes, 1) > limits::max_image_expansion) {
    throw ResourceError(fmt::format("{} bytes decode to {}; the limit is a factor of {}",
                                    encoded_bytes, decoded, limits::max_image_expansion));
  }
}

std::uint8_t byte_of(float value) {
  const float c = std::isnan(value) ? 0.0f : std::clamp(value, 0.0f, 1.0f);
  return static_cast<std::uint8_t>(c * 255.0f + 0.5f);
}

std::uint8_t srgb_byte(float linear) {
  const float c = std::isnan(linear) ? 0.0f : std::clamp(linear, 0.0f, 1.0f);
  return byte_of(c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f);
}

/// Red, green, blue and alpha of a pixel of 1 (grey), 2 (grey, alpha), 3 or 4 channels. `alpha` is
/// that of pixels without one.
template <typename T>
std::array<T, 4> rgba(const T* pixel, int channels, T alpha) {
  if (channels < 3) return {pixel[0], pixel[0], pixel[0], channels == 2 ? pixel[1] : alpha};
  return {pixel[0], pixel[1], pixel[2], channels == 4 ? pixel[3] : alpha};
}

template <typename T>
std::vector<T> read_pixels(OIIO::ImageInput& input, int channels, OIIO::TypeDesc type) {
  const OIIO::ImageSpec& spec = input.spec();
  std::vector<T> pixels(static_cast<std::size_t>(spec.width) *
                        static_cast<std::size_t>(spec.height) * static_cast<std::size_t>(channels));
  if (!input.read_image(0, 0, 0, channels, type, pixels.data())) {
    throw ResourceError(input.geterror());
  }
  return pixels;
}

/// An encoded picture in memory, opened and within the limits.
class OpenPicture {
 public:
  OpenPicture(const std::string& name, std::span<const unsigned char> bytes)
      : memory_(const_cast<unsigned char*>(bytes.data()), bytes.size()) {
    const std::string format = format_of(name, bytes);
    if (format.empty()) throw ResourceError("not a picture format that is read (PNG, JPEG, ...)");
    input_ = OIIO::ImageInput::create(format);
    if (!input_ || !input_->supports("ioproxy")) {
      throw ResourceError(format + " pictures are not read");
    }
    input_->set_ioproxy(&memory_);
    OIIO::ImageSpec spec, config;
    config["oiio:UnassociatedAlpha"] = 1;  // colours as stored
    if (!input_->open(name, spec, config)) throw ResourceError(input_->geterror());
    check_limits(spec, bytes.size());
  }

  OIIO::ImageInput& input() { return *input_; }
  const OIIO::ImageSpec& spec() const { return input_->spec(); }

 private:
  OIIO::Filesystem::IOMemReader memory_;
  std::unique_ptr<OIIO::ImageInput> input_;
};

std::vector<std::array<std::uint8_t, 4>> decode(OpenPicture& picture, TextureContent content) {
  const OIIO::ImageSpec& spec = picture.spec();
  const int channels = std::min(spec.nchannels, 4);
  const auto stride = static_cast<std::size_t>(channels);
  const bool alpha_is_first = content == TextureContent::opacity;
  std::vector<std::array<std::uint8_t, 4>> texels(static_cast<std::size_t>(spec.width) *
                                                  static_cast<std::size_t>(spec.height));
  if (spec.format.is_floating_point()) {
    const auto encoded = content == TextureContent::color ? srgb_byte : byte_of;
    const auto pixels = read_pixels<float>(picture.input(), channels, OIIO::TypeDesc::FLOAT);
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const float* first = &pixels[i * stride];
      const auto [r, g, b, a] = rgba(first, channels, alpha_is_first ? *first : 1.0f);
      texels[i] = {encoded(r), encoded(g), encoded(b), byte_of(a)};
    }
  } else {
    const auto pixels = read_pixels<std::uint8_t>(picture.input(), channels, OIIO::TypeDesc::UINT8);
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const std::uint8_t* first = &pixels[i * stride];
      texels[i] = rgba<std::uint8_t>(first, channels, alpha_is_first ? *first : 255);
    }
  }
  return texels;
}

}  // namespace

Texture decode_texture(const std::string& name, std::span<const unsigned char> bytes,
                       TextureContent content) {
  try {
    OpenPicture picture(name, bytes);
    return Texture(name, picture.spec().width, picture.spec().height, decode(picture, content));
  } catch (const ResourceError& error) {
    throw ResourceError(fmt::format("texture '{}': {}", name, error.what()));
  }
}

RadiancePicture decode_radiance(const std::string& name, std::span<const unsigned char> bytes) {
  OpenPicture picture(name, bytes);
  const OIIO::ImageSpec& spec = picture.spec();
  if (!spec.format.is_floating_point()) {
    throw ResourceError("its pixels are no floating-point numbers");
  }
  const int channels = std::min(spec.nchannels, 4);
  const auto pixels = read_pixels<float>(picture.input(), channels, OIIO::TypeDesc::FLOAT);
  RadiancePicture result{spec.width, spec.height, {}};
  for (std::size_t i = 0; i < pixels.size(); i += static_cast<std::size_t>(channels)) {
    const std::array<float, 4> pixel = rgba(&pixels[i], channels, 1.0f);
    result.texels.emplace_back(pixel[0], pixel[1], pixel[2]);
  }
  return result;
}

RadiancePicture decode_rgbd(const std::string& name, std::span<const unsigned char> bytes) {
  const Texture encoded = decode_texture(name, bytes);
  RadiancePicture result{encoded.width(), encoded.height(), {}};
  const glm::vec2 size(encoded.width(), encoded.height());
  for (int y = 0; y < encoded.height(); ++y) {
    for (int x = 0; x < encoded.width(); ++x) {
      const glm::vec2 middle = (glm::vec2(x, y) + 0.5f) / size;  // the texel itself
      const float alpha = std::max(encoded.sample_data(middle).a, 1.0f / 255.0f);
      result.texels.push_back(encoded.sample(middle) / alpha);
    }
  }
  return result;
}

}  // namespace photile::scene_io
