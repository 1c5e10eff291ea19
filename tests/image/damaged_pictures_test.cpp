// Damaged EXRs are refused; those with bytes changed at random are the corpora of tests/fuzz.
#include <OpenImageIO/imageio.h>

#include <random>

#include "memory_meter.hpp"
#include "photile/layered_picture.hpp"
#include "picture_support.hpp"

namespace photile::test {
namespace {

/// The bytes of an EXR to relight, of a size that takes several blocks.
std::string layered_exr() {
  const TemporaryFolder folder;
  LightMix mix;
  mix.lights = {mixed("window", 5000.0), mixed("lamp", 800.0)};
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

}  // namespace

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
  LightMix mix;
  mix.lights = {mixed("lamp", 800.0)};
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
  const std::string file = (folder / "foreign.exr").string();
  const auto output = OIIO::ImageOutput::create(file);
  REQUIRE(output->open(file, spec));
  REQUIRE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
  REQUIRE(output->close());
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
    const std::string file = (folder / name).string();
    const auto output = OIIO::ImageOutput::create(file);
    REQUIRE(output->open(file, OIIO::ImageSpec(4, 4, 3, OIIO::TypeDesc::UINT8)));
    REQUIRE(output->write_image(OIIO::TypeDesc::UINT8, std::vector<unsigned char>(48, 100).data()));
    REQUIRE(output->close());
    read_image(file);  // what the library keeps is taken once
    const MemoryMeter meter;
    CHECK(read_image(file).pixels() == 16);
    CHECK(meter.peak() < std::size_t{1} << 20);
  }
}

}  // namespace photile::test
