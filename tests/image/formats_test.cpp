// Every format that is read, against files that OpenImageIO writes and its readings of them.
#include <OpenImageIO/imageio.h>

#include <limits>
#include <optional>
#include <random>
#include <type_traits>

#include "image/decoder.hpp"
#include "picture_support.hpp"

namespace photile::test {
namespace {

using OIIO::TypeDesc;

struct Kind {
  const char* file;
  int channels;
  TypeDesc type;
  const char* attribute = nullptr;  ///< "name=value" of the writer
};

const std::vector<Kind> kinds{
    {"a.png", 1, TypeDesc::UINT8},
    {"a.png", 2, TypeDesc::UINT8},
    {"a.png", 3, TypeDesc::UINT8},
    {"a.png", 4, TypeDesc::UINT8},
    {"a.png", 3, TypeDesc::UINT16},
    {"a.png", 4, TypeDesc::UINT16},
    {"a.jpg", 1, TypeDesc::UINT8},
    {"a.jpg", 3, TypeDesc::UINT8},
    {"a.jpg", 3, TypeDesc::UINT8, "jpeg:progressive=1"},
    {"a.exr", 3, TypeDesc::HALF},
    {"a.exr", 4, TypeDesc::FLOAT},
    {"a.exr", 1, TypeDesc::FLOAT, "compression=piz"},
    {"a.hdr", 3, TypeDesc::FLOAT},
    {"a.tif", 1, TypeDesc::UINT8},
    {"a.tif", 4, TypeDesc::UINT8},
    {"a.tif", 3, TypeDesc::UINT16},
    {"a.tif", 3, TypeDesc::HALF},
    {"a.tif", 3, TypeDesc::FLOAT, "planarconfig=separate"},
    {"a.tif", 1, TypeDesc::DOUBLE},
    {"a.tif", 3, TypeDesc::UINT8, "tile=16"},
    {"a.tif", 3, TypeDesc::FLOAT, "tile=16"},
    {"a.tif", 3, TypeDesc::UINT8, "compression=jpeg"},
    {"a.bmp", 3, TypeDesc::UINT8},
    {"a.bmp", 4, TypeDesc::UINT8},
    {"a.gif", 3, TypeDesc::UINT8},
    {"a.webp", 3, TypeDesc::UINT8},
    {"a.webp", 4, TypeDesc::UINT8},
    {"a.tga", 1, TypeDesc::UINT8},
    {"a.tga", 3, TypeDesc::UINT8},
    {"a.tga", 4, TypeDesc::UINT8},
    {"a.tga", 3, TypeDesc::UINT8, "compression=rle"},
    {"a.ppm", 3, TypeDesc::UINT8},
    {"a.pgm", 1, TypeDesc::UINT8},
    {"a.ppm", 3, TypeDesc::UINT8, "pnm:binary=0"},
};

constexpr int width = 37, height = 21;

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
  // Smooth, for JPEG, with runs of equal values, for the rest.
  std::vector<float> values;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < kind.channels; ++c) {
        values.push_back(static_cast<float>(x / 4 + y + 5 * c) / 64.0f);
      }
    }
  }
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

std::vector<double> decoded(const std::string& name, const std::string& bytes) {
  const auto decoder = image::open_picture(name, span_of(bytes));
  const image::PictureShape shape = decoder->shape();
  REQUIRE(shape.width == width);
  REQUIRE(shape.height == height);
  return std::visit(
      [&](const auto& values) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        CHECK(values.size() == shape.values());
        const double white =
            std::is_same_v<T, float> ? 1.0 : static_cast<double>(std::numeric_limits<T>::max());
        std::vector<double> result;
        for (const T value : values) result.push_back(static_cast<double>(value) / white);
        return result;
      },
      decoder->decode());
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

}  // namespace

TEST_CASE("every format holds the values that OpenImageIO reads in it") {
  for (const Kind& kind : kinds) {
    CAPTURE(kind.file, kind.channels, kind.type.c_str(),
            kind.attribute != nullptr ? kind.attribute : "");
    const TemporaryFolder folder;
    const std::filesystem::path file = write(folder, kind);
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;
    const auto input = OIIO::ImageInput::open(file.string(), &config);
    REQUIRE(input);
    const auto channels = static_cast<std::size_t>(input->spec().nchannels);
    std::vector<float> expected(channels * width * height);
    REQUIRE(
        input->read_image(0, 0, 0, static_cast<int>(channels), TypeDesc::FLOAT, expected.data()));
    const std::vector<double> values = decoded(kind.file, bytes_of(file));
    REQUIRE(values.size() == expected.size());
    // OpenImageIO multiplies a WebP's colours by alpha, rounding twice.
    const bool times_alpha = kind.file == std::string("a.webp") && channels == 4;
    double largest = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double alpha = times_alpha && i % 4 < 3 ? values[i - i % 4 + 3] : 1.0;
      largest = std::max(largest, std::abs(values[i] * alpha - double{expected[i]}));
    }
    CHECK(largest < (times_alpha ? 2.0 / 255 : 1e-6));
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

}  // namespace photile::test
