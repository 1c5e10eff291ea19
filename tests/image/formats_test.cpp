// Pictures of other formats, read and written.
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <optional>
#include <random>
#include <sstream>
#include <type_traits>

#include "image/decoder.hpp"
#include "memory_meter.hpp"
#include "photile/errors.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"
#include "photile/limits.hpp"
#include "picture_support.hpp"
#include "source_folder.hpp"
#include "temporary_folder.hpp"

namespace photile::test {
namespace {

using OIIO::TypeDesc;

// Every format that is read: the values that other programs read or wrote there, and what damaged
// files come to.

struct Kind {
  const char* file;
  int channels;
  TypeDesc type;
  const char* attribute = nullptr;  ///< "name=value" of the writer
  double precision = 0;             ///< relative, of what it keeps of a value; 0: as its type
};

constexpr double lossy = 1;  ///< its pixels are those of the coder

const std::vector<Kind> kinds{
    {"a.png", 1, TypeDesc::UINT8},
    {"a.png", 2, TypeDesc::UINT8},
    {"a.png", 3, TypeDesc::UINT8},
    {"a.png", 4, TypeDesc::UINT8},
    {"a.png", 3, TypeDesc::UINT16},
    {"a.png", 4, TypeDesc::UINT16},
    {"a.jpg", 1, TypeDesc::UINT8, nullptr, lossy},
    {"a.jpg", 3, TypeDesc::UINT8, nullptr, lossy},
    {"a.jpg", 3, TypeDesc::UINT8, "jpeg:progressive=1", lossy},
    {"a.exr", 3, TypeDesc::HALF, nullptr, 1.0 / 2048},
    {"a.exr", 4, TypeDesc::FLOAT},
    {"a.exr", 1, TypeDesc::FLOAT, "compression=piz"},
    {"a.hdr", 3, TypeDesc::FLOAT, nullptr, 1.0 / 128},
    {"a.tif", 1, TypeDesc::UINT8},
    {"a.tif", 4, TypeDesc::UINT8},
    {"a.tif", 3, TypeDesc::UINT16},
    {"a.tif", 3, TypeDesc::HALF, nullptr, 1.0 / 2048},
    {"a.tif", 3, TypeDesc::FLOAT, "planarconfig=separate"},
    {"a.tif", 1, TypeDesc::DOUBLE},
    {"a.tif", 3, TypeDesc::UINT8, "tile=16"},
    {"a.tif", 3, TypeDesc::FLOAT, "tile=16"},
    {"a.tif", 3, TypeDesc::UINT8, "compression=jpeg", lossy},
    {"a.bmp", 3, TypeDesc::UINT8},
    {"a.bmp", 4, TypeDesc::UINT8},
    {"a.gif", 3, TypeDesc::UINT8, nullptr, lossy},
    {"a.webp", 3, TypeDesc::UINT8, nullptr, lossy},
    {"a.webp", 4, TypeDesc::UINT8, nullptr, lossy},
    {"a.tga", 1, TypeDesc::UINT8},
    {"a.tga", 3, TypeDesc::UINT8},
    {"a.tga", 4, TypeDesc::UINT8},
    {"a.tga", 3, TypeDesc::UINT8, "compression=rle"},
    {"a.ppm", 3, TypeDesc::UINT8},
    {"a.pgm", 1, TypeDesc::UINT8},
    {"a.ppm", 3, TypeDesc::UINT8, "pnm:binary=0"},
};

constexpr int width = 37, height = 21;

/// Smooth, for JPEG, with runs of equal values, for the rest.
std::vector<float> written_values(int channels) {
  std::vector<float> values;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) {
        values.push_back(static_cast<float>(x / 4 + y + 5 * c) / 64.0f);
      }
    }
  }
  return values;
}

