#include "image/decoder.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>

#include "common/ascii_text.hpp"
#include "common/module.hpp"
#include "image/exr_input.hpp"
#include "image/picture_checks.hpp"
#include "photile/errors.hpp"

namespace photile::image {

namespace {

constexpr std::string_view exr_reader = "openexr";

std::unique_ptr<Decoder> open_by_openimageio(const char* reader, Encoded bytes) {
  // It stays loaded: OpenImageIO and what it is made of are not made to be unloaded.
  static const Module& module = *new Module("photile_openimageio.so");
  static auto* const open =
      module.find<decltype(photile_openimageio_decoder)>("photile_openimageio_decoder");
  if (open == nullptr) {
    throw UsageError(fmt::format(
        "pictures other than EXR cannot be read: {}; install the package photile-openimageio",
        module.error()));
  }
  return std::unique_ptr<Decoder>(open(reader, bytes));
}

}  // namespace

const char* reader_of(const std::string& name, Encoded bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  using namespace std::string_view_literals;
  if (text.starts_with("\x89PNG"sv)) return "png";
  if (text.starts_with("\xFF\xD8"sv)) return "jpeg";
  if (text.starts_with("\x76\x2F\x31\x01"sv)) return exr_reader.data();
  if (text.starts_with("#?"sv)) return "hdr";
  if (text.starts_with("II*\0"sv) || text.starts_with("MM\0*"sv)) return "tiff";
  if (text.starts_with("BM"sv)) return "bmp";
  if (text.starts_with("GIF8"sv)) return "gif";
  if (text.size() > 12 && text.starts_with("RIFF"sv) && text.substr(8).starts_with("WEBP"sv)) {
    return "webp";
  }
  const std::string extension = lower(std::filesystem::path(name).extension().string());
  if (extension == ".tga") return "targa";
  if (extension == ".pbm" || extension == ".pgm" || extension == ".ppm" || extension == ".pnm") {
    return "pnm";
  }
  throw DecodeError("not a picture format that is read (EXR, PNG, JPEG, ...)");
}

std::unique_ptr<Decoder> open_picture(const std::string& name, Encoded bytes) {
  const char* const reader = reader_of(name, bytes);
  std::unique_ptr<Decoder> decoder;
  if (reader == exr_reader) {
    decoder = open_exr(bytes);
  } else {
    check_encoded(reader, bytes);
    decoder = open_by_openimageio(reader, bytes);
  }
  check_shape(decoder->shape(), bytes.size());
  return decoder;
}

namespace {

/// How many channels of a part are its picture: R, G, B and A where there are such. Depth, normals
/// or lights behind them are none of it.
std::size_t picture_channels(const ExrInput::Part& part) {
  const std::vector<std::string>& names = part.channels;
  if (names.size() < 3 || names[0] != "R" || names[1] != "G" || names[2] != "B")
    return names.size();
  return names.size() > 3 && names[3] == "A" ? 4 : 3;
}

class ExrDecoder : public Decoder {
 public:
  explicit ExrDecoder(Encoded bytes) : input_(bytes) {
    const ExrInput::Part& part = input_.parts().front();
    shape_ = {part.width, part.height, static_cast<int>(picture_channels(part)), Sample::real};
  }

  Pixels decode() override {
    constexpr int rows_at_once = 64;
    const auto channels = static_cast<std::size_t>(shape_.channels),
               width = static_cast<std::size_t>(shape_.width);
    std::vector<float> values(shape_.values()), planes;
    for (int first = 0; first < shape_.height; first += rows_at_once) {
      const int end = std::min(first + rows_at_once, shape_.height);
      input_.read(0, first, end, channels, planes);
      const std::size_t pixels = static_cast<std::size_t>(end - first) * width;
      float* const to = &values[static_cast<std::size_t>(first) * width * channels];
      for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t i = 0; i < pixels; ++i) to[i * channels + c] = planes[c * pixels + i];
      }
    }
    return values;
  }

 private:
  ExrInput input_;
};

}  // namespace

std::unique_ptr<Decoder> open_exr(Encoded bytes) { return std::make_unique<ExrDecoder>(bytes); }

}  // namespace photile::image
