#include <Imath/half.h>
#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <bit>
#include <cstdarg>
#include <cstring>
#include <functional>

#include "image/formats/formats.hpp"
#include "photile/limits.hpp"

namespace photile::image {
namespace {

/// The file in memory, and what libtiff says of it.
struct TiffSource {
  Encoded bytes;
  std::uint64_t place = 0;
  std::string error;

  static TiffSource& of(thandle_t handle) { return *static_cast<TiffSource*>(handle); }

  static tmsize_t read(thandle_t handle, void* to, tmsize_t count) {
    TiffSource& source = of(handle);
    const std::uint64_t left =
        source.bytes.size() - std::min<std::uint64_t>(source.place, source.bytes.size());
    const auto taken = static_cast<std::size_t>(std::min(static_cast<std::uint64_t>(count), left));
    if (taken > 0) std::memcpy(to, source.bytes.data() + source.place, taken);
    source.place += taken;
    return static_cast<tmsize_t>(taken);
  }
  static tmsize_t write(thandle_t, void*, tmsize_t) { return 0; }
  static toff_t seek(thandle_t handle, toff_t offset, int whence) {
    TiffSource& source = of(handle);
    const std::uint64_t from = whence == SEEK_CUR   ? source.place
                               : whence == SEEK_END ? source.bytes.size()
                                                    : 0;
    return source.place = from + offset;
  }
  static int close(thandle_t) { return 0; }
  static toff_t size(thandle_t handle) { return of(handle).bytes.size(); }

  static int fail(TIFF*, void* self, const char*, const char* format, va_list arguments) {
    std::string& error = static_cast<TiffSource*>(self)->error;
    char text[256];
    std::vsnprintf(text, sizeof text, format, arguments);
    if (error.empty()) error = text;
    return 1;
  }
  static int ignore(TIFF*, void*, const char*, const char*, va_list) { return 1; }
};

using Tiff = std::unique_ptr<TIFF, void (*)(TIFF*)>;

Tiff open_source(TiffSource& source) {
  const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                             TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), TiffSource::fail, &source);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), TiffSource::ignore, &source);
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), limits::max_image_block_bytes);
  return {
      TIFFClientOpenExt("", "rm", &source, TiffSource::read, TiffSource::write, TiffSource::seek,
                        TiffSource::close, TiffSource::size, nullptr, nullptr, options.get()),
      TIFFClose};
}

