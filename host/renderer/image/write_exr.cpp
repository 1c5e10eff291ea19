#include <algorithm>
#include <utility>

#include "common/output_file.hpp"
#include "image/exr_output.hpp"
#include "photile/layered_picture.hpp"
#include "photile/limits.hpp"

namespace photile {
namespace {

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

void add_planes(const LightRows& rows, std::vector<const float*>& planes) {
  for (const std::vector<float>& plane : rows.rgb) planes.push_back(plane.data());
  if (!rows.illuminance.empty()) planes.push_back(rows.illuminance.data());
}

/// All channels in one part, which every program reads.
void write_single_part(OutputFile& output, const LayeredPicture& picture) {
  std::vector<std::string> names = root_channels;
  for (std::size_t light = 0; light < picture.lights(); ++light) {
    for (std::string& name : picture.channel_names(light)) names.push_back(std::move(name));
  }
  Imf::Header header = image::exr_header(picture.header(), names, Imf::ZIP_COMPRESSION);
  image::add_attributes(picture.header(), header);
  image::ExrOutput file(output, {header});
  for_rows(picture.header().height, [&](int first, int end) {
    const Image root = picture.root(first, end);
    std::vector<LightRows> rows;
    for (std::size_t light = 0; light < picture.lights(); ++light) {
      rows.push_back(picture.read(light, first, end));
    }
    std::vector<const float*> planes;
    add_planes(root, 0, planes);
    for (const LightRows& light : rows) add_planes(light, planes);
    file.write(0, end - first, names, planes);
  });
  file.close();
}

/// The root as the first part, which has the picture's attributes, and each light as a part that
/// bears the name of its layer. Beside the root, which is little beside so many lights, no more
/// than a few rows of one light are in memory.
void write_parts(OutputFile& output, const LayeredPicture& picture) {
  // A row a block. OpenEXR keeps two blocks of each part for each thread until the file is closed:
  // the 16 rows of ZIP would add up to the picture.
  std::vector<std::vector<std::string>> names{root_channels};
  std::vector<Imf::Header> headers{
      image::exr_header(picture.header(), names.front(), Imf::ZIPS_COMPRESSION)};
  image::add_attributes(picture.header(), headers.front());
  headers.front().setName("Combined");
  for (std::size_t light = 0; light < picture.lights(); ++light) {
    names.push_back(picture.channel_names(light));
    const std::string& red = names.back().front();
    headers.push_back(image::exr_header(picture.header(), names.back(), Imf::ZIPS_COMPRESSION));
    headers.back().setName(red.substr(0, red.rfind('.')));
  }
  const Image root = picture.root();
  image::ExrOutput file(output, headers);
  for (std::size_t part = 0; part < headers.size(); ++part) {
    for_rows(picture.header().height, [&](int first, int end) {
      std::vector<const float*> planes;
      LightRows rows;
      if (part == 0) {
        add_planes(root, first, planes);
      } else {
        rows = picture.read(part - 1, first, end);
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
  Imf::Header header = image::exr_header(image, image.channel_names, Imf::ZIP_COMPRESSION);
  image::add_attributes(image, header);
  image::ExrOutput writer(output, {header});
  std::vector<const float*> planes;
  add_planes(image, 0, planes);
  writer.write(0, image.height, image.channel_names, planes);
  writer.close();
}

void write_exr(const std::filesystem::path& file, const LayeredPicture& picture) {
  OutputFile output(file);
  check_pixels(output, picture.header());
  const bool single = picture.lights() <= limits::max_single_part_lights;
  single ? write_single_part(output, picture) : write_parts(output, picture);
}

}  // namespace photile