std::filesystem::path write(const TemporaryFolder& folder, const Kind& kind) {
  OIIO::ImageSpec spec(width, height, kind.channels, kind.type);
  spec["oiio:UnassociatedAlpha"] = 1;
  if (kind.attribute != nullptr) {
    const std::string attribute = kind.attribute;
    const std::size_t sign = attribute.find('=');
    const std::string name = attribute.substr(0, sign), value = attribute.substr(sign + 1);
    if (name == "tile") {
      spec.tile_width = spec.tile_height = std::stoi(value);
    } else if (value == "0" || value == "1") {
      spec[name] = std::stoi(value);
    } else {
      spec[name] = value;
    }
  }
  const std::vector<float> values = written_values(kind.channels);
  const std::filesystem::path file = folder / kind.file;
  const auto output = OIIO::ImageOutput::create(file.string());
  REQUIRE(output);
  REQUIRE(output->open(file.string(), spec));
  if (spec.tile_width > 0) {
    REQUIRE(output->write_image(TypeDesc::FLOAT, values.data()));
  } else {
    REQUIRE(output->write_scanlines(0, height, 0, TypeDesc::FLOAT, values.data()));
  }
  REQUIRE(output->close());
  return file;
}

std::span<const unsigned char> span_of(const std::string& bytes) {
  return {reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()};
}

/// The decoded values, as shares of the largest of their type.
std::vector<double> shares_of(const image::Pixels& pixels) {
  return std::visit(
      [](const auto& values) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        const double white =
            std::is_same_v<T, float> ? 1.0 : static_cast<double>(std::numeric_limits<T>::max());
        std::vector<double> shares;
        for (const T value : values) shares.push_back(static_cast<double>(value) / white);
        return shares;
      },
      pixels);
}

/// What write_pictures.py says of a picture.
struct Written {
  image::PictureShape shape;
  double tolerance = 0;  ///< a share of the largest value, for real values of themselves
  std::vector<double> values;
};

template <class T>
std::vector<double> values_in(const std::string& bytes, std::size_t count, double white) {
  std::vector<T> values(count);
  REQUIRE(bytes.size() == count * sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  std::vector<double> shares;
  for (const T value : values) shares.push_back(static_cast<double>(value) / white);
  return shares;
}

Written read_written(const std::filesystem::path& file) {
  const std::string text = bytes_of(file);
  const std::size_t end = text.find('\n');
  std::istringstream head(text.substr(0, end));
  Written written;
  std::string sample;
  head >> written.shape.width >> written.shape.height >> written.shape.channels >> sample >>
      written.tolerance;
  const std::string values = text.substr(end + 1);
  const std::size_t count = written.shape.values();
  if (sample == "byte") {
    written.tolerance /= 255;
    written.values = values_in<std::uint8_t>(values, count, 255);
  } else if (sample == "word") {
    written.shape.sample = image::Sample::word;
    written.tolerance /= 65535;
    written.values = values_in<std::uint16_t>(values, count, 65535);
  } else {
    written.shape.sample = image::Sample::real;
    written.values = values_in<float>(values, count, 1);
  }
  return written;
}

/// What any bytes give: a picture, whose values these are, or an error.
std::optional<image::Pixels> picture_of(const std::string& name, const std::string& bytes) {
  try {
    const auto decoder = image::open_picture(name, span_of(bytes));
    const image::PictureShape shape = decoder->shape();
    REQUIRE(shape.width > 0);
    REQUIRE(shape.height > 0);
    REQUIRE(shape.channels > 0);
    if (shape.bytes() > 1 << 20) return std::nullopt;  // what the callers' limits are for
    image::Pixels pixels = decoder->decode();
    std::visit([&](const auto& values) { CHECK(values.size() == shape.values()); }, pixels);
    return pixels;
  } catch (const std::exception& error) {
    CHECK_FALSE(std::string(error.what()).empty());
    return std::nullopt;
  }
}

TEST_CASE("pictures of every format have the values that another library reads in them") {
  const TemporaryFolder folder;
  const std::string script = (source_folder() / "tests/image/write_pictures.py").string();
  if (std::system("/usr/bin/python3 -c 'import PIL' 2> /dev/null") != 0) {
    WARN("skipped: python3-pil is not installed");
    return;
  }
  REQUIRE(std::system(
              ("/usr/bin/python3 '" + script + "' '" + folder.path.string() + "'").c_str()) == 0);
  int pictures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path)) {
    if (entry.path().extension() != ".values") continue;
    const std::filesystem::path file = entry.path().parent_path() / entry.path().stem();
    CAPTURE(file.filename());
    ++pictures;
    const Written expected = read_written(entry.path());
    const std::string bytes = bytes_of(file);
    const auto decoder = image::open_picture(file.string(), span_of(bytes));
    const image::PictureShape shape = decoder->shape();
    REQUIRE(shape.width == expected.shape.width);
    REQUIRE(shape.height == expected.shape.height);
    REQUIRE(shape.channels == expected.shape.channels);
    CHECK(shape.sample == expected.shape.sample);
    const std::vector<double> values = shares_of(decoder->decode());
    REQUIRE(values.size() == expected.values.size());
    // OpenImageIO multiplies a WebP's colours with alpha: what is divided again is rounded, and
    // lost where alpha is 0.
    const bool through_alpha = file.filename() == "alpha.webp";
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      double allowed = 1e-7 * std::abs(expected.values[i]) + expected.tolerance;
      if (through_alpha) {
        const double alpha = 255 * expected.values[i - i % 4 + 3];
        allowed = i % 4 == 3 ? 0 : alpha == 0 ? 1 : (0.5 + 128 / alpha) / 255;
      }
      wrong += std::abs(values[i] - expected.values[i]) > allowed + 1e-12;
    }
    CHECK(wrong == 0);
  }
  CHECK(pictures == 60);
}