class TiffDecoder : public Decoder {
 public:
  explicit TiffDecoder(Encoded bytes) : source_{bytes, 0, {}}, tiff_(open_source(source_)) {
    check(tiff_ != nullptr);
    shape_ = {static_cast<int>(number32(TIFFTAG_IMAGEWIDTH)),
              static_cast<int>(number32(TIFFTAG_IMAGELENGTH)), number(TIFFTAG_SAMPLESPERPIXEL),
              Sample::byte};
    if (shape_.width < 1 || shape_.height < 1 || shape_.channels < 1) {
      throw DecodeError("the size is damaged");
    }
    bits_ = number(TIFFTAG_BITSPERSAMPLE);
    const int light = number(TIFFTAG_PHOTOMETRIC), format = number(TIFFTAG_SAMPLEFORMAT);
    const bool real = format == SAMPLEFORMAT_IEEEFP && (bits_ == 16 || bits_ == 32 || bits_ == 64);
    const bool whole = format == SAMPLEFORMAT_UINT && (bits_ == 8 || bits_ == 16);
    plain_ = (light == PHOTOMETRIC_MINISBLACK || light == PHOTOMETRIC_RGB) && (real || whole);
    if (plain_) {
      shape_.sample = real ? Sample::real : bits_ == 16 ? Sample::word : Sample::byte;
    } else {
      // What is left to libtiff: palettes, bits, inks, luminance with differences of colours.
      uint16_t count = 0, *kinds = nullptr;
      TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_EXTRASAMPLES, &count, &kinds);
      shape_.channels = count > 0 ? 4 : 3;
    }
  }

  Pixels decode() override {
    if (!plain_) return decode_by_library();
    planes_ = number(TIFFTAG_PLANARCONFIG) == PLANARCONFIG_SEPARATE ? shape_.channels : 1;
    if (shape_.sample == Sample::byte) return decode_as<std::uint8_t, std::uint8_t>();
    if (shape_.sample == Sample::word) return decode_as<std::uint16_t, std::uint16_t>();
    if (bits_ == 16) return decode_as<float, std::uint16_t>();
    if (bits_ == 32) return decode_as<float, float>();
    return decode_as<float, double>();
  }

 private:
  void check(bool done) const {
    if (!done) throw DecodeError(source_.error.empty() ? "damaged" : source_.error);
  }
  int number(ttag_t tag) const {
    uint16_t value = 0;
    TIFFGetFieldDefaulted(tiff_.get(), tag, &value);
    return value;
  }
  std::uint32_t number32(ttag_t tag) const {
    uint32_t value = 0;
    TIFFGetFieldDefaulted(tiff_.get(), tag, &value);
    return value;
  }

  /// Values in the file are `Stored`, those of 16 bits of floating-point pictures being halves.
  template <class T, class Stored>
  std::vector<T> decode_as() {
    std::vector<T> values(shape_.values());
    const auto channels = static_cast<std::size_t>(shape_.channels);
    const std::size_t step = planes_ > 1 ? channels : 1;  // from a value of a plane to the next
    const auto width = static_cast<std::size_t>(shape_.width) * (channels / step);
    // Values [from, from + count) of a row of a plane.
    const auto put = [&](int plane, std::size_t row, std::size_t from, std::size_t count,
                         const Stored* stored) {
      T* to = &values[row * width * step + from * step + static_cast<std::size_t>(plane)];
      for (std::size_t i = 0; i < count; ++i) to[i * step] = value_of<T>(stored[i]);
    };
    TIFFIsTiled(tiff_.get()) != 0 ? read_tiles<Stored>(channels / step, put)
                                  : read_rows<Stored>(width, put);
    return values;
  }

  template <class T, class Stored>
  static T value_of(Stored stored) {
    if constexpr (std::is_same_v<T, float> && std::is_same_v<Stored, std::uint16_t>) {
      return static_cast<float>(Imath::half(Imath::half::FromBits, stored));
    } else {
      return static_cast<T>(stored);
    }
  }

  template <class Stored, class Put>
  void read_rows(std::size_t width, const Put& put) {
    const auto bytes = static_cast<std::size_t>(TIFFScanlineSize64(tiff_.get()));
    if (bytes > limits::max_image_block_bytes) throw DecodeError("a row is damaged");
    std::vector<Stored> row(std::max(width, bytes / sizeof(Stored) + 1));
    for (int plane = 0; plane < planes_; ++plane) {
      for (int y = 0; y < shape_.height; ++y) {
        check(TIFFReadScanline(tiff_.get(), row.data(), static_cast<std::uint32_t>(y),
                               static_cast<std::uint16_t>(plane)) == 1);
        put(plane, static_cast<std::size_t>(y), 0, width, row.data());
      }
    }
  }

  template <class Stored, class Put>
  void read_tiles(std::size_t channels, const Put& put) {
    const std::uint32_t columns = number32(TIFFTAG_TILEWIDTH), rows = number32(TIFFTAG_TILELENGTH);
    const std::uint64_t bytes = TIFFTileSize64(tiff_.get());
    if (columns < 1 || rows < 1 || bytes > limits::max_image_block_bytes ||
        std::uint64_t{columns} * rows * channels * sizeof(Stored) > bytes) {
      throw DecodeError("a tile is damaged");
    }
    std::vector<Stored> tile(bytes / sizeof(Stored) + 1);
    const auto width = static_cast<std::uint32_t>(shape_.width),
               height = static_cast<std::uint32_t>(shape_.height);
    for (int plane = 0; plane < planes_; ++plane) {
      for (std::uint32_t top = 0; top < height; top += rows) {
        for (std::uint32_t left = 0; left < width; left += columns) {
          check(TIFFReadTile(tiff_.get(), tile.data(), left, top, 0,
                             static_cast<std::uint16_t>(plane)) >= 0);
          const std::size_t count = std::min(columns, width - left) * channels;
          for (std::uint32_t y = 0; y < std::min(rows, height - top); ++y) {
            put(plane, top + y, left * channels, count, &tile[y * columns * channels]);
          }
        }
      }
    }
  }

  std::vector<std::uint8_t> decode_by_library() {
    const std::size_t pixels = shape_.values() / static_cast<std::size_t>(shape_.channels);
    std::vector<std::uint32_t> packed(pixels);
    check(TIFFReadRGBAImageOriented(tiff_.get(), static_cast<std::uint32_t>(shape_.width),
                                    static_cast<std::uint32_t>(shape_.height), packed.data(),
                                    ORIENTATION_TOPLEFT, 1) == 1);
    std::vector<std::uint8_t> values;
    values.reserve(shape_.values());
    for (const std::uint32_t pixel : packed) {
      for (int c = 0; c < shape_.channels; ++c) {
        values.push_back(static_cast<std::uint8_t>(pixel >> (8 * c)));
      }
    }
    return values;
  }

  TiffSource source_;
  Tiff tiff_;
  int bits_ = 8, planes_ = 1;
  bool plain_ = true;
};

}  // namespace

std::unique_ptr<Decoder> open_tiff(Encoded bytes) { return std::make_unique<TiffDecoder>(bytes); }

}  // namespace photile::image
