// EXR files of photile: their headers, and rows handed over as they are made.

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/ascii_text.hpp"
#include "common/files.hpp"
#include "image/exr_input.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"
#include "photile/limits.hpp"

namespace photile {

namespace {

/// A part of 32-bit floats with the header's size and the given channels. Says what its colours
/// are, as every part of a file must, and nothing else.
Imf::Header exr_header(const PictureHeader& header, const std::vector<std::string>& channels,
                       Imf::Compression compression) {
  Imf::Header part(header.width, header.height);
  part.compression() = compression;
  // Planes of floats take no more room by it than by OpenEXR's own 4, and less time.
  part.zipCompressionLevel() = 3;
  part.setType(Imf::SCANLINEIMAGE);
  for (const std::string& name : channels) part.channels().insert(name, Imf::Channel(Imf::FLOAT));
  Imf::addChromaticities(part, Imf::Chromaticities({0.64f, 0.33f}, {0.30f, 0.60f}, {0.15f, 0.06f},
                                                   {0.3127f, 0.3290f}));  // Rec.709
  part.insert("colorInteropID", Imf::StringAttribute("lin_rec709_scene"));
  return part;
}

/// Adds the picture's attributes.
void add_attributes(const PictureHeader& picture, Imf::Header& header) {
  for (const auto& [name, value] : picture.attributes) {
    header.insert(name, Imf::StringAttribute(value));
  }
  for (const auto& [name, value] : picture.numbers) {
    header.insert(name, Imf::FloatAttribute(value));
  }
  for (const auto& [name, matrix] : picture.matrices) {
    Imath::M44f value;
    std::copy(matrix.begin(), matrix.end(), &value[0][0]);
    header.insert(name, Imf::M44fAttribute(value));
  }
}

/// OpenEXR closes a file in a destructor, which can report nothing: errors are left to the output.
class ExrStream : public Imf::OStream {
 public:
  explicit ExrStream(OutputFile& output) : OStream("picture"), output_(output) {}

  void write(const char* bytes, int count) override {
    output_.write(bytes, static_cast<std::size_t>(count));
  }
  std::uint64_t tellp() override { return output_.position(); }
  void seekp(std::uint64_t position) override { output_.seek(position); }

 private:
  OutputFile& output_;
};

/// Writes parts one after the other, each from the top: a single-part file where there is one.
class ExrOutput {
 public:
  /// Errors: those of OutputFile::fail.
  ExrOutput(OutputFile& output, const std::vector<Imf::Header>& parts);

  /// The next rows of a part: `planes`, one for each of `channels`, of rows x width.
  /// Errors: those of OutputFile::fail.
  void write(std::size_t part, int rows, const std::vector<std::string>& channels,
             std::span<const float* const> planes);

  /// Errors: those of OutputFile::commit.
  void close();

 private:
  [[noreturn]] void fail(const std::exception& error);

  OutputFile& output_;
  ExrStream stream_;
  std::unique_ptr<Imf::MultiPartOutputFile> file_;
};

ExrOutput::ExrOutput(OutputFile& output, const std::vector<Imf::Header>& parts)
    : output_(output), stream_(output) {
  image::set_up_openexr();
  try {
    file_ = std::make_unique<Imf::MultiPartOutputFile>(stream_, parts.data(),
                                                       static_cast<int>(parts.size()));
  } catch (const std::exception& error) {
    fail(error);
  }
}

void ExrOutput::write(std::size_t part, int rows, const std::vector<std::string>& channels,
                      std::span<const float* const> planes) {
  try {
    Imf::OutputPart output(*file_, static_cast<int>(part));
    const int width = output.header().dataWindow().max.x + 1;
    Imf::FrameBuffer buffer;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      buffer.insert(channels[i], Imf::Slice::Make(Imf::FLOAT, planes[i],
                                                  {0, output.currentScanLine()}, width, rows));
    }
    output.setFrameBuffer(buffer);
    output.writePixels(rows);
  } catch (const std::exception& error) {
    fail(error);
  }
  if (output_.failed()) output_.fail("");
}

void ExrOutput::close() {
  file_.reset();
  output_.commit();
}

void ExrOutput::fail(const std::exception& error) { output_.fail(error.what()); }

/// Rows that are handed over at once; a multiple of the 16 rows of a ZIP block.
constexpr int rows_per_write = 64;

const std::vector<std::string> root_channels{"R", "G", "B", "A"};

/// Gives work(first, end) all rows of a picture, in turn.
template <class Work>
void for_rows(int height, const Work& work) {
  for (int first = 0; first < height; first += rows_per_write) {
    work(first, std::min(first + rows_per_write, height));
  }
}

void check_pixels(const OutputFile& output, const PictureHeader& picture) {
  if (picture.pixels() == 0) output.fail("the picture has no pixels");
}

/// Adds the planes of a picture from a row on.
void add_planes(const Image& picture, int first, std::vector<const float*>& planes) {
  for (const std::vector<float>& plane : picture.channels) {
    planes.push_back(plane.data() + static_cast<std::ptrdiff_t>(first) * picture.width);
  }
}

/// To 11 significant bits, ties to even; what is not finite stays.
void round_to_half(std::vector<float>& plane) {
  constexpr std::uint32_t dropped = 13, mask = (1u << dropped) - 1;
  for (float& value : plane) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t rounded = (bits + (mask >> 1) + (bits >> dropped & 1u)) & ~mask;
    if (const auto near = std::bit_cast<float>(rounded); std::isfinite(near)) value = near;
  }
}

