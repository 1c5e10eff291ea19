#include "image/decoder.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "photile/limits.hpp"

namespace photile::openimageio {
namespace {

/// For the process, once.
void set_up() {
  static const bool done = [] {
    OIIO::attribute("threads", 1);
    OIIO::attribute("limits:channels", limits::max_image_channels);
    OIIO::attribute("limits:imagesize_MB", static_cast<int>(limits::max_image_bytes >> 20));
    return true;
  }();
  static_cast<void>(done);
}

image::Sample sample_of(OIIO::TypeDesc stored) {
  if (stored.is_floating_point()) return image::Sample::real;
  return stored.size() == 1 ? image::Sample::byte : image::Sample::word;
}

/// The first line of the reader's message: the following lines repeat it, or name options of the
/// reader.
std::string reason_of(const OIIO::ImageInput& input) {
  std::string reason = input.geterror();
  reason.erase(std::find(reason.begin(), reason.end(), '\n'), reason.end());
  return reason.empty() ? "damaged, or of an unsupported kind" : reason;
}

class OpenImageIODecoder : public image::Decoder {
 public:
  OpenImageIODecoder(std::string_view reader, image::Encoded bytes)
      : memory_(bytes.data(), bytes.size()), input_(OIIO::ImageInput::create(std::string(reader))) {
    if (!input_) throw image::DecodeError("OpenImageIO has no reader for it");
    OIIO::ImageSpec options, spec;
    options["oiio:UnassociatedAlpha"] = 1;
    options["bmp:monochrome_detect"] = 0;
    input_->set_ioproxy(&memory_);
    if (!input_->open("the file", spec, options)) throw image::DecodeError(reason_of(*input_));
    shape_ = {spec.width, spec.height, spec.nchannels, sample_of(spec.format)};
    const bool alpha = spec.alpha_channel >= 0;
    if (reader == "tiff" && alpha && spec["compression"].get() == "jpeg") {
      throw image::DecodeError(
          "alpha with JPEG compression is not supported; use another compression");
    }
    associated_ = reader == "webp" && alpha;
  }

  image::Pixels decode() override {
    switch (shape_.sample) {
      case image::Sample::byte:
        return values<std::uint8_t>(OIIO::TypeDesc::UINT8);
      case image::Sample::word:
        return values<std::uint16_t>(OIIO::TypeDesc::UINT16);
      case image::Sample::real:
        break;
    }
    return values<float>(OIIO::TypeDesc::FLOAT);
  }

 private:
  template <class T>
  std::vector<T> values(OIIO::TypeDesc type) {
    std::vector<T> values(shape_.values());
    // Values that are stored as they are requested need no conversion, for which OpenImageIO would
    // take 64 MiB however small the picture is.
    const bool stored = input_->spec().format == type && input_->spec().channelformats.empty();
    const OIIO::TypeDesc requested = stored ? OIIO::TypeDesc() : type;
    const bool read = input_->read_image(0, 0, 0, shape_.channels, requested, values.data());
    if (!read || input_->has_error()) throw image::DecodeError(reason_of(*input_));
    if constexpr (std::is_same_v<T, std::uint8_t>) {
      if (associated_) divide_by_alpha(values);
    }
    return values;
  }

  /// WebP's reader has multiplied RGBA with alpha, in steps of 1/255, whatever it is asked for.
  static void divide_by_alpha(std::vector<std::uint8_t>& rgba) {
    for (std::size_t i = 0; i + 3 < rgba.size(); i += 4) {
      const int alpha = rgba[i + 3];
      for (std::size_t c = i; alpha > 0 && c < i + 3; ++c) {
        rgba[c] = static_cast<std::uint8_t>(std::min(255, (rgba[c] * 255 + alpha / 2) / alpha));
      }
    }
  }

  OIIO::Filesystem::IOMemReader memory_;
  OIIO::ImageInput::unique_ptr input_;
  bool associated_ = false;
};

}  // namespace
}  // namespace photile::openimageio

photile::image::Decoder* photile_openimageio_decoder(const char* reader,
                                                     photile::image::Encoded bytes) {
  photile::openimageio::set_up();
  return new photile::openimageio::OpenImageIODecoder(reader, bytes);
}
