#include "image/exr_output.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>

#include "image/exr_input.hpp"

namespace photile::image {

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
class ExrOutput::Stream : public Imf::OStream {
 public:
  explicit Stream(OutputFile& output) : OStream("picture"), output_(output) {}

  void write(const char* bytes, int count) override {
    output_.write(bytes, static_cast<std::size_t>(count));
  }
  std::uint64_t tellp() override { return output_.place(); }
  void seekp(std::uint64_t place) override { output_.seek(place); }

 private:
  OutputFile& output_;
};

ExrOutput::ExrOutput(OutputFile& output, const std::vector<Imf::Header>& parts)
    : output_(output), stream_(std::make_unique<Stream>(output)) {
  set_up_openexr();
  try {
    file_ = std::make_unique<Imf::MultiPartOutputFile>(*stream_, parts.data(),
                                                       static_cast<int>(parts.size()));
  } catch (const std::exception& error) {
    fail(error);
  }
}

ExrOutput::~ExrOutput() = default;

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

}  // namespace photile::image
