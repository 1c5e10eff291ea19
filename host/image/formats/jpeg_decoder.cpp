// clang-format off
#include <cstdio>  // before jpeglib.h, which needs it
#include <jpeglib.h>
// clang-format on

#include <array>

#include "image/formats/formats.hpp"

namespace photile::image {
namespace {

// libjpeg's frames hold nothing that an exception on its way through them would leave behind.
[[noreturn]] void jpeg_failure(j_common_ptr jpeg) {
  std::array<char, JMSG_LENGTH_MAX> reason{};
  jpeg->err->format_message(jpeg, reason.data());
  throw DecodeError(reason.data());
}

/// libjpeg's state.
struct JpegReader : jpeg_decompress_struct {
  jpeg_error_mgr errors{};

  JpegReader() : jpeg_decompress_struct{} {
    err = jpeg_std_error(&errors);
    errors.error_exit = jpeg_failure;
    errors.output_message = jpeg_failure;  // of a warning: the file is damaged, or ends too early
    jpeg_create_decompress(this);
  }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
  ~JpegReader() { jpeg_destroy_decompress(this); }
};

class JpegDecoder : public Decoder {
 public:
  explicit JpegDecoder(Encoded bytes) {
    jpeg_mem_src(&jpeg_, bytes.data(), bytes.size());
    jpeg_read_header(&jpeg_, TRUE);
    inks_ = jpeg_.num_components == 4;
    grey_ = jpeg_.num_components == 1;
    jpeg_.out_color_space = inks_ ? JCS_CMYK : grey_ ? JCS_GRAYSCALE : JCS_RGB;
    shape_ = {static_cast<int>(jpeg_.image_width), static_cast<int>(jpeg_.image_height),
              grey_ ? 1 : 3, Sample::byte};
  }

  Pixels decode() override {
    jpeg_start_decompress(&jpeg_);
    std::vector<std::uint8_t> values(shape_.values());
    const std::size_t stride = values.size() / static_cast<std::size_t>(shape_.height);
    std::vector<std::uint8_t> inks(inks_ ? 4 * static_cast<std::size_t>(shape_.width) : 0);
    for (std::size_t first = 0; first < values.size(); first += stride) {
      JSAMPROW row = inks_ ? inks.data() : &values[first];
      jpeg_read_scanlines(&jpeg_, &row, 1);
      if (inks_) mix(inks, &values[first]);
    }
    jpeg_finish_decompress(&jpeg_);
    return values;
  }

 private:
  /// Inks are stored inverted: what paper under each of them still reflects.
  static void mix(const std::vector<std::uint8_t>& inks, std::uint8_t* rgb) {
    for (std::size_t i = 0; i < inks.size(); i += 4) {
      for (std::size_t c = 0; c < 3; ++c) {
        *rgb++ = static_cast<std::uint8_t>((inks[i + c] * inks[i + 3] + 127) / 255);
      }
    }
  }

  JpegReader jpeg_;
  bool inks_ = false, grey_ = false;
};

}  // namespace

std::unique_ptr<Decoder> open_jpeg(Encoded bytes) { return std::make_unique<JpegDecoder>(bytes); }

}  // namespace photile::image
