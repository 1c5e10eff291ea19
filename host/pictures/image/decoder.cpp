#include "image/decoder.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

#include "common/ascii_text.hpp"
#include "common/module.hpp"
#include "image/display.hpp"
#include "image/exr_input.hpp"
#include "image/picture_checks.hpp"
#include "image/picture_metadata.hpp"
#include "photile/errors.hpp"

namespace photile::image {

namespace {

constexpr std::string_view exr_reader = "openexr", png_reader = "png";

std::unique_ptr<Decoder> open_by_openimageio(const char* reader, Encoded bytes) {
  // It stays loaded: OpenImageIO and its libraries are not designed to be unloaded.
  static const Module& module = *new Module("photile_openimageio.so");
  static auto* const open =
      module.find<decltype(photile_openimageio_decoder)>("photile_openimageio_decoder");
  if (open == nullptr) {
    throw UsageError(
        fmt::format("pictures other than EXR and PNG cannot be read: {}; install the package "
                    "photile-openimageio",
                    module.error()));
  }
  return std::unique_ptr<Decoder>(open(reader, bytes));
}

}  // namespace

const char* reader_of(const std::string& name, Encoded bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  using namespace std::string_view_literals;
  if (text.starts_with("\x89PNG"sv)) return png_reader.data();
  if (text.starts_with("\xFF\xD8"sv)) return "jpeg";
  if (text.starts_with("\x76\x2F\x31\x01"sv)) return exr_reader.data();
  if (text.starts_with("#?"sv)) return "hdr";
  if (text.starts_with("II*\0"sv) || text.starts_with("MM\0*"sv)) return "tiff";
  if (text.starts_with("BM"sv)) return "bmp";
  if (text.starts_with("GIF8"sv)) return "gif";
  if (text.starts_with("PF\n"sv) || text.starts_with("Pf\n"sv)) return "pnm";
  if (text.size() > 12 && text.starts_with("RIFF"sv) && text.substr(8).starts_with("WEBP"sv)) {
    return "webp";
  }
  const std::string extension = lower(std::filesystem::path(name).extension().string());
  if (extension == ".tga") return "targa";
  if (extension == ".pbm" || extension == ".pgm" || extension == ".ppm" || extension == ".pnm") {
    return "pnm";
  }
  throw DecodeError("not a supported picture format (EXR, PNG, JPEG, ...)");
}

namespace {

/// By libpng: most textures are PNGs, and need none of the libraries of OpenImageIO.
class PngDecoder : public Decoder {
 public:
  explicit PngDecoder(Encoded bytes) : left_(bytes) {
    png_set_read_fn(reading_.png, this, &PngDecoder::read);
    png_read_info(reading_.png, reading_.info);
    png_set_expand(reading_.png);  // palettes, few bits and transparent colours
    if constexpr (std::endian::native == std::endian::little) png_set_swap(reading_.png);
    png_set_interlace_handling(reading_.png);
    png_read_update_info(reading_.png, reading_.info);
    shape_ = {static_cast<int>(png_get_image_width(reading_.png, reading_.info)),
              static_cast<int>(png_get_image_height(reading_.png, reading_.info)),
              png_get_channels(reading_.png, reading_.info),
              png_get_bit_depth(reading_.png, reading_.info) == 16 ? Sample::word : Sample::byte};
  }

  Pixels decode() override {
    if (shape_.sample == Sample::byte) return values<std::uint8_t>();
    return values<std::uint16_t>();
  }

 private:
  struct Reading {
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, &fail, &ignore);
    png_infop info = png_create_info_struct(png);

    Reading() = default;
    Reading(const Reading&) = delete;
    Reading& operator=(const Reading&) = delete;
    ~Reading() { png_destroy_read_struct(&png, &info, nullptr); }
  };

  [[noreturn]] static void fail(png_structp, png_const_charp reason) { throw DecodeError(reason); }
  static void ignore(png_structp, png_const_charp) {}
  static void read(png_structp png, png_bytep to, std::size_t size) {
    Encoded& left = static_cast<PngDecoder*>(png_get_io_ptr(png))->left_;
    if (size > left.size()) fail(png, "the file ends too early");
    std::copy_n(left.begin(), size, to);
    left = left.subspan(size);
  }

  template <class T>
  std::vector<T> values() {
    std::vector<T> values(shape_.values());
    std::vector<png_bytep> rows;
    const std::size_t in_row = values.size() / static_cast<std::size_t>(shape_.height);
    for (std::size_t first = 0; first < values.size(); first += in_row) {
      rows.push_back(reinterpret_cast<png_bytep>(&values[first]));
    }
    png_read_image(reading_.png, rows.data());
    return values;
  }