LightRows rounded(LightRows rows, LayerPrecision precision) {
  if (precision != LayerPrecision::half) return rows;
  for (std::vector<float>& plane : rows.rgb) round_to_half(plane);
  round_to_half(rows.illuminance);
  return rows;
}

void add_planes(const LightRows& rows, std::vector<const float*>& planes) {
  for (const std::vector<float>& plane : rows.rgb) planes.push_back(plane.data());
  if (!rows.illuminance.empty()) planes.push_back(rows.illuminance.data());
}

/// All channels in one part, which every program reads.
void write_single_part(OutputFile& output, const LayeredPicture& picture,
                       LayerPrecision precision) {
  std::vector<std::string> names = root_channels;
  for (std::size_t light = 0; light < picture.lights(); ++light) {
    for (std::string& name : picture.channel_names(light)) names.push_back(std::move(name));
  }
  const bool lossy = precision == LayerPrecision::dwaa;
  Imf::Header header =
      exr_header(picture.header(), names, lossy ? Imf::DWAA_COMPRESSION : Imf::ZIP_COMPRESSION);
  add_attributes(picture.header(), header);
  ExrOutput file(output, {header});
  for_rows(picture.header().height, [&](int first, int end) {
    const Image root = picture.root(first, end);
    std::vector<LightRows> rows;
    for (std::size_t light = 0; light < picture.lights(); ++light) {
      rows.push_back(rounded(picture.read(light, first, end), precision));
    }
    std::vector<const float*> planes;
    add_planes(root, 0, planes);
    for (const LightRows& light : rows) add_planes(light, planes);
    file.write(0, end - first, names, planes);
  });
  file.close();
}

/// The root as the first part, which has the picture's attributes, and each light as a part that
/// bears the name of its layer. Apart from the root, which is small compared with all the lights,
/// no more than a few rows of one light are in memory.
void write_parts(OutputFile& output, const LayeredPicture& picture, LayerPrecision precision) {
  if (precision == LayerPrecision::dwaa) precision = LayerPrecision::half;
  // A row a block. OpenEXR keeps two blocks of each part for each thread until the file is closed:
  // the 16 rows of ZIP would add up to the picture.
  std::vector<std::vector<std::string>> names{root_channels};
  std::vector<Imf::Header> headers{
      exr_header(picture.header(), names.front(), Imf::ZIPS_COMPRESSION)};
  add_attributes(picture.header(), headers.front());
  headers.front().setName("Combined");
  for (std::size_t light = 0; light < picture.lights(); ++light) {
    names.push_back(picture.channel_names(light));
    const std::string& red = names.back().front();
    headers.push_back(exr_header(picture.header(), names.back(), Imf::ZIPS_COMPRESSION));
    headers.back().setName(red.substr(0, red.rfind('.')));
  }
  const Image root = picture.root();
  ExrOutput file(output, headers);
  for (std::size_t part = 0; part < headers.size(); ++part) {
    for_rows(picture.header().height, [&](int first, int end) {
      std::vector<const float*> planes;
      LightRows rows;
      if (part == 0) {
        add_planes(root, first, planes);
      } else {
        rows = rounded(picture.read(part - 1, first, end), precision);
        add_planes(rows, planes);
      }
      file.write(part, end - first, names[part], planes);
    });
  }
  file.close();
}

}  // namespace

void write_exr(const std::filesystem::path& file, const Image& image) {
  OutputFile output(file);
  check_pixels(output, image);
  if (image.channels.empty()) output.fail("the picture has no channels");
  Imf::Header header = exr_header(image, image.channel_names, Imf::ZIP_COMPRESSION);
  add_attributes(image, header);
  ExrOutput writer(output, {header});
  std::vector<const float*> planes;
  add_planes(image, 0, planes);
  writer.write(0, image.height, image.channel_names, planes);
  writer.close();
}

std::string_view name_of(LayerPrecision precision) {
  return name_in({"float", "half", "dwaa"}, precision);
}

void write_exr(const std::filesystem::path& file, const LayeredPicture& picture,
               LayerPrecision precision) {
  OutputFile output(file);
  check_pixels(output, picture.header());
  const bool single = picture.lights() <= limits::max_single_part_lights;
  single ? write_single_part(output, picture, precision) : write_parts(output, picture, precision);
}

}  // namespace photile
