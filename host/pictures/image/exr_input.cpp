#include "image/exr_input.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfEnvmapAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "image/color_space.hpp"
#include "image/decoder.hpp"
#include "image/picture_checks.hpp"
#include "photile/limits.hpp"

namespace photile::image {
namespace {

class MemoryStream : public Imf::IStream {
 public:
  explicit MemoryStream(std::span<const unsigned char> bytes) : IStream("memory"), bytes_(bytes) {}

  bool read(char* to, int count) override {
    const auto requested = static_cast<std::uint64_t>(count);
    if (position_ > bytes_.size() || requested > bytes_.size() - position_) {
      throw DecodeError("the file ends too early");
    }
    if (requested > 0) std::memcpy(to, bytes_.data() + position_, requested);
    position_ += requested;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::span<const unsigned char> bytes_;
  std::uint64_t position_ = 0;
};

/// The colours of the root, so that viewers and photile find the picture first.
int rank(const std::string& channel) {
  static constexpr std::string_view root = "RGBA";
  const std::size_t position = channel.size() == 1 ? root.find(channel) : std::string_view::npos;
  return static_cast<int>(std::min(position, root.size()));
}

/// Rows that are compressed together.
std::uint64_t rows_of_block(Imf::Compression compression) {
  switch (compression) {
    case Imf::NO_COMPRESSION:
    case Imf::RLE_COMPRESSION:
    case Imf::ZIPS_COMPRESSION:
      return 1;
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
      return 16;
    case Imf::DWAB_COMPRESSION:
      return 256;
    default:
      return 32;
  }
}

/// Tiles along one axis, of each of its levels: each has half the pixels of the one before.
std::vector<std::uint64_t> tiles_of_levels(std::uint64_t pixels, std::uint64_t tile,
                                           bool rounds_up) {
  std::vector<std::uint64_t> tiles;
  for (;;) {
    tiles.push_back((pixels + tile - 1) / tile);
    if (pixels <= 1) return tiles;
    pixels = (pixels + (rounds_up ? 1 : 0)) / 2;
  }
}

/// Blocks of pixels that are compressed on their own: what the table of a part has entries for.
std::uint64_t blocks_of(const Imf::Header& header) {
  const Imath::Box2i& window = header.dataWindow();
  const auto side = [](int from, int to) {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(std::int64_t{to} - from + 1, 0));
  };
  const std::uint64_t width = side(window.min.x, window.max.x),
                      height = side(window.min.y, window.max.y);
  if (!header.hasTileDescription()) {
    const std::uint64_t rows = rows_of_block(header.compression());
    return (height + rows - 1) / rows;
  }
  const Imf::TileDescription& tile = header.tileDescription();
  const bool rounds_up = tile.roundingMode == Imf::ROUND_UP;
  const auto across = tiles_of_levels(width, std::max(tile.xSize, 1u), rounds_up);
  const auto down = tiles_of_levels(height, std::max(tile.ySize, 1u), rounds_up);
  if (tile.mode == Imf::ONE_LEVEL) return across.front() * down.front();
  if (tile.mode == Imf::RIPMAP_LEVELS) {
    return std::accumulate(across.begin(), across.end(), std::uint64_t{0}) *
           std::accumulate(down.begin(), down.end(), std::uint64_t{0});
  }
  std::uint64_t sum = 0;
  for (std::size_t level = 0; level < std::max(across.size(), down.size()); ++level) {
    sum += across[std::min(level, across.size() - 1)] * down[std::min(level, down.size() - 1)];
  }
  return sum;
}

/// The last block of a part, or of its largest level: where the sides of its window are wrong it
/// has other pixels than they say.
///   entry   of its first block
ExrBlock last_block(const Imf::Header& header, std::uint64_t entry) {
  const Imath::Box2i& window = header.dataWindow();
  const auto side = [](int from, int to) {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(std::int64_t{to} - from + 1, 1));
  };
  std::uint64_t width = side(window.min.x, window.max.x), height = side(window.min.y, window.max.y);
  std::uint64_t across = 1, rows = rows_of_block(header.compression());
  if (header.hasTileDescription()) {
    const Imf::TileDescription& tile = header.tileDescription();
    across = (width - 1) / std::max(tile.xSize, 1u) + 1;
    width -= (across - 1) * tile.xSize;
    rows = std::max(tile.ySize, 1u);
  }
  const std::uint64_t down = (height - 1) / rows + 1;
  height -= (down - 1) * rows;
  std::uint64_t pixel_bytes = 0;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
    pixel_bytes += i.channel().type == Imf::HALF ? 2 : 4;
  }
  return {entry + across * down - 1, width * height * pixel_bytes, header.compression()};
}

