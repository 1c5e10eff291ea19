#include "image/picture_file.hpp"

#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <new>
#include <numeric>

#include "common/files.hpp"
#include "image/decoder.hpp"
#include "image/picture_checks.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile::image {

namespace {

namespace fs = std::filesystem;
/// Attributes that describe how the file is stored, not what it shows.
bool describes_storage(const std::string& name) {
  static const std::set<std::string> known{"capDate",
                                           "channels",
                                           "chromaticities",
                                           "chunkCount",
                                           "colorInteropID",
                                           "compression",
                                           "dataWindow",
                                           "displayWindow",
                                           "lineOrder",
                                           "name",
                                           "owner",
                                           "pixelAspectRatio",
                                           "preview",
                                           "screenWindowCenter",
                                           "screenWindowWidth",
                                           "tiles",
                                           "type",
                                           "version",
                                           "view",
                                           "multiView",
                                           "DateTime"};
  return name.starts_with("oiio:") || known.contains(name);
}

void take_attributes(const Imf::Header& header, PictureHeader& image) {
  for (auto i = header.begin(); i != header.end(); ++i) {
    const std::string name = i.name();
    const Imf::Attribute& value = i.attribute();
    // Parts may hold attributes of one name and two types: the first counts.
    const bool taken = image.attributes.contains(name) || image.matrices.contains(name) ||
                       image.numbers.contains(name);
    if (taken || describes_storage(name)) continue;
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&value)) {
      image.attributes.emplace(name, text->value());
    } else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&value)) {
      std::copy_n(&matrix->value()[0][0], 16, image.matrices[name].begin());
    } else if (const auto* real = dynamic_cast<const Imf::FloatAttribute*>(&value)) {
      image.numbers.emplace(name, real->value());
    } else if (const auto* integer = dynamic_cast<const Imf::IntAttribute*>(&value)) {
      image.numbers.emplace(name, static_cast<float>(integer->value()));
    }
  }
}

/// Why a file cannot be read as a picture, or "".
std::string unreadable(const fs::path& file) {
  if (const std::string reason = why_no_regular_file(file); !reason.empty()) return reason;
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error) return "cannot be read: " + error.message();
  if (bytes == 0) return "is empty; give a picture";
  return {};
}

/// Bytes of pixels in memory.
std::uint64_t decoded_bytes(int width, int height, std::size_t channels) {
  return static_cast<std::uint64_t>(width) * height * channels * sizeof(float);
}

std::vector<unsigned char> bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<unsigned char> bytes(fs::file_size(file));
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream) throw DecodeError("the file ends too early");
  return bytes;
}

/// Interleaved values as planes.
std::vector<float> planes_of(const std::vector<float>& values, std::size_t channels) {
  std::vector<float> planes(values.size());
  const std::size_t pixels = values.size() / channels;
  for (std::size_t i = 0; i < values.size(); ++i) {
    planes[i % channels * pixels + i / channels] = values[i];
  }
  return planes;
}

}  // namespace

PictureFile::PictureFile(const fs::path& file) : file_(file) {
  if (const std::string reason = unreadable(file); !reason.empty()) refuse(reason);
  try {
    read_headers();
  } catch (const Error&) {
    throw;
  } catch (const DecodeError& error) {
    refuse(error.what());
  } catch (const std::exception& error) {  // a decoder's own
    refuse(std::string("cannot be read: ") + error.what());
  }
}

void PictureFile::read_headers() {
  unsigned char magic[4] = {};
  std::ifstream(file_, std::ios::binary).read(reinterpret_cast<char*>(magic), sizeof magic);
  const bool exr =
      std::equal(std::begin(magic), std::end(magic), "\x76\x2F\x31\x01",
                 [](unsigned char a, char b) { return a == static_cast<unsigned char>(b); });
  exr ? open_exr() : open_other();
}

void PictureFile::open_exr() {
  exr_ = std::make_unique<ExrInput>(file_);
  for (std::size_t part = 0; part < exr_->parts().size(); ++part) {
    add_part(exr_->parts()[part]);
    take_attributes(exr_->header(part), header_);
  }
}

/// Their pixels are decoded at once, when some are asked for.
void PictureFile::open_other() {
  const std::vector<unsigned char> bytes = bytes_of(file_);
  const std::unique_ptr<EncodedPicture> picture = open_picture(file_.string(), bytes);
  const PictureShape& shape = picture->shape();
  std::vector<std::string> names{"Y", "A"};
  if (shape.channels > 2) names = {"R", "G", "B", "A"};
  while (static_cast<int>(names.size()) < shape.channels) {
    names.push_back(fmt::format("channel{}", names.size()));
  }
  names.resize(static_cast<std::size_t>(shape.channels));
  ExrInput::Part part;
  part.width = shape.width;
  part.height = shape.height;
  part.channels = names;
  add_part(part);
}

void PictureFile::add_part(const ExrInput::Part& part) {
  std::string reason = beyond_limits(part.width, part.height, part.channels.size());
  if (reason.empty()) {
    reason = too_large(part.channels.size(),
                       decoded_bytes(part.width, part.height, part.channels.size()));
  }
  if (!reason.empty()) refuse(reason);
  if (header_.channel_names.empty()) {
    header_.width = part.width;
    header_.height = part.height;
  } else if (part.width != header_.width || part.height != header_.height) {
    refuse(fmt::format("has parts of {} x {} and {} x {} pixels; all must be of one size",
                       header_.width, header_.height, part.width, part.height));
  }
  largest_part_ = std::max(largest_part_, part.channels.size());
  ++parts_;
  for (std::size_t i = 0; i < part.channels.size(); ++i) add_channel(part, i);
}

