#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "photile/errors.hpp"
#include "photile/image.hpp"
#include "photile/limits.hpp"

namespace photile {
namespace {

namespace fs = std::filesystem;
using OIIO::ImageInput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

[[noreturn]] void refuse(const fs::path& file, std::string reason) {
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  throw InputError(fmt::format("{}: {}", file.string(), reason));
}

void check_is_readable_file(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) refuse(file, "no such file; check the path");
  if (!fs::is_regular_file(status)) refuse(file, "is not a regular file; name a picture");
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error) refuse(file, "cannot be read: " + error.message());
  if (bytes == 0) refuse(file, "is empty; a picture is needed");
  if (bytes > limits::max_image_bytes) {
    refuse(file, fmt::format("is {} bytes long, more than the limit of {}; crop or split it", bytes,
                             limits::max_image_bytes));
  }
}

/// Decoded size is bounded before a pixel is decoded: a few bytes can announce terabytes.
void check_limits(const fs::path& file, const ImageSpec& spec, int total_channels) {
  if (spec.deep) refuse(file, "holds deep pixels; flatten it, e.g. with oiiotool --flatten");
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1) {
    refuse(file, fmt::format("is {} x {} x {} pixels with {} channels; a flat picture is needed",
                             spec.width, spec.height, spec.depth, spec.nchannels));
  }
  const std::uint64_t pixels = static_cast<std::uint64_t>(spec.width) * spec.height;
  if (spec.width > limits::max_image_side || spec.height > limits::max_image_side ||
      pixels > limits::max_image_pixels) {
    refuse(file,
           fmt::format("is {} x {} pixels, more than the limit of {} a side or {} in all; "
                       "scale it down",
                       spec.width, spec.height, limits::max_image_side, limits::max_image_pixels));
  }
  const std::uint64_t bytes = pixels * total_channels * sizeof(float);
  if (total_channels > limits::max_image_channels || bytes > limits::max_image_bytes) {
    refuse(file,
           fmt::format("has {} channels ({} bytes decoded), more than the limit of {} ({}); "
                       "leave channels out or scale it down",
                       total_channels, bytes, limits::max_image_channels, limits::max_image_bytes));
  }
}

/// Attributes that describe how the file was stored, not what it shows.
bool describes_storage(const std::string& name) {
  for (const char* prefix : {"oiio:", "openexr:", "png:", "jpeg:", "tiff:", "screenWindow"}) {
    if (name.rfind(prefix, 0) == 0) return true;
  }
  for (const char* known : {"compression", "DateTime", "chromaticities", "colorInteropID"}) {
    if (name == known) return true;
  }
  return false;
}

void take_attributes(const ImageSpec& spec, Image& image) {
  for (const OIIO::ParamValue& value : spec.extra_attribs) {
    const std::string name = value.name().string();
    if (describes_storage(name)) continue;
    if (value.type() == TypeDesc::STRING) {
      image.attributes.try_emplace(name, value.get_string());
    } else if (value.type() == TypeDesc::TypeMatrix) {
      std::memcpy(image.matrices[name].data(), value.data(), sizeof(float) * 16);
    } else if (value.type() == TypeDesc::FLOAT || value.type() == TypeDesc::INT) {
      image.numbers.try_emplace(name, value.get_float());
    }
  }
}

/// A name for a channel of a part: its own, or behind the part's name where an earlier part has
/// taken it (parts "left" and "right" with R, G, B each).
std::string channel_name(const fs::path& file, const Image& image, const ImageSpec& spec,
                         const std::string& own) {
  if (!image.find(own)) return own;
  const std::string with_part = spec.get_string_attribute("oiio:subimagename").str() + "." + own;
  if (image.find(with_part)) {
    refuse(file, fmt::format("has two channels named '{}'; rename one", own));
  }
  return with_part;
}

/// One part, as OpenImageIO has it selected, appended to the picture.
void read_part(const fs::path& file, ImageInput& input, int part, Image& image) {
  const ImageSpec& spec = input.spec();
  const std::size_t channels = static_cast<std::size_t>(spec.nchannels);
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  std::vector<float> interleaved(pixels * channels);
  if (!input.read_image(part, 0, 0, spec.nchannels, TypeDesc::FLOAT, interleaved.data())) {
    refuse(file, "is damaged: " + input.geterror());
  }
  for (std::size_t channel = 0; channel < channels; ++channel) {
    std::vector<float>& plane =
        image.add(channel_name(file, image, spec, spec.channel_name(static_cast<int>(channel))));
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      plane[pixel] = interleaved[pixel * channels + channel];
    }
  }
}

Image read_all_parts(const fs::path& file) {
  const auto input = ImageInput::open(file.string());
  if (!input) refuse(file, "is no picture that can be read: " + OIIO::geterror());
  const bool exr = std::strcmp(input->format_name(), "openexr") == 0;

  Image image;
  int channels = 0;
  // Other formats keep thumbnails, frames of a film and the like in further subimages.
  for (int part = 0; (part == 0 || exr) && input->seek_subimage(part, 0); ++part) {
    const ImageSpec& spec = input->spec();
    channels += spec.nchannels;
    check_limits(file, spec, channels);
    if (part == 0) {
      image.width = spec.width;
      image.height = spec.height;
    } else if (spec.width != image.width || spec.height != image.height) {
      refuse(file, fmt::format("has parts of {} x {} and {} x {} pixels; all must be of one size",
                               image.width, image.height, spec.width, spec.height));
    }
    take_attributes(spec, image);
    read_part(file, *input, part, image);
  }
  return image;
}

}  // namespace

Image read_image(const std::filesystem::path& file) {
  check_is_readable_file(file);
  try {
    return read_all_parts(file);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {  // a decoder's own, or no memory for what it announces
    refuse(file, std::string("cannot be read: ") + error.what());
  }
}

}  // namespace photile
