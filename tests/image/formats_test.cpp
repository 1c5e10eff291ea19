// Every format that is read: the values that other programs read or wrote there, and what damaged
// files come to.
#include <cstdlib>
#include <cstring>
#include <limits>
#include <optional>
#include <sstream>
#include <type_traits>

#include "image/picture_checks.hpp"
#include "oiio_pictures.hpp"
#include "picture_support.hpp"
#include "source_folder.hpp"

namespace photile::test {
namespace {

using OIIO::TypeDesc;

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
    const auto decoder = opened(name, bytes);
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

}  // namespace

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
    const auto decoder = opened(file.string(), bytes);
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
    const auto decoder = opened(kind.file, bytes);
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

TEST_CASE("what a picture decodes to is bounded by the bytes of its samples") {
  // 16,384 x 16,384 pixels of 16 bytes are 4 GiB, the limit.
  const auto check = [](int channels, image::Sample sample) {
    image::check_shape({16'384, 16'384, channels, sample}, std::size_t{1} << 30);
  };
  for (const auto& [sample, most] : {std::pair(image::Sample::byte, 16),
                                     std::pair(image::Sample::word, 8),
                                     {image::Sample::real, 4}}) {
    CHECK_NOTHROW(check(most, sample));
    CHECK_THROWS_AS(check(most + 1, sample), image::DecodeError);
  }
}

TEST_CASE("a PNG whose text ends beyond the file is refused before libpng takes its memory") {
  using namespace std::string_literals;
  const std::string png =
      "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x8\0\0\0\0\x3a\x7e\x9b\x55\x7f\xff\xff\xfftEXt"s;
  CHECK_THROWS_WITH(opened("a.png", png), "the file ends too early");
}

TEST_CASE("a WebP that is wide and low is read") {
  const TemporaryFolder folder;
  write_by_oiio(folder / "a.webp", OIIO::ImageSpec(1'100, 4, 3, TypeDesc::UINT8),
                std::vector<unsigned char>(1'100 * 4 * 3));
  const std::string bytes = bytes_of(folder / "a.webp");
  CHECK(opened("a.webp", bytes)->shape().width == 1'100);
}

}  // namespace photile::test
