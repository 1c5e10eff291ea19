// Damaged EXRs are refused; those with bytes changed at random are the corpora of tests/fuzz.
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstring>

#include "memory_meter.hpp"
#include "oiio_pictures.hpp"
#include "photile/limits.hpp"
#include "picture_support.hpp"
#include "srgb_oracle.hpp"

namespace photile::test {
namespace {

/// The bytes of an EXR to relight, of a size that takes several blocks.
std::string layered_exr() {
  const TemporaryFolder folder;
  LightMix mix{{mixed("window", 5000.0), mixed("lamp", 800.0)}};
  write_exr(folder / "a.exr", mix_layers(random_layers(37, 50, {"window", "lamp"}), mix));
  return bytes_of(folder / "a.exr");
}

enum class Outcome { picture, refused };

Outcome relight_bytes(const TemporaryFolder& folder, const std::string& bytes) {
  put(folder / "damaged.exr", bytes);
  try {
    const Image relit = relight(read_image(folder / "damaged.exr"), {{"lamp", "x2"}});
    for (const std::vector<float>& plane : relit.channels) {
      CHECK(plane.size() == static_cast<std::size_t>(relit.width) * relit.height);
    }
    return Outcome::picture;
  } catch (const Error& error) {
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
    return Outcome::refused;
  }
}

TEST_CASE("an EXR cut at any 64th of its length is refused") {
  const TemporaryFolder folder;
  const std::string whole = layered_exr();
  REQUIRE(relight_bytes(folder, whole) == Outcome::picture);
  for (std::size_t part = 0; part < 64; ++part) {
    INFO("cut at " << part << "/64");
    CHECK(relight_bytes(folder, whole.substr(0, whole.size() * part / 64)) == Outcome::refused);
  }
}

TEST_CASE("an EXR whose window is not that of its pixels is refused, not read as black") {
  using namespace std::string_literals;
  const TemporaryFolder folder;
  LightMix mix{{mixed("lamp", 800.0)}};
  write_exr(folder / "small.exr", mix_layers(LightLayers(8, 8, std::vector{"lamp"s}), mix));
  // Several blocks, of which the window has one; and a single block of either.
  for (std::string bytes : {layered_exr(), bytes_of(folder / "small.exr")}) {
    const std::string attribute = "dataWindow\0box2i\0\x10\0\0\0"s;
    const std::size_t place = bytes.find(attribute);
    REQUIRE(place != std::string::npos);
    bytes.replace(place + attribute.size(), 16, "\0\0\0\0\0\0\0\0\xFF\x3F\0\0\x01\0\0\0"s);
    put(folder / "wide.exr", bytes);
    CHECK_THROWS_WITH(read_image(folder / "wide.exr"), Catch::Contains("damaged"));
  }
}

/// 40 x 40 pixels of one grey, which every compression makes small, or of noise, which none does.
std::string foreign_exr(const std::string& compression, int tile, bool noise) {
  const TemporaryFolder folder;
  OIIO::ImageSpec spec(40, 40, 3, OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", compression);
  spec.tile_width = spec.tile_height = tile;
  std::vector<float> pixels(40 * 40 * 3, 0.5f);
  std::mt19937 random(1);
  if (noise) {
    for (float& value : pixels) value = std::uniform_real_distribution<float>(0, 1)(random);
  }
  write_by_oiio(folder / "foreign.exr", spec, pixels);
  return bytes_of(folder / "foreign.exr");
}

TEST_CASE("an EXR whose window is a little wider or higher than its pixels is refused") {
  using namespace std::string_literals;
  const std::string compression = GENERATE("none", "rle", "zips", "zip");
  const int tile = GENERATE(0, 16);
  const bool noise = GENERATE(false, true);
  CAPTURE(compression, tile, noise);
  const TemporaryFolder folder;
  const std::string whole = foreign_exr(compression, tile, noise);
  put(folder / "whole.exr", whole);
  CHECK_NOTHROW(read_image(folder / "whole.exr"));
  for (const auto& [right, bottom] : {std::pair{40, 39}, {44, 39}, {39, 44}}) {
    // With a row to a block, more rows are more entries of the table, which is another error.
    std::string bytes = whole;
    for (const std::string& name : {"dataWindow\0box2i\0"s, "displayWindow\0box2i\0"s}) {
      const std::size_t place = bytes.find(name);
      REQUIRE(place != std::string::npos);
      bytes[place + name.size() + 12] = static_cast<char>(right);
      bytes[place + name.size() + 16] = static_cast<char>(bottom);
    }
    put(folder / "changed.exr", bytes);
    CAPTURE(right, bottom);
    CHECK_THROWS_WITH(read_image(folder / "changed.exr"), Catch::Contains("changed.exr"));
  }
}

TEST_CASE("a small EXR that announces gigabytes is refused without taking them") {
  using namespace std::string_literals;
  const TemporaryFolder folder;
  const std::string whole = layered_exr();
  const auto changed = [&](const std::string& attribute, std::size_t behind, unsigned value) {
    std::string bytes = whole;
    const std::size_t place = bytes.find(attribute);
    REQUIRE(place != std::string::npos);
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[place + attribute.size() + behind + i] = static_cast<char>(value >> (8 * i));
    }
    return bytes;
  };
  std::vector<std::string> damaged;
  for (const unsigned side : {16'000u, 1u << 20, 1u << 30}) {
    if (side > 16'000u) damaged.push_back(changed("dataWindow\0box2i\0"s, 12, side));  // right
    damaged.push_back(changed("dataWindow\0box2i\0"s, 16, side));                      // bottom
    damaged.push_back(changed("photile.lights\0string\0"s, 0, side));                  // size
  }
  // OpenEXR reads by the type: what follows would begin where nobody has looked.
  damaged.push_back(changed("lineOrder\0lineOrder\0"s, 0, 9));
  damaged.push_back(changed("compression\0compression\0"s, 0, 2));
  damaged.push_back(changed("channels\0chlist\0"s, 0, 18));
  // A list of texts, one of which is to have 1.8 GB.
  damaged.push_back(whole);
  damaged.back().insert(8, "x\0stringvector\0\x08\0\0\0\0\0\0\x70text"s);
  for (const std::string& bytes : damaged) {
    CAPTURE(&bytes - damaged.data());
    put(folder / "damaged.exr", bytes);
    const MemoryMeter meter;
    CHECK_THROWS_AS(relit_picture(folder / "damaged.exr", {}), InputError);
    CHECK(meter.peak() < std::size_t{256} << 20);
  }
}

TEST_CASE(
    "a small picture takes little memory to read, in any format that is stored as it is read") {
  const TemporaryFolder folder;
  for (const std::string name : {"a.png", "a.tif", "a.bmp", "a.webp"}) {
    CAPTURE(name);
    write_by_oiio(folder / name, OIIO::ImageSpec(4, 4, 3, OIIO::TypeDesc::UINT8),
                  std::vector<unsigned char>(48, 100));
    read_image(folder / name);  // what the library keeps is taken once
    const MemoryMeter meter;
    CHECK(read_image(folder / name).pixels() == 16);
    CHECK(meter.peak() < std::size_t{1} << 20);
  }
}

// Pictures that are refused, or read whatever their writer did.

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
  write_by_oiio(folder / "tiles.exr", spec, std::vector<float>(7 * 5 * 3));
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
  write_by_oiio(folder / "strip.exr", spec, std::vector<float>(std::size_t{4'096} * 16 * 40, 1.0f));
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
  write_by_oiio(folder / "a.exr", spec, pixels);
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
  write_by_oiio(folder / "a.png", OIIO::ImageSpec(2, 1, 3, OIIO::TypeDesc::UINT8),
                std::vector<unsigned char>{0, 51, 255, 102, 153, 204});
  const Image image = read_image(folder / "a.png");
  CHECK(image.width == 2);
  CHECK((*image.find("G"))[0] == Approx(linear(51)).epsilon(1e-6));
  CHECK((*image.find("B"))[1] == Approx(linear(204)).epsilon(1e-6));
}

}  // namespace
}  // namespace photile::test