  Encoded left_;
  Reading reading_;
};

/// The channels of an EXR that are its picture: R, G and B, or Y, of the first part that has them,
/// or of its one layer, or of that called Combined. Depth, normals or lights are not part of it.
struct ExrPicture {
  std::size_t part = 0;
  std::vector<std::size_t> channels;
};

std::optional<std::size_t> channel_named(const ExrInput::Part& part, const std::string& name) {
  const auto found = std::find(part.channels.begin(), part.channels.end(), name);
  if (found == part.channels.end()) return std::nullopt;
  return static_cast<std::size_t>(found - part.channels.begin());
}

/// The colours below `layer`, which is "" or ends in a point; none where one of them is missing.
std::vector<std::size_t> colors_of(const ExrInput::Part& part, const std::string& layer) {
  std::vector<std::size_t> channels;
  for (const char* const color : {"R", "G", "B"}) {
    const auto channel = channel_named(part, layer + color);
    if (!channel) return {};
    channels.push_back(*channel);
  }
  if (const auto alpha = channel_named(part, layer + "A")) channels.push_back(*alpha);
  return channels;
}

std::vector<std::size_t> grey_of(const ExrInput::Part& part) {
  const auto grey = channel_named(part, "Y"), alpha = channel_named(part, "A");
  if (part.channels.size() == 1) return {0};
  if (!grey || channel_named(part, "RY") || channel_named(part, "BY")) return {};
  return alpha ? std::vector{*grey, *alpha} : std::vector{*grey};
}

ExrPicture picture_in(const std::vector<ExrInput::Part>& parts) {
  std::vector<ExrPicture> layers, combined;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (auto channels = colors_of(parts[p], ""); !channels.empty()) return {p, channels};
    for (const std::string& channel : parts[p].channels) {
      if (!channel.ends_with(".R")) continue;
      const std::string layer = channel.substr(0, channel.size() - 1);
      auto channels = colors_of(parts[p], layer);
      if (channels.empty()) continue;
      layers.push_back({p, channels});
      if (layer.ends_with("Combined.")) combined.push_back(layers.back());
    }
  }
  if (layers.size() == 1) return layers.front();
  if (combined.size() == 1) return combined.front();
  for (std::size_t p = 0; layers.empty() && p < parts.size(); ++p) {
    if (auto channels = grey_of(parts[p]); !channels.empty()) return {p, channels};
  }
  const std::vector<std::string>& names = parts.front().channels;
  constexpr std::size_t most_named = 8;
  throw DecodeError(fmt::format(
      "has neither channels R, G and B nor Y, but {}{}; rename its channels",
      fmt::join(names.begin(), names.begin() + std::min(names.size(), most_named), ", "),
      names.size() > most_named ? ", ..." : ""));
}

class ExrDecoder : public Decoder {
 public:
  explicit ExrDecoder(Encoded bytes) : input_(bytes), picture_(picture_in(input_.parts())) {
    const ExrInput::Part& part = input_.parts()[picture_.part];
    shape_ = {part.width, part.height, static_cast<int>(picture_.channels.size()), Sample::real};
  }

  Pixels decode() override {
    constexpr int rows_at_once = 64;
    const auto channels = static_cast<std::size_t>(shape_.channels),
               width = static_cast<std::size_t>(shape_.width);
    std::vector<float> values(shape_.values()), planes;
    for (int first = 0; first < shape_.height; first += rows_at_once) {
      const int end = std::min(first + rows_at_once, shape_.height);
      input_.read(picture_.part, first, end, picture_.channels, planes);
      const std::size_t pixels = static_cast<std::size_t>(end - first) * width;
      float* const to = &values[static_cast<std::size_t>(first) * width * channels];
      for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t i = 0; i < pixels; ++i) to[i * channels + c] = planes[c * pixels + i];
      }
    }
    return values;
  }

  PictureMetadata metadata() const {
    const ExrInput::Part& part = input_.parts()[picture_.part];
    PictureMetadata metadata;
    metadata.white_luminance = part.white_luminance;
    if (part.is_cube_map) metadata.projection = "a cube map";
    return metadata;
  }

 private:
  ExrInput input_;
  ExrPicture picture_;
};

/// The same pixels under a header of what every reader reads.
std::vector<unsigned char> with_plain_header(const RadianceHeader& header, Encoded bytes) {
  const std::string plain = fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n",
                                        header.rows, header.columns);
  std::vector<unsigned char> result(plain.begin(), plain.end());
  result.insert(result.end(), bytes.begin() + static_cast<std::ptrdiff_t>(header.end), bytes.end());
  return result;
}