/// A channel has its own name, or that behind the part's name where an earlier part has taken it
/// (parts "left" and "right" with R, G, B each).
void PictureFile::add_channel(const ExrInput::Part& part, std::size_t index) {
  const std::string& own = part.channels[index];
  std::string name = own;
  if (names_.contains(name)) name = part.name + "." + own;
  // Control characters, which would leave the line of a list or a message.
  if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c == 127; })) {
    refuse("has a channel whose name is not text; rename it");
  }
  if (!names_.insert(name).second) {
    refuse(fmt::format("has two channels named '{}'; rename one", own));
  }
  if (header_.channel_names.size() == limits::max_layered_channels) {
    refuse(fmt::format("has more than {} channels; remove some", limits::max_layered_channels));
  }
  header_.channel_names.push_back(name);
  slots_.push_back({parts_ - 1, index});
}

std::vector<std::size_t> PictureFile::first_channels() const {
  std::vector<std::size_t> channels;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (static_cast<std::size_t>(slots_[i].part) == channels.size()) channels.push_back(i);
  }
  return channels;
}

void PictureFile::check_total() const {
  const std::string reason =
      too_large(header_.channel_names.size(),
                decoded_bytes(header_.width, header_.height, header_.channel_names.size()));
  if (!reason.empty()) refuse(reason);
  const std::uintmax_t bytes = fs::file_size(file_);
  if (bytes > limits::max_image_bytes) {
    refuse(fmt::format("is {} bytes long, more than the limit of {}; crop or split it", bytes,
                       limits::max_image_bytes));
  }
}

std::vector<float> PictureFile::read(std::size_t channel, int first, int end) {
  const Slot& slot = slots_[channel];
  if (block_.part != slot.part || first < block_.first || end > block_.end) {
    try {
      decode(slot.part, first, end);
    } catch (const Error&) {
      throw;
    } catch (const std::exception& error) {  // a decoder's own, or no memory for what it announces
      refuse(std::string("is damaged: ") + error.what());
    }
  }
  const auto width = static_cast<std::size_t>(header_.width),
             rows = static_cast<std::size_t>(block_.end - block_.first);
  const float* const begin =
      &block_.planes[(slot.index * rows + static_cast<std::size_t>(first - block_.first)) * width];
  return {begin, begin + static_cast<std::size_t>(end - first) * width};
}

void PictureFile::decode(int part, int first, int end) {
  block_.part = -1;  // nothing is kept of a failure
  if (exr_) {
    const auto index = static_cast<std::size_t>(part);
    std::vector<std::size_t> channels(exr_->parts()[index].channels.size());
    std::iota(channels.begin(), channels.end(), std::size_t{0});
    exr_->read(index, first, end, channels, block_.planes);
  } else {
    const std::vector<unsigned char> bytes = bytes_of(file_);
    block_.planes = planes_of(open_picture(file_.string(), bytes)->light(), largest_part_);
    first = 0;
    end = header_.height;
  }
  block_.first = first;
  block_.end = end;
  block_.part = part;
}

void PictureFile::refuse(const std::string& reason) const {
  throw InputError(fmt::format("{}: {}", file_.string(), reason));
}

}  // namespace photile::image

namespace photile {

namespace {

constexpr int rows_per_channel_read = 256;

}  // namespace

PictureHeader read_header(const std::filesystem::path& file) {
  return image::PictureFile(file).header();
}

void check_pixels(const std::filesystem::path& file) {
  image::PictureFile source(file);
  const int height = source.header().height;
  for (const std::size_t channel : source.first_channels()) {
    for (int first = 0; first < height; first += rows_per_channel_read) {
      source.read(channel, first, std::min(first + rows_per_channel_read, height));
    }
  }
}

Image read_image(const std::filesystem::path& file) {
  image::PictureFile source(file);
  source.check_total();
  try {
    Image image;
    static_cast<PictureHeader&>(image) = source.header();
    image.channels.resize(image.channel_names.size());
    for (std::vector<float>& plane : image.channels) plane.reserve(image.pixels());
    // All channels of some rows, so that what is decoded at a time is little.
    for (int first = 0; first < image.height; first += rows_per_channel_read) {
      const int end = std::min(first + rows_per_channel_read, image.height);
      for (std::size_t i = 0; i < image.channels.size(); ++i) {
        const std::vector<float> rows = source.read(i, first, end);
        image.channels[i].insert(image.channels[i].end(), rows.begin(), rows.end());
      }
    }
    return image;
  } catch (const std::bad_alloc&) {
    throw InputError(file.string() + ": not enough memory to read it; scale it down");
  }
}

const std::vector<float>* Image::find(const std::string& channel) const {
  const auto found = std::find(channel_names.begin(), channel_names.end(), channel);
  if (found == channel_names.end()) return nullptr;
  return &channels[static_cast<std::size_t>(found - channel_names.begin())];
}

std::vector<float>& Image::add(const std::string& channel) {
  channel_names.push_back(channel);
  return channels.emplace_back(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

}  // namespace photile
