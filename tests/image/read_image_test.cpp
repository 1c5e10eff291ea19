#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>

#include "photile/limits.hpp"
#include "picture_support.hpp"

namespace photile::test {
namespace {

std::string refusal(const std::filesystem::path& file) {
  const std::string message = message_of<InputError>([&] { read_image(file); });
  CHECK(message.find(file.filename().string()) != std::string::npos);
  return message;
}

/// Black parts of width[i] x height pixels. Only the first rows are written: what the header says
/// is enough for a refusal, and gigabytes of black take long to write.
void write_black(const std::filesystem::path& file, const std::vector<int>& widths, int height,
                 int channels) {
  std::vector<OIIO::ImageSpec> specs;
  for (const int width : widths) {
    OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::HALF);
    spec.full_width = widths.front();  // OpenEXR wants one display window for all parts
    for (int c = 0; c < channels; ++c) {
      spec.channelnames[static_cast<std::size_t>(c)] = fmt::format("c{}", c);
    }
    spec.attribute("oiio:subimagename", fmt::format("part{}", specs.size()));
    spec.attribute("compression", "zip");
    specs.push_back(spec);
  }
  const auto output = OIIO::ImageOutput::create(file.string());
  REQUIRE(output->open(file.string(), static_cast<int>(specs.size()), specs.data()));
  for (std::size_t part = 0; part < specs.size(); ++part) {
    if (part > 0) {
      REQUIRE(output->open(file.string(), specs[part], OIIO::ImageOutput::AppendSubimage));
    }
    const std::vector<float> row(static_cast<std::size_t>(specs[part].width * channels), 0.0f);
    for (int y = 0; y < std::min(height, 16); ++y) {
      REQUIRE(output->write_scanline(y, 0, OIIO::TypeDesc::FLOAT, row.data()));
    }
  }
  REQUIRE(output->close());
}

}  // namespace

TEST_CASE("what is no picture is refused in one line that names the file") {
  const TemporaryFolder folder;
  CHECK(refusal(folder / "missing.exr").find("no such file") != std::string::npos);
  write_bytes(folder / "empty.exr", "");
  CHECK(refusal(folder / "empty.exr").find("empty") != std::string::npos);
  write_bytes(folder / "text.exr", "this is no picture\n");
  refusal(folder / "text.exr");
  write_bytes(folder / "text.odd", "this is no picture\n");
  refusal(folder / "text.odd");
  std::filesystem::create_directory(folder / "folder.exr");
  CHECK(refusal(folder / "folder.exr").find("not a regular file") != std::string::npos);
  REQUIRE(::mkfifo((folder / "fifo.exr").c_str(), 0600) == 0);
  refusal(folder / "fifo.exr");  // opening it would wait for ever
}

TEST_CASE("a picture beyond a limit is refused before it is decoded") {
  const TemporaryFolder folder;
  write_black(folder / "wide.exr", {limits::max_image_side + 1}, 1, 1);
  CHECK(refusal(folder / "wide.exr").find(std::to_string(limits::max_image_side)) !=
        std::string::npos);
  write_black(folder / "many.exr", {2}, 2, limits::max_image_channels + 1);
  CHECK(refusal(folder / "many.exr").find("channels") != std::string::npos);
  // 13,000 x 13,000 x 7 floats are 4.7 GB.
  write_black(folder / "bomb.exr", {13'000}, 13'000, 7);
  CHECK(refusal(folder / "bomb.exr").find("limit") != std::string::npos);
}

TEST_CASE("parts of different sizes are refused") {
  const TemporaryFolder folder;
  write_black(folder / "parts.exr", {3, 4}, 3, 1);
  CHECK(refusal(folder / "parts.exr").find("one size") != std::string::npos);
}

TEST_CASE("a PNG is read as the values that it stores, divided by 255") {
  const TemporaryFolder folder;
  OIIO::ImageSpec spec(2, 1, 3, OIIO::TypeDesc::UINT8);
  const auto output = OIIO::ImageOutput::create("png");
  const unsigned char texels[6] = {0, 51, 255, 102, 153, 204};
  REQUIRE(output->open((folder / "a.png").string(), spec));
  REQUIRE(output->write_image(OIIO::TypeDesc::UINT8, texels));
  REQUIRE(output->close());
  const Image image = read_image(folder / "a.png");
  CHECK(image.width == 2);
  CHECK((*image.find("G"))[0] == Approx(0.2).epsilon(1e-6));
  CHECK((*image.find("B"))[1] == Approx(0.8).epsilon(1e-6));
}

}  // namespace photile::test