TEST_CASE("pictures of every format that keeps them have the values that were written") {
  for (const Kind& kind : kinds) {
    if (kind.precision == lossy) continue;
    CAPTURE(kind.file, kind.channels, kind.type.c_str(),
            kind.attribute != nullptr ? kind.attribute : "");
    const TemporaryFolder folder;
    const std::string bytes = bytes_of(write(folder, kind));
    const auto decoder = image::open_picture(kind.file, span_of(bytes));
    REQUIRE(decoder->shape().width == width);
    REQUIRE(decoder->shape().height == height);
    REQUIRE(decoder->shape().channels == kind.channels);
    const std::vector<double> values = shares_of(decoder->decode());
    const std::vector<float> written = written_values(kind.channels);
    REQUIRE(values.size() == written.size());
    double largest = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double steps = kind.type == TypeDesc::UINT8    ? 255
                           : kind.type == TypeDesc::UINT16 ? 65535
                                                           : 0;
      const double value = double{written[i]};
      const double expected =
          steps > 0 ? std::round(std::clamp(value, 0.0, 1.0) * steps) / steps : value;
      largest = std::max(largest, std::abs(values[i] - expected) - kind.precision * value);
    }
    CHECK(largest < 1e-6);
  }
}

TEST_CASE("a picture that is cut anywhere is refused, or was cut behind its pixels") {
  for (const Kind& kind : kinds) {
    CAPTURE(kind.file, kind.channels, kind.type.c_str());
    const TemporaryFolder folder;
    const std::string whole = bytes_of(write(folder, kind));
    const auto pixels = picture_of(kind.file, whole);
    REQUIRE(pixels);
    for (std::size_t part = 0; part < 64; ++part) {
      CAPTURE(part);
      const auto cut = picture_of(kind.file, whole.substr(0, whole.size() * part / 64));
      CHECK((!cut || *cut == *pixels));
      if (part < 32 && kind.file != std::string("a.tga")) CHECK_FALSE(cut);
    }
  }
}

TEST_CASE("bytes changed at random give a picture or an error") {
  std::mt19937 engine(7);
  for (const Kind& kind : kinds) {
    CAPTURE(kind.file, kind.channels, kind.type.c_str());
    const TemporaryFolder folder;
    const std::string whole = bytes_of(write(folder, kind));
    for (int trial = 0; trial < 200; ++trial) {
      std::string bytes = whole;
      for (int change = 0; change < 1 + trial % 4; ++change) {
        // Half of them in the header, which decides most.
        const std::size_t reach =
            trial % 2 == 0 ? std::min<std::size_t>(64, bytes.size()) : bytes.size();
        bytes[engine() % reach] = static_cast<char>(engine() % 256);
      }
      picture_of(kind.file, bytes);
    }
  }
}

// A damaged file gives an error or a picture, never a crash; the sanitizers preset makes this
// sharp.

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