/// Stored rows and columns, turned upright.
template <class T>
std::vector<T> turned_upright(const std::vector<T>& stored, const PictureShape& shape,
                              Orientation orientation) {
  std::vector<T> result(stored.size());
  const auto channels = static_cast<std::size_t>(shape.channels);
  const int width = is_turned(orientation) ? shape.height : shape.width;
  const int height = is_turned(orientation) ? shape.width : shape.height;
  const bool from_right =
      orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
  const bool from_bottom =
      orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
  for (int row = 0; row < shape.height; ++row) {
    for (int column = 0; column < shape.width; ++column) {
      int x = is_turned(orientation) ? row : column, y = is_turned(orientation) ? column : row;
      if (from_right) x = width - 1 - x;
      if (from_bottom) y = height - 1 - y;
      const auto from = static_cast<std::size_t>(row) * static_cast<std::size_t>(shape.width) +
                        static_cast<std::size_t>(column);
      const auto to = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x);
      std::copy_n(&stored[from * channels], channels, &result[to * channels]);
    }
  }
  return result;
}

/// Stored values of a colour to linear ones: each value of integers once.
template <class T>
std::vector<float> linear_values(const ColorSpace::Curve& curve) {
  std::vector<float> table(std::size_t{std::numeric_limits<T>::max()} + 1);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double value = static_cast<double>(i) / static_cast<double>(table.size() - 1);
    table[i] = static_cast<float>(curve ? curve(value) : linear_from_srgb(value));
  }
  return table;
}

/// Interleaved values as linear ones, still of their own primaries.
template <class T>
std::vector<float> linear_colors(const std::vector<T>& values, std::size_t channels,
                                 const PictureMetadata& metadata) {
  const std::size_t colors = channels < 3 ? 1 : 3;
  std::vector<float> result;
  result.reserve(values.size());
  if constexpr (std::is_floating_point_v<T>) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::size_t c = i % channels;
      result.push_back(c < colors
                           ? static_cast<float>(values[i] * metadata.scale[static_cast<int>(c)])
                           : values[i]);
    }
  } else {
    std::array<std::vector<float>, 3> tables;
    for (std::size_t c = 0; c < colors; ++c) {
      tables[c] = linear_values<T>(metadata.color.curves[c]);
    }
    constexpr float white = static_cast<float>(std::numeric_limits<T>::max());
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::size_t c = i % channels;
      result.push_back(c < colors ? tables[c][values[i]] : static_cast<float>(values[i]) / white);
    }
  }
  return result;
}

}  // namespace

EncodedPicture::EncodedPicture(const std::string& name, Encoded bytes) {
  const char* const reader = reader_of(name, bytes);
  if (reader == exr_reader) {
    auto exr = std::make_unique<ExrDecoder>(bytes);
    metadata_ = std::make_unique<PictureMetadata>(exr->metadata());
    decoder_ = std::move(exr);
  } else {
    check_encoded(reader, bytes);
    metadata_ = std::make_unique<PictureMetadata>(read_metadata(reader, bytes));
    if (reader == std::string_view("hdr")) {
      rewritten_ = with_plain_header(read_radiance_header(bytes), bytes);
    }
    if (reader == png_reader) {
      decoder_ = std::make_unique<PngDecoder>(bytes);
    } else {
      decoder_ = open_by_openimageio(reader, rewritten_.empty() ? bytes : Encoded(rewritten_));
    }
  }
  shape_ = decoder_->shape();
  check_shape(shape_, bytes.size());
  if (is_turned(metadata_->orientation)) std::swap(shape_.width, shape_.height);
}

EncodedPicture::~EncodedPicture() = default;

Pixels EncodedPicture::decode() {
  Pixels stored = decoder_->decode();
  if (metadata_->orientation == upright) return stored;
  return std::visit(
      [&](const auto& values) -> Pixels {
        return turned_upright(values, decoder_->shape(), metadata_->orientation);
      },
      stored);
}

std::vector<float> EncodedPicture::light() {
  if (!metadata_->color.problem.empty()) throw DecodeError(metadata_->color.problem);
  const auto channels = static_cast<std::size_t>(shape_.channels);
  std::vector<float> light = std::visit(
      [&](const auto& values) { return linear_colors(values, channels, *metadata_); }, decode());
  if (!metadata_->color.to_rec709 || channels < 3) return light;
  for (std::size_t i = 0; i < light.size(); i += channels) {
    const glm::vec3 color =
        converted(*metadata_->color.to_rec709, glm::dvec3(light[i], light[i + 1], light[i + 2]));
    for (int c = 0; c < 3; ++c) light[i + static_cast<std::size_t>(c)] = color[c];
  }
  return light;
}

std::unique_ptr<EncodedPicture> open_picture(const std::string& name, Encoded bytes) {
  return std::make_unique<EncodedPicture>(name, bytes);
}

}  // namespace photile::image
