#include "image/decoder.hpp"

#include <filesystem>
#include <string_view>

#include "common/ascii_text.hpp"
#include "image/formats/formats.hpp"

namespace photile::image {

PictureFormat format_of(const std::string& name, std::span<const unsigned char> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  using namespace std::string_view_literals;
  if (text.starts_with("\x89PNG"sv)) return PictureFormat::png;
  if (text.starts_with("\xFF\xD8"sv)) return PictureFormat::jpeg;
  if (text.starts_with("\x76\x2F\x31\x01"sv)) return PictureFormat::exr;
  if (text.starts_with("#?"sv)) return PictureFormat::radiance;
  if (text.starts_with("II*\0"sv) || text.starts_with("MM\0*"sv)) return PictureFormat::tiff;
  if (text.starts_with("BM"sv)) return PictureFormat::bmp;
  if (text.starts_with("GIF8"sv)) return PictureFormat::gif;
  if (text.size() > 12 && text.starts_with("RIFF"sv) && text.substr(8).starts_with("WEBP"sv)) {
    return PictureFormat::webp;
  }
  const std::string extension = lower(std::filesystem::path(name).extension().string());
  if (extension == ".tga") return PictureFormat::targa;
  if (extension == ".pbm" || extension == ".pgm" || extension == ".ppm" || extension == ".pnm") {
    return PictureFormat::pnm;
  }
  throw DecodeError("not a picture format that is read (EXR, PNG, JPEG, ...)");
}

std::unique_ptr<Decoder> open_picture(const std::string& name,
                                      std::span<const unsigned char> bytes) {
  switch (format_of(name, bytes)) {
    case PictureFormat::exr:
      return open_exr(bytes);
    case PictureFormat::png:
      return open_png(bytes);
    case PictureFormat::jpeg:
      return open_jpeg(bytes);
    case PictureFormat::radiance:
      return open_radiance(bytes);
    case PictureFormat::tiff:
      return open_tiff(bytes);
    case PictureFormat::webp:
      return open_webp(bytes);
    case PictureFormat::bmp:
    case PictureFormat::gif:
    case PictureFormat::targa:
      return open_simple(bytes);
    case PictureFormat::pnm:
      return open_pnm(bytes);
  }
  throw DecodeError("not a picture format that is read");
}

}  // namespace photile::image
