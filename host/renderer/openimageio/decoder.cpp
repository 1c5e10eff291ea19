#include "image/openimageio_decoder.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <memory>
#include <string>

#include "openimageio/silence.hpp"
#include "photile/limits.hpp"

namespace photile::image {
namespace {

const char* reader_of(PictureFormat format) {
  switch (format) {
    case PictureFormat::png:
      return "png";
    case PictureFormat::jpeg:
      return "jpeg";
    case PictureFormat::radiance:
      return "hdr";
    case PictureFormat::tiff:
      return "tiff";
    case PictureFormat::webp:
      return "webp";
    case PictureFormat::bmp:
      return "bmp";
    case PictureFormat::gif:
      return "gif";
    case PictureFormat::targa:
      return "targa";
    case PictureFormat::pnm:
      return "pnm";
    case PictureFormat::exr:
      break;  // photile's own
  }
  throw DecodeError("not a picture format that is read");
}

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

Sample sample_of(OIIO::TypeDesc stored) {
  if (stored.is_floating_point()) return Sample::real;
  return stored.size() == 1 ? Sample::byte : Sample::word;
}

/// What the reader says first: the lines behind it say the same again, or name its options.
std::string reason_of(const OIIO::ImageInput& input) {
  std::string reason = input.geterror();
  reason.erase(std::find(reason.begin(), reason.end(), '\n'), reason.end());
  return reason.empty() ? "damaged, or of a kind that is not read" : reason;
}

class OpenImageIODecoder : public Decoder {
 public:
  OpenImageIODecoder(PictureFormat format, Encoded bytes)
      : memory_(bytes.data(), bytes.size()), input_(OIIO::ImageInput::create(reader_of(format))) {
    if (!input_) throw DecodeError("OpenImageIO has no reader for it");
    const Silence silence;
    OIIO::ImageSpec options, spec;
    options["oiio:UnassociatedAlpha"] = 1;
    options["bmp:monochrome_detect"] = 0;
    input_->set_ioproxy(&memory_);
    if (!input_->open("the file", spec, options)) throw DecodeError(reason_of(*input_));
    shape_ = {spec.width, spec.height, spec.nchannels, sample_of(spec.format)};
    const bool alpha = spec.alpha_channel >= 0;
    if (format == PictureFormat::tiff && alpha && spec["compression"].get() == "jpeg") {
      throw DecodeError("alpha beside JPEG's compression is not read; save it with another");
    }
    associated_ = format == PictureFormat::webp && alpha;
  }

  Pixels decode() override {
    switch (shape_.sample) {
      case Sample::byte:
        return values<std::uint8_t>(OIIO::TypeDesc::UINT8);
      case Sample::word:
        return values<std::uint16_t>(OIIO::TypeDesc::UINT16);
      case Sample::real:
        break;
    }
    return values<float>(OIIO::TypeDesc::FLOAT);
  }

 private:
  template <class T>
  std::vector<T> values(OIIO::TypeDesc type) {
    const Silence silence;
    std::vector<T> values(shape_.values());
    const bool read = input_->read_image(0, 0, 0, shape_.channels, type, values.data());
    if (!read || input_->has_error()) throw DecodeError(reason_of(*input_));
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
}  // namespace photile::image

photile::image::Decoder* photile_openimageio_decoder(photile::image::PictureFormat format,
                                                     photile::image::Encoded bytes) {
  photile::image::set_up();
  return new photile::image::OpenImageIODecoder(format, bytes);
}
