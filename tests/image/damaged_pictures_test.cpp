// Damaged EXRs, and those that announce more than they hold, are refused; those with bytes changed
// at random are the corpora of tests/fuzz.
#include <OpenImageIO/imageio.h>

#include "memory_meter.hpp"
#include "photile/layered_picture.hpp"
#include "picture_support.hpp"

namespace photile::test {
namespace {

using namespace std::string_literals;

/// The bytes of an EXR to relight, of a size that takes several blocks.
std::string layered_exr() {
  const TemporaryFolder folder;
  LightMix mix;
  mix.lights = {mixed("window", 5000.0), mixed("lamp", 800.0)};
  write_exr(folder / "a.exr", mix_layers(random_layers(37, 50, {"window", "lamp"}), mix));
  return bytes_of(folder / "a.exr");
}

/// The bytes with another number, `behind` bytes after the size of an attribute.
std::string changed(std::string bytes, const std::string& attribute, std::size_t behind,
                    unsigned value) {
  const std::size_t place = bytes.find(attribute);
  REQUIRE(place != std::string::npos);
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[place + attribute.size() + behind + i] = static_cast<char>(value >> (8 * i));
  }
  return bytes;
}

}  // namespace

TEST_CASE("an EXR that is cut, or announces gigabytes, is refused in a line and takes few") {
  const std::string whole = layered_exr(), window = "dataWindow\0box2i\0"s;
  std::vector<std::string> damaged{changed(whole, window, 12, 1u << 20),  // right
                                   changed(whole, window, 16, 1u << 30),
                                   changed(whole, "photile.lights\0string\0"s, 0, 1u << 30)};
  for (std::size_t part = 0; part < 16; ++part) {
    damaged.push_back(whole.substr(0, whole.size() * part / 16));
  }
  const TemporaryFolder folder;
  for (const std::string& bytes : damaged) {
    CAPTURE(&bytes - damaged.data());
    put(folder / "damaged.exr", bytes);
    const MemoryMeter meter;
    const std::string message =
        message_of<InputError>([&] { relight(read_image(folder / "damaged.exr"), {}); });
    CHECK(message.find("damaged.exr: ") != std::string::npos);
    CHECK(message.find('\n') == std::string::npos);
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
