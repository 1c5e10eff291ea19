#include "image/write_exr_parts.hpp"

#include <algorithm>
#include <memory>
#include <span>

#include "common/output_file.hpp"
#include "image/exr_spec.hpp"

namespace photile::image {
namespace {

/// Rows that are interleaved and handed over at once.
constexpr int rows_per_write = 64;

/// A row a block. OpenEXR keeps two blocks of each part for each thread until the file is closed:
/// the 16 rows of ZIP would add up to the picture.
constexpr const char* compression = "zips";

std::vector<OIIO::ImageSpec> specs_of(const LayeredPicture& picture, const Image& root) {
  std::vector<OIIO::ImageSpec> specs{exr_spec(root, root.channel_names, compression)};
  add_attributes(root, specs.front());
  specs.front().attribute("oiio:subimagename", "Combined");
  for (std::size_t light = 0; light < picture.lights(); ++light) {
    const std::vector<std::string> names = picture.channel_names(light);
    specs.push_back(exr_spec(root, names, compression));
    specs.back().attribute("oiio:subimagename", names.front().substr(0, names.front().rfind('.')));
  }
  return specs;
}

/// Parts of a file, one after the other.
class PartWriter {
 public:
  /// OpenImageIO writes files of several parts by name only.
  PartWriter(OutputFile& output, const std::vector<OIIO::ImageSpec>& specs)
      : output_(output), specs_(specs), encoder_(OIIO::ImageOutput::create("exr")) {
    if (!encoder_) output_.fail(OIIO::geterror());
    check(encoder_->open(output_.temporary().string(), static_cast<int>(specs_.size()),
                         specs_.data()));
  }

  void begin(std::size_t part) {
    if (part == 0) return;
    check(encoder_->open(output_.temporary().string(), specs_[part],
                         OIIO::ImageOutput::AppendSubimage));
  }

  void write(int first, int end, std::span<const float* const> channels) {
    const std::size_t pixels =
        static_cast<std::size_t>(end - first) * static_cast<std::size_t>(specs_.front().width);
    rows_.resize(pixels * channels.size());
    for (std::size_t c = 0; c < channels.size(); ++c) {
      for (std::size_t i = 0; i < pixels; ++i) rows_[i * channels.size() + c] = channels[c][i];
    }
    check(encoder_->write_scanlines(first, end, 0, OIIO::TypeDesc::FLOAT, rows_.data()));
  }

  void close() {
    check(encoder_->close());
    encoder_.reset();
  }

 private:
  void check(bool done) {
    if (done) return;
    const std::string reason = encoder_->geterror();
    encoder_.reset();  // first the encoder, then the file that it writes
    output_.fail_on_behalf(reason);
  }

  OutputFile& output_;
  const std::vector<OIIO::ImageSpec>& specs_;
  std::unique_ptr<OIIO::ImageOutput> encoder_;
  std::vector<float> rows_;
};

/// OpenEXR notices no error of its last writes, those of the destructor: what is missing then is
/// the end of the file.
void check_complete(const OutputFile& output, std::size_t parts) {
  const auto file = OIIO::ImageInput::open(output.temporary().string());
  if (!file) output.fail_on_behalf(OIIO::geterror());
  std::vector<float> row;
  for (std::size_t part = 0; part < parts; ++part) {
    const int number = static_cast<int>(part);
    const OIIO::ImageSpec spec = file->spec_dimensions(number);
    row.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.nchannels));
    if (spec.height < 1 || !file->read_native_scanlines(number, 0, spec.height - 1, spec.height, 0,
                                                        0, spec.nchannels, row.data())) {
      output.fail_on_behalf(file->geterror());
    }
  }
}

}  // namespace

void write_exr_parts(const std::filesystem::path& file, const LayeredPicture& picture,
                     const Image& root) {
  OutputFile output(file);
  if (root.pixels() == 0) output.fail("the picture has no pixels");
  const std::vector<OIIO::ImageSpec> specs = specs_of(picture, root);
  PartWriter writer(output, specs);
  for (std::size_t part = 0; part < specs.size(); ++part) {
    writer.begin(part);
    for (int first = 0; first < root.height; first += rows_per_write) {
      const int end = std::min(first + rows_per_write, root.height);
      std::vector<const float*> channels;
      LightRows rows;
      if (part == 0) {
        for (const std::vector<float>& plane : root.channels) {
          channels.push_back(plane.data() + static_cast<std::ptrdiff_t>(first) * root.width);
        }
      } else {
        rows = picture.read(part - 1, first, end);
        for (const std::vector<float>& plane : rows.rgb) channels.push_back(plane.data());
        if (!rows.illuminance.empty()) channels.push_back(rows.illuminance.data());
      }
      writer.write(first, end, channels);
    }
  }
  writer.close();
  check_complete(output, specs.size());
  output.commit();
}

}  // namespace photile::image