TEST_CASE("an EXR cut at any 64th of its length is refused") {
  const TemporaryFolder folder;
  const std::string whole = layered_exr();
  REQUIRE(relight_bytes(folder, whole) == Outcome::picture);
  for (std::size_t part = 0; part < 64; ++part) {
    INFO("cut at " << part << "/64");
    CHECK(relight_bytes(folder, whole.substr(0, whole.size() * part / 64)) == Outcome::refused);
  }
}

TEST_CASE("an EXR with one bit flipped gives an error or a picture, 300 times") {
  const TemporaryFolder folder;
  const std::string whole = layered_exr();
  std::mt19937 engine(2026);
  // Half of the flips in the header, where they do most.
  std::uniform_int_distribution<std::size_t> header(0, 1'500), anywhere(0, whole.size() - 1);
  std::uniform_int_distribution<int> bit(0, 7);
  std::array<int, 2> outcomes{};
  for (int flip = 0; flip < 300; ++flip) {
    std::string damaged = whole;
    const std::size_t position = flip % 2 == 0 ? header(engine) : anywhere(engine);
    damaged[position] = static_cast<char>(damaged[position] ^ (1 << bit(engine)));
    INFO("flip " << flip << " at byte " << position);
    ++outcomes[relight_bytes(folder, damaged) == Outcome::picture ? 0 : 1];
  }
  CHECK(outcomes[0] + outcomes[1] == 300);
  CHECK(outcomes[1] > 0);
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
  CHECK(refusal(folder / "tiles.exr").find("smaller ones") != std::string::npos);
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
  CHECK(refusal(folder / "two.exr").find("no text") != std::string::npos);
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

// Radiance's pictures that photile writes.

Image picture_of(int width, int height, float white_luminance) {
  Image picture;
  picture.width = width;
  picture.height = height;
  for (const char* channel : {"R", "G", "B"}) picture.add(channel);
  picture.numbers["whiteLuminance"] = white_luminance;
  return picture;
}

std::string header_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text, line;
  while (std::getline(stream, line) && !line.empty()) text += line + "\n";
  return text;
}

TEST_CASE("a Radiance picture keeps luminance: 179 times the bright of its primaries") {
  const float white = GENERATE(1.0f, 683.0f);
  Image picture = picture_of(5, 2, white);
  const glm::vec3 colours[]{
      {1, 1, 1}, {0.5f, 0.2f, 0.1f}, {0, 0, 3e4f}, {1e-6f, 2e-6f, 0}, {0, 0, 0}};
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      picture.channels[c][5 + i] = colours[i][static_cast<int>(c)];  // the lower row
    }
  }
  const TemporaryFolder folder;
  write_hdr(folder.path / "a.hdr", picture);
  const Image read = read_image(folder.path / "a.hdr");
  REQUIRE(read.width == 5);
  REQUIRE(read.height == 2);
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK((*read.find("R"))[i] == 0);
    const auto value = [&](const char* channel) {
      return static_cast<double>((*read.find(channel))[5 + i]);
    };
    const double luminance = 179 * (0.265 * value("R") + 0.67 * value("G") + 0.065 * value("B"));
    const double truth =
        white * (0.2126 * colours[i].r + 0.7152 * colours[i].g + 0.0722 * colours[i].b);
    CHECK(luminance == Approx(truth).epsilon(0.012));  // 8 bits, rounded down
    if (colours[i].r > 0) {
      CHECK(value("G") / value("R") == Approx(colours[i].g / colours[i].r).epsilon(0.02));
    }
  }
}

