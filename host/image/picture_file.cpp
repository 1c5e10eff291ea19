#include "image/picture_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile::image {
namespace {

namespace fs = std::filesystem;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

/// Attributes that describe how the file was stored, not what it shows.
bool describes_storage(const std::string& name) {
  for (const char* prefix : {"oiio:", "openexr:", "png:", "jpeg:", "tiff:", "screenWindow"}) {
    if (name.rfind(prefix, 0) == 0) return true;
  }
  for (const char* known :
       {"compression", "DateTime", "chromaticities", "colorInteropID", "name"}) {
    if (name == known) return true;
  }
  return false;
}

void take_attributes(const ImageSpec& spec, PictureHeader& image) {
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

/// What keeps a file from being read as a picture, or "".
std::string unreadable(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) return "no such file; check the path";
  if (!fs::is_regular_file(status)) return "is not a regular file; name a picture";
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error) return "cannot be read: " + error.message();
  if (bytes == 0) return "is empty; a picture is needed";
  return {};
}

/// Why a part cannot be read whatever is done with it, or "".
std::string beyond_limits(const ImageSpec& spec) {
  if (spec.deep) return "holds deep pixels; flatten it, e.g. with oiiotool --flatten";
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1) {
    return fmt::format("is {} x {} x {} pixels with {} channels; a flat picture is needed",
                       spec.width, spec.height, spec.depth, spec.nchannels);
  }
  const std::uint64_t pixels = static_cast<std::uint64_t>(spec.width) * spec.height;
  if (spec.width > limits::max_image_side || spec.height > limits::max_image_side ||
      pixels > limits::max_image_pixels) {
    return fmt::format(
        "is {} x {} pixels, more than the limit of {} a side or {} in all; scale it down",
        spec.width, spec.height, limits::max_image_side, limits::max_image_pixels);
  }
  return {};
}

/// Why so many channels are too many to be held at once, or "". Decoded size is bounded before a
/// pixel is decoded: a few bytes can announce terabytes.
std::string too_large(std::uint64_t pixels, std::size_t channels) {
  const std::uint64_t bytes = pixels * channels * sizeof(float);
  if (channels <= limits::max_image_channels && bytes <= limits::max_image_bytes) return {};
  return fmt::format(
      "has {} channels ({} bytes decoded), more than the limit of {} ({}); "
      "leave channels out or scale it down",
      channels, bytes, limits::max_image_channels, limits::max_image_bytes);
}

}  // namespace

PictureFile::PictureFile(const fs::path& file) : file_(file) {
  if (const std::string reason = unreadable(file); !reason.empty()) refuse(reason);
  try {
    read_headers();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {  // a decoder's own
    refuse(std::string("cannot be read: ") + error.what());
  }
}

void PictureFile::read_headers() {
  input_ = OIIO::ImageInput::open(file_.string());
  if (!input_) refuse("is no picture that can be read: " + OIIO::geterror());
  const bool exr = std::strcmp(input_->format_name(), "openexr") == 0;
  // Other formats keep thumbnails, frames of a film and the like in further subimages.
  for (int part = 0; (part == 0 || exr) && input_->seek_subimage(part, 0); ++part) add_part(part);
}

void PictureFile::add_part(int part) {
  const ImageSpec& spec = input_->spec();
  std::string reason = beyond_limits(spec);
  if (reason.empty()) {
    reason = too_large(static_cast<std::uint64_t>(spec.width) * spec.height,
                       static_cast<std::size_t>(spec.nchannels));
  }
  if (!reason.empty()) refuse(reason);
  if (part == 0) {
    header_.width = spec.width;
    header_.height = spec.height;
  } else if (spec.width != header_.width || spec.height != header_.height) {
    refuse(fmt::format("has parts of {} x {} and {} x {} pixels; all must be of one size",
                       header_.width, header_.height, spec.width, spec.height));
  }
  take_attributes(spec, header_);
  largest_part_ = std::max(largest_part_, static_cast<std::size_t>(spec.nchannels));
  for (int i = 0; i < spec.nchannels; ++i) add_channel(part, static_cast<std::size_t>(i));
}

/// A channel has its own name, or that behind the part's name where an earlier part has taken it
/// (parts "left" and "right" with R, G, B each).
void PictureFile::add_channel(int part, std::size_t index) {
  const ImageSpec& spec = input_->spec();
  const std::string own = spec.channel_name(static_cast<int>(index));
  std::string name = own;
  if (names_.contains(name)) {
    name = spec.get_string_attribute("oiio:subimagename").str() + "." + own;
  }
  if (!names_.insert(name).second) {
    refuse(fmt::format("has two channels named '{}'; rename one", own));
  }
  if (header_.channel_names.size() == limits::max_layered_channels) {
    refuse(fmt::format("has more than {} channels; leave some out", limits::max_layered_channels));
  }
  header_.channel_names.push_back(name);
  places_.push_back({part, index});
}

void PictureFile::check_total() const {
  const std::string reason = too_large(header_.pixels(), header_.channel_names.size());
  if (!reason.empty()) refuse(reason);
  const std::uintmax_t bytes = fs::file_size(file_);
  if (bytes > limits::max_image_bytes) {
    refuse(fmt::format("is {} bytes long, more than the limit of {}; crop or split it", bytes,
                       limits::max_image_bytes));
  }
}

std::vector<float> PictureFile::read(std::size_t channel, int first, int end) {
  const Place& place = places_[channel];
  if (block_.part != place.part || first < block_.first || end > block_.end) {
    try {
      decode(place.part, first, end);
    } catch (const Error&) {
      throw;
    } catch (const std::exception& error) {  // a decoder's own, or no memory for what it announces
      refuse(std::string("cannot be read: ") + error.what());
    }
  }
  const auto width = static_cast<std::size_t>(header_.width);
  const float* const rows =
      &block_.interleaved[static_cast<std::size_t>(first - block_.first) * width * block_.channels];
  std::vector<float> values(static_cast<std::size_t>(end - first) * width);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = rows[i * block_.channels + place.index];
  }
  return values;
}

void PictureFile::decode(int part, int first, int end) {
  block_.part = -1;  // nothing is kept of a failure
  if (!input_->seek_subimage(part, 0)) refuse("is damaged: " + input_->geterror());
  const ImageSpec& spec = input_->spec();
  const bool tiled = spec.tile_width != 0;
  if (tiled) {
    first = 0;
    end = header_.height;
  }
  block_.channels = static_cast<std::size_t>(spec.nchannels);
  block_.interleaved.resize(static_cast<std::size_t>(end - first) *
                            static_cast<std::size_t>(header_.width) * block_.channels);
  float* const values = block_.interleaved.data();
  // Reading floats as floats in one call would still convert them, through 64 MB of memory.
  const bool floats = spec.format == TypeDesc::FLOAT && spec.channelformats.empty();
  const int first_row = spec.y + first, end_row = spec.y + end, channels = spec.nchannels;
  const bool read =
      tiled    ? input_->read_image(part, 0, 0, channels, TypeDesc::FLOAT, values)
      : floats ? input_->read_native_scanlines(part, 0, first_row, end_row, 0, 0, channels, values)
               : input_->read_scanlines(part, 0, first_row, end_row, 0, 0, channels,
                                        TypeDesc::FLOAT, values);
  if (!read) refuse("is damaged: " + input_->geterror());
  block_.first = first;
  block_.end = end;
  block_.part = part;
}

void PictureFile::refuse(std::string reason) const {
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  throw InputError(fmt::format("{}: {}", file_.string(), reason));
}

}  // namespace photile::image