/// The attributes that scale or place pixels.
void take_attributes(const Imf::Header& header, ExrInput::Part& part) {
  if (const auto* primaries =
          header.findTypedAttribute<Imf::ChromaticitiesAttribute>("chromaticities")) {
    const auto xy = [](const Imath::V2f& v) { return glm::dvec2(v.x, v.y); };
    const Imf::Chromaticities& from = primaries->value();
    part.to_rec709 = to_rec709({xy(from.red), xy(from.green), xy(from.blue), xy(from.white)});
  }
  if (const auto* white = header.findTypedAttribute<Imf::FloatAttribute>("whiteLuminance")) {
    const double luminance = white->value();
    part.white_luminance = std::isfinite(luminance) && luminance > 0 ? luminance : 0;
  }
  if (const auto* envmap = header.findTypedAttribute<Imf::EnvmapAttribute>("envmap")) {
    part.is_cube_map = envmap->value() == Imf::ENVMAP_CUBE;
  }
  // Not an attribute of OpenEXR, but one that OpenImageIO keeps of a photograph.
  if (const auto* turn = header.findTypedAttribute<Imf::IntAttribute>("Orientation")) {
    if (turn->value() > 1 && turn->value() <= 8) {
      throw DecodeError(fmt::format(
          "is rotated or flipped (Orientation {}); straighten it, e.g. with oiiotool --reorient",
          turn->value()));
    }
  }
}

ExrInput::Part part_of(const Imf::Header& header) {
  if (header.hasType() && Imf::isDeepData(header.type())) {
    throw DecodeError("holds deep pixels; flatten it, e.g. with oiiotool --flatten");
  }
  const Imath::Box2i &window = header.dataWindow(), &shown = header.displayWindow();
  ExrInput::Part part;
  const auto width = static_cast<std::uint64_t>(window.max.x - window.min.x + 1),
             height = static_cast<std::uint64_t>(window.max.y - window.min.y + 1);
  const std::int64_t shown_width = std::int64_t{shown.max.x} - shown.min.x + 1,
                     shown_height = std::int64_t{shown.max.y} - shown.min.y + 1;
  if (shown_width < 1 || shown_height < 1 || shown_width > limits::max_image_side ||
      shown_height > limits::max_image_side) {
    throw DecodeError(fmt::format("has a display window of {} x {} pixels; the limit is {} a side",
                                  shown_width, shown_height, limits::max_image_side));
  }
  part.width = static_cast<int>(shown_width);
  part.height = static_cast<int>(shown_height);
  take_attributes(header, part);
  if (header.hasName()) part.name = header.name();
  std::uint64_t pixel_bytes = 0;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
    if (i.channel().xSampling != 1 || i.channel().ySampling != 1) {
      throw DecodeError(std::string("channel '") + i.name() + "' is subsampled");
    }
    part.channels.emplace_back(i.name());
    pixel_bytes += i.channel().type == Imf::HALF ? 2 : 4;
  }
  std::stable_sort(part.channels.begin(), part.channels.end(),
                   [](const auto& a, const auto& b) { return rank(a) < rank(b); });
  std::uint64_t block = width * rows_of_block(header.compression());
  std::uint64_t most_bytes = limits::max_image_block_bytes;
  if (header.hasTileDescription()) {
    // OpenEXR keeps a row of tiles.
    const Imf::TileDescription& tile = header.tileDescription();
    block = std::max<std::uint64_t>(tile.xSize, width) * tile.ySize;
    // Tiles need not be far larger than the picture.
    if (block / 4 > width * height) most_bytes = std::min(most_bytes, unchecked_bytes);
  }
  if (pixel_bytes > 0 && block > most_bytes / pixel_bytes) {
    throw DecodeError(
        fmt::format("has blocks of {} pixels of {} bytes, more than the limit of {} bytes; save it "
                    "with smaller blocks",
                    block, pixel_bytes, most_bytes));
  }
  return part;
}