TEST_CASE("the view of a Radiance picture is the camera's") {
  Camera camera;
  camera.position = {1, 2, 3};
  camera.vertical_field_of_view = glm::pi<double>();
  camera.projection = Projection::angular;
  CHECK(radiance_view(camera, 64, 64) == "-vta -vp 1 2 3 -vd 0 0 -1 -vu 0 1 0 -vh 180 -vv 180");
  camera.projection = Projection::fisheye;
  CHECK(radiance_view(camera, 64, 64) == "-vth -vp 1 2 3 -vd 0 0 -1 -vu 0 1 0 -vh 180 -vv 180");
  CHECK(radiance_view(camera, 128, 64).empty());  // wider than a hemisphere
  camera.projection = Projection::equirectangular;
  CHECK(radiance_view(camera, 128, 64).empty());
  camera.projection = Projection::orthographic;
  camera.orthographic_height = 3;
  CHECK(radiance_view(camera, 128, 64) == "-vtl -vp 1 2 3 -vd 0 0 -1 -vu 0 1 0 -vh 6 -vv 3");
  camera.projection = Projection::perspective;
  camera.vertical_field_of_view = 0.5 * glm::pi<double>();
  CHECK(radiance_view(camera, 64, 64) == "-vtv -vp 1 2 3 -vd 0 0 -1 -vu 0 1 0 -vh 90 -vv 90");

  Image picture = picture_of(64, 64, 1);
  set_camera_attributes(picture, camera, 64, 64);
  const TemporaryFolder folder;
  write_hdr(folder.path / "a.hdr", picture);
  CHECK_THAT(header_of(folder.path / "a.hdr"),
             Catch::Contains("VIEW= -vtv -vp 1 2 3") && Catch::Contains("FORMAT=32-bit_rle_rgbe"));
}

TEST_CASE("a picture of unknown units is not written in Radiance's") {
  Image picture = picture_of(2, 2, 1);
  picture.numbers.clear();
  const TemporaryFolder folder;
  CHECK_THROWS_AS(write_hdr(folder.path / "a.hdr", picture), InputError);
  CHECK_FALSE(std::filesystem::exists(folder.path / "a.hdr"));
}

/// The 8-bit values that a PNG of one row holds.
std::vector<unsigned char> written_codes(const std::vector<float>& linear) {
  const TemporaryFolder folder;
  Image image;
  image.width = static_cast<int>(linear.size());
  image.height = 1;
  image.add("R") = linear;
  image.add("G") = linear;
  image.add("B") = linear;
  write_png(folder / "a.png", image);
  const auto input = OIIO::ImageInput::open((folder / "a.png").string());
  REQUIRE(input);
  REQUIRE(input->spec().nchannels == 3);
  REQUIRE(input->spec().format == OIIO::TypeDesc::UINT8);
  std::vector<unsigned char> texels(3 * linear.size());
  REQUIRE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, texels.data()));
  std::vector<unsigned char> codes;
  for (std::size_t i = 0; i < linear.size(); ++i) {
    CHECK(texels[3 * i] == texels[3 * i + 1]);
    CHECK(texels[3 * i] == texels[3 * i + 2]);
    codes.push_back(texels[3 * i]);
  }
  return codes;
}

/// IEC 61966-2-1, from encoded to linear: the inverse of what the writer computes.
double decoded(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

TEST_CASE("a PNG holds the nearest sRGB code of every linear value") {
  std::vector<float> linear;
  std::vector<int> expected;
  for (int code = 0; code < 256; ++code) {
    for (const double offset : {-0.49, 0.0, 0.49}) {  // just inside the code's interval
      const double encoded = (code + offset) / 255.0;
      if (encoded < 0.0 || encoded > 1.0) continue;
      linear.push_back(static_cast<float>(decoded(encoded)));
      expected.push_back(code);
    }
  }
  const std::vector<unsigned char> codes = written_codes(linear);
  for (std::size_t i = 0; i < codes.size(); ++i) {
    INFO("linear " << linear[i]);
    CHECK(int{codes[i]} == expected[i]);
  }
}

TEST_CASE("values outside [0,1] and NaN are clamped in a PNG") {
  using Limits = std::numeric_limits<float>;
  const std::vector<unsigned char> codes = written_codes(
      {-1.0f, Limits::quiet_NaN(), -Limits::infinity(), 2.0f, Limits::infinity(), 1.0f});
  CHECK(codes == std::vector<unsigned char>{0, 0, 0, 255, 255, 255});
}

TEST_CASE("a PNG has the same bytes each time and names no time") {
  const TemporaryFolder folder;
  Image image;
  image.width = image.height = 2;
  for (const char* name : {"R", "G", "B"}) image.add(name);
  write_png(folder / "a.png", image);
  write_png(folder / "b.png", image);
  CHECK(bytes_of(folder / "a.png") == bytes_of(folder / "b.png"));
  CHECK(bytes_of(folder / "a.png").find("tIME") == std::string::npos);
}

}  // namespace
}  // namespace photile::test
