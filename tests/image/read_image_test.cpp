// Pictures that are refused, or read whatever their writer did.
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstring>

#include "photile/limits.hpp"
#include "picture_support.hpp"
#include "srgb_oracle.hpp"

namespace photile::test {
namespace {

using OIIO::TypeDesc;

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
  put(folder / "empty.exr", "");
  CHECK(refusal(folder / "empty.exr").find("empty") != std::string::npos);
  put(folder / "text.exr", "this is no picture\n");
  refusal(folder / "text.exr");
  put(folder / "text.odd", "this is no picture\n");
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

TEST_CASE("tiles that are larger than a small picture are refused before they take memory") {
  const TemporaryFolder folder;
  OIIO::ImageSpec spec(7, 5, 3, OIIO::TypeDesc::FLOAT);
  spec.tile_width = spec.tile_height = 4;
  const auto output = OIIO::ImageOutput::create("exr");
  REQUIRE(output->open((folder / "tiles.exr").string(), spec));
  REQUIRE(output->write_image(OIIO::TypeDesc::FLOAT, std::vector<float>(7 * 5 * 3).data()));
  REQUIRE(output->close());
  CHECK(read_image(folder / "tiles.exr").pixels() == 7 * 5);
  std::string bytes = bytes_of(folder / "tiles.exr");
  const std::string before("tiledesc\0\x09\0\0\0", 13);
  const std::uint32_t sides[2] = {21'764, 1'024};  // 255 MiB, beside OpenEXR's own buffers
  std::memcpy(&bytes[bytes.find(before) + before.size()], sides, sizeof sides);
  put(folder / "tiles.exr", bytes);
  CHECK(refusal(folder / "tiles.exr").find("smaller blocks") != std::string::npos);
}

TEST_CASE("few rows are read, however many their compression takes at a time") {
  const TemporaryFolder folder;
  // 256 rows of DWAB would be 80 MiB.
  OIIO::ImageSpec spec(4'096, 16, 40, OIIO::TypeDesc::HALF);
  for (std::size_t c = 0; c < 40; ++c) spec.channelnames[c] = fmt::format("c{}", c);
  spec.attribute("compression", "dwab");
  const auto output = OIIO::ImageOutput::create("exr");
  REQUIRE(output->open((folder / "strip.exr").string(), spec));
  const std::vector<float> ones(std::size_t{4'096} * 16 * 40, 1.0f);
  REQUIRE(output->write_image(OIIO::TypeDesc::FLOAT, ones.data()));
  REQUIRE(output->close());
  CHECK(read_image(folder / "strip.exr").channels.size() == 40);
}

TEST_CASE("an EXR whose writer ended before it wrote the table of its blocks is read") {
  const TemporaryFolder folder;
  // The picture is so large that bytes and pixels are compared.
  constexpr int width = 4'200, height = 4'100;
  static_assert(std::uint64_t{width} * height * sizeof(float) > limits::unchecked_image_bytes);
  OIIO::ImageSpec spec(width, height, 1, OIIO::TypeDesc::HALF);
  spec.channelnames = {"R"};
  spec.attribute("compression", "none");
  std::vector<float> pixels(std::size_t{width} * height);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<float>(1 + i % 100);
  const auto output = OIIO::ImageOutput::create("exr");
  REQUIRE(output->open((folder / "a.exr").string(), spec));
  REQUIRE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
  REQUIRE(output->close());
  std::string bytes = bytes_of(folder / "a.exr");
  // The table is where a number says that what lies behind as many numbers as rows is a block.
  constexpr std::size_t table_bytes = std::size_t{height} * 8;
  std::size_t table = 0;
  const auto entry = [&] {
    std::uint64_t place = 0;
    std::memcpy(&place, &bytes[table], sizeof place);
    return place;
  };
  while (entry() != table + table_bytes) ++table;
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(table), table_bytes, '\0');
  put(folder / "a.exr", bytes);
  CHECK(same_bits(read_image(folder / "a.exr").channels.at(0), pixels));
}

TEST_CASE("a line end in the name of a part does not get into names of channels") {
  const TemporaryFolder folder;
  write_black(folder / "two.exr", {8, 8}, 8, 1);
  CHECK(read_image(folder / "two.exr").channel_names.back() == "part1.c0");
  std::string bytes = bytes_of(folder / "two.exr");
  bytes[bytes.find("part1") + 3] = '\n';
  put(folder / "two.exr", bytes);
  CHECK(refusal(folder / "two.exr").find("not text") != std::string::npos);
}

TEST_CASE("parts with windows of different sizes lie in the display window of all") {
  const TemporaryFolder folder;
  write_black(folder / "parts.exr", {3, 4}, 3, 1);
  const Image image = read_image(folder / "parts.exr");
  CHECK(image.width == 3);
  REQUIRE(image.channels.size() == 2);
  for (const std::vector<float>& channel : image.channels) CHECK(channel.size() == 9);
}

TEST_CASE("a PNG is read as the light that sRGB makes of its values") {
  const TemporaryFolder folder;
  OIIO::ImageSpec spec(2, 1, 3, OIIO::TypeDesc::UINT8);
  const auto output = OIIO::ImageOutput::create("png");
  const unsigned char texels[6] = {0, 51, 255, 102, 153, 204};
  REQUIRE(output->open((folder / "a.png").string(), spec));
  REQUIRE(output->write_image(OIIO::TypeDesc::UINT8, texels));
  REQUIRE(output->close());
  const Image image = read_image(folder / "a.png");
  CHECK(image.width == 2);
  CHECK((*image.find("G"))[0] == Approx(linear(51)).epsilon(1e-6));
  CHECK((*image.find("B"))[1] == Approx(linear(204)).epsilon(1e-6));
}

}  // namespace photile::test