/// Changes each colour of the planes, LAYER.R, .G and .B, to Rec.709.
void convert(const ExrInput::Part& part, std::span<const std::size_t> channels,
             std::vector<float>& planes) {
  const std::size_t pixels = planes.size() / channels.size();
  const auto plane_of = [&](const std::string& name) -> float* {
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (part.channels[channels[i]] == name) return &planes[i * pixels];
    }
    return nullptr;
  };
  for (const std::size_t channel : channels) {
    const std::string& name = part.channels[channel];
    if (name != "R" && !name.ends_with(".R")) continue;
    const std::string layer = name.substr(0, name.size() - 1);
    float *const r = plane_of(name), *const g = plane_of(layer + "G"),
                 *const b = plane_of(layer + "B");
    if (g == nullptr || b == nullptr) continue;
    for (std::size_t i = 0; i < pixels; ++i) {
      const glm::vec3 color = converted(*part.to_rec709, glm::dvec3(r[i], g[i], b[i]));
      r[i] = color.r;
      g[i] = color.g;
      b[i] = color.b;
    }
  }
}

}  // namespace

void set_up_openexr() {
  static const bool done = [] {
    const auto threads = static_cast<int>(
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    Imf::setGlobalThreadCount(threads > 1 ? threads : 0);  // 0: the caller's own
    return true;
  }();
  static_cast<void>(done);
}

struct ExrInput::File : Imf::MultiPartInputFile {
  using MultiPartInputFile::MultiPartInputFile;
};

ExrInput::ExrInput(const std::filesystem::path& file)
    : stream_(std::make_unique<Imf::StdIFStream>(file.c_str())) {
  find_parts(std::filesystem::file_size(file));
}

ExrInput::ExrInput(std::span<const unsigned char> bytes)
    : stream_(std::make_unique<MemoryStream>(bytes)) {
  find_parts(bytes.size());
}

ExrInput::~ExrInput() = default;

void ExrInput::find_parts(std::uint64_t bytes) {
  set_up_openexr();
  const std::uint64_t table = check_exr_headers(*stream_, bytes);
  file_ = std::make_unique<File>(*stream_);
  std::uint64_t decoded = 0, stored = 0, pixels = 0, channels = 0;
  std::uint64_t blocks = 0;
  bool deflated = true;
  std::vector<bool> tiled;
  std::vector<ExrBlock> last_blocks;
  for (int i = 0; i < file_->parts(); ++i) {
    const Part& part = parts_.emplace_back(part_of(file_->header(i)));
    const Imath::Box2i& window = file_->header(i).dataWindow();
    const std::uint64_t own = static_cast<std::uint64_t>(window.max.x - window.min.x + 1) *
                              static_cast<std::uint64_t>(window.max.y - window.min.y + 1);
    const std::uint64_t shown = static_cast<std::uint64_t>(part.width) * part.height;
    pixels = std::max(pixels, own);
    channels += part.channels.size();
    stored += own * part.channels.size() * sizeof(float);
    decoded += std::max(own, shown) * part.channels.size() * sizeof(float);
    last_blocks.push_back(last_block(file_->header(i), blocks));
    blocks += blocks_of(file_->header(i));
    tiled.push_back(file_->header(i).hasTileDescription());
    deflated &= file_->header(i).compression() <= Imf::ZIP_COMPRESSION;
  }
  const std::uint64_t encoded = exr_pixel_bytes(*stream_, table, bytes, blocks, tiled);
  for (std::size_t i = 0; i < last_blocks.size(); ++i) {
    check_exr_block(*stream_, table, last_blocks[i], tiled[i]);
  }
  // OpenEXR reads what is missing as zeros. Deflate's longest match makes 258 bytes of 2 bits, and
  // halves become floats.
  constexpr std::uint64_t most_deflated = 2 * 4 * 258;
  const bool lacks_bytes = deflated && stored / most_deflated > encoded;
  constexpr std::uint64_t bytes_of_channel = 128;  // its name, what the header says of its light
  if (!lacks_bytes &&
      (decoded <= unchecked_bytes ||
       (pixels < encoded * limits::max_exr_pixels_per_byte &&
        decoded / limits::max_image_expansion <= encoded + bytes_of_channel * channels))) {
    return;
  }
  throw DecodeError(
      fmt::format("is damaged or empty: {} bytes for the {} channels of {} x {} pixels; the limit "
                  "is {} pixels per byte, and a factor of {}; scale it down",
                  encoded, channels, parts_.front().width, parts_.front().height,
                  limits::max_exr_pixels_per_byte, limits::max_image_expansion));
}

const Imf::Header& ExrInput::header(std::size_t part) const {
  return file_->header(static_cast<int>(part));
}

void ExrInput::read(std::size_t part, int first, int end, std::span<const std::size_t> channels,
                    std::vector<float>& planes) {
  const Imath::Box2i &window = header(part).dataWindow(), &shown = header(part).displayWindow();
  if (window == shown) {
    read_stored(part, first, end, channels, planes);
  } else {
    // Where the data window begins in the display window, and those of its rows and columns that
    // are requested.
    const std::int64_t left = std::int64_t{window.min.x} - shown.min.x,
                       top = std::int64_t{window.min.y} - shown.min.y,
                       stored_height = window.max.y - window.min.y + 1,
                       stored_width = window.max.x - window.min.x + 1,
                       shown_width = parts_[part].width;
    const auto width = static_cast<std::size_t>(shown_width),
               rows = static_cast<std::size_t>(end - first);
    planes.assign(channels.size() * rows * width, 0.0f);
    const std::int64_t begin_row = std::clamp<std::int64_t>(first - top, 0, stored_height),
                       end_row = std::clamp<std::int64_t>(end - top, 0, stored_height),
                       begin = std::clamp<std::int64_t>(-left, 0, stored_width),
                       stop = std::clamp<std::int64_t>(shown_width - left, 0, stored_width);
    if (begin_row >= end_row || begin >= stop) return;
    std::vector<float> stored;
    read_stored(part, static_cast<int>(begin_row), static_cast<int>(end_row), channels, stored);
    const std::int64_t stored_rows = end_row - begin_row;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      for (std::int64_t row = 0; row < stored_rows; ++row) {
        const std::int64_t y = begin_row + row + top - first;
        const auto from = (static_cast<std::int64_t>(c) * stored_rows + row) * stored_width + begin;
        const auto to = (c * rows + static_cast<std::size_t>(y)) * width +
                        static_cast<std::size_t>(begin + left);
        std::copy_n(&stored[static_cast<std::size_t>(from)], stop - begin, &planes[to]);
      }
    }
  }
  if (parts_[part].to_rec709) convert(parts_[part], channels, planes);
}

void ExrInput::read_stored(std::size_t part, int first, int end,
                           std::span<const std::size_t> channels, std::vector<float>& planes) {
  const Imath::Box2i& window = header(part).dataWindow();
  const int columns = window.max.x - window.min.x + 1;
  const auto width = static_cast<std::size_t>(columns);
  const std::size_t plane = static_cast<std::size_t>(end - first) * width;
  planes.resize(plane * channels.size());
  const Imath::V2i corner(window.min.x, window.min.y + first);
  Imf::FrameBuffer buffer;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    buffer.insert(parts_[part].channels[channels[i]],
                  Imf::Slice::Make(Imf::FLOAT, &planes[i * plane], corner, columns, end - first,
                                   sizeof(float), sizeof(float) * width));
  }
  Imf::InputPart input(*file_, static_cast<int>(part));
  input.setFrameBuffer(buffer);
  input.readPixels(corner.y, corner.y + (end - first) - 1);
}

}  // namespace photile::image
