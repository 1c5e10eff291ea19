// Pictures of more lights than one part of an EXR holds: written and relit a few rows at a time.
#include <OpenImageIO/imageio.h>

#include "file_limits.hpp"
#include "memory_meter.hpp"
#include "photile/limits.hpp"
#include "photile/scene.hpp"
#include "picture_support.hpp"

namespace photile::test {
namespace {

constexpr std::size_t many = limits::max_single_part_lights + 1;

/// Every light at a power of its own, some off, one tinted.
LightMix mix_of(const LightLayers& layers) {
  LightMix mix;
  for (const LightLayers::Layer& layer : layers.layers) {
    const std::size_t i = mix.lights.size();
    mix.lights.push_back(mixed(layer.light, i % 7 == 3 ? 0.0 : 0.7 + static_cast<double>(i)));
  }
  mix.lights[1].tint = {0.5f, 1.25f, 0.25f};
  return mix;
}

void check_same_picture(const Image& picture, const Image& expected) {
  CHECK(picture.width == expected.width);
  CHECK(picture.attributes == expected.attributes);
  for (const auto& [name, value] : expected.numbers) CHECK(picture.numbers.at(name) == value);
  CHECK(picture.matrices == expected.matrices);
  REQUIRE(picture.channel_names == expected.channel_names);
  for (std::size_t i = 0; i < picture.channels.size(); ++i) {
    INFO(picture.channel_names[i]);
    CHECK(same_bits(picture.channels[i], expected.channels[i]));
  }
}

/// Every part of a file, as OpenImageIO alone reads it.
std::vector<std::pair<std::string, Image>> parts_of(const std::filesystem::path& file) {
  const auto input = OIIO::ImageInput::open(file.string());
  REQUIRE(input);
  std::vector<std::pair<std::string, Image>> parts;
  for (int part = 0; input->seek_subimage(part, 0); ++part) {
    const OIIO::ImageSpec spec = input->spec();
    auto& [name, image] = parts.emplace_back();
    name = spec.get_string_attribute("oiio:subimagename").str();
    image.width = spec.width;
    image.height = spec.height;
    const auto channels = static_cast<std::size_t>(spec.nchannels);
    std::vector<float> values(image.pixels() * channels);
    REQUIRE(input->read_image(part, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data()));
    for (std::size_t c = 0; c < channels; ++c) {
      std::vector<float>& plane = image.add(spec.channelnames[c]);
      for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = values[i * channels + c];
    }
    if (spec.find_attribute("photile.lights")) image.attributes["photile.lights"] = "present";
  }
  return parts;
}

/// Lights of which `reached` light each pixel, next to each other in number.
LightLayers local_layers(int width, int height, std::size_t lights, std::size_t reached) {
  LightLayers layers = random_sparse_layers(1, 1, lights);  // for the names
  layers.width = width;
  layers.height = height;
  layers.rows.assign(static_cast<std::size_t>(height), {});
  for (LightLayers::Row& row : layers.rows) {
    row.first.push_back(0);
    for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
      const std::size_t first = x * (lights - reached) / static_cast<std::size_t>(width);
      for (std::size_t light = first; light < first + reached; ++light) {
        row.light.push_back(static_cast<std::uint16_t>(light));
        row.radiance.emplace_back(0.5f, 0.25f, 0.125f);
        row.illuminance.push_back(2.0f);
      }
      row.first.push_back(static_cast<std::uint32_t>(row.light.size()));
    }
  }
  return layers;
}

}  // namespace

TEST_CASE("a streamed picture of few lights has the bytes of one that was whole in memory") {
  const TemporaryFolder folder;
  for (const std::size_t lights : {std::size_t{2}, limits::max_single_part_lights}) {
    const LightLayers sparse = random_sparse_layers(9, 70, lights);
    const LightLayers layers = lights <= max_dense_lights ? sparse.dense() : sparse;
    write_exr(folder / "streamed.exr", *mixed_picture(layers, mix_of(layers)));
    write_exr(folder / "whole.exr", mix_layers(layers, mix_of(layers)));
    CHECK(bytes_of(folder / "streamed.exr") == bytes_of(folder / "whole.exr"));
    CHECK(parts_of(folder / "streamed.exr").size() == 1);
  }
}

TEST_CASE("a picture of many lights is a part for the root and one for each light") {
  const TemporaryFolder folder;
  const std::size_t lights = GENERATE(as<std::size_t>(), many, 300);
  const LightLayers layers = random_sparse_layers(5, 70, lights);
  const LightMix mix = mix_of(layers);
  const Image whole = mix_layers(layers.dense(), mix);
  write_exr(folder / "a.exr", *mixed_picture(layers, mix));
  const auto parts = parts_of(folder / "a.exr");
  REQUIRE(parts.size() == 1 + lights);
  CHECK(parts[0].first == "Combined");
  CHECK(parts[0].second.channel_names == std::vector<std::string>{"R", "G", "B", "A"});
  CHECK(parts[0].second.attributes.contains("photile.lights"));
  std::size_t channels = 0;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const auto& [name, image] = parts[part];
    if (part > 0) {
      CHECK(name == "Combined_" + mix.lights[part - 1].name);
      CHECK(image.channel_names.size() == 4);
      CHECK(image.attributes.empty());
    }
    for (std::size_t i = 0; i < image.channel_names.size(); ++i, ++channels) {
      REQUIRE(whole.find(image.channel_names[i]) != nullptr);
      CHECK(same_bits(image.channels[i], *whole.find(image.channel_names[i])));
    }
  }
  CHECK(channels == whole.channels.size());
}

TEST_CASE("a file of many lights is relit as the same picture in memory is") {
  const TemporaryFolder folder;
  const LightLayers layers = random_sparse_layers(5, 70, many);
  const LightMix mix = mix_of(layers);
  const auto mixed = mixed_picture(layers, mix);
  mixed->header().attributes["photile.scene"] = "hall.gltf";
  mixed->header().matrices["worldToCamera"] = {1, 2, 3};
  write_exr(folder / "a.exr", *mixed);
  const Image whole = to_image(*mixed);
  const std::vector<LightChange> changes{{"light0", "x0.3"},
                                         {"light1", "#ff8800"},
                                         {"light2", "off"},
                                         {"light3", "off"},
                                         {"light64", "17lm"}};
  const Image expected = relight(whole, changes);
  check_same_picture(to_image(*relit_picture(folder / "a.exr", {})), whole);
  check_same_picture(to_image(*relit_picture(folder / "a.exr", changes)), expected);

  write_exr(folder / "b.exr", *relit_picture(folder / "a.exr", changes));
  check_same_picture(to_image(*relit_picture(folder / "b.exr", {})), expected);
  const LightMix read = read_light_mix(read_header(folder / "b.exr"));
  REQUIRE(read.lights.size() == many);
  CHECK(read.lights[64].power == 17.0);
  CHECK_THROWS_AS(relit_picture(folder / "a.exr", {{"light3", "x2"}, {"light3", "5lm"}}),
                  UsageError);
}

TEST_CASE("more channels than a picture in memory may have are relit, but not read at once") {
  const TemporaryFolder folder;
  const LightLayers layers = random_sparse_layers(3, 2, 300);
  write_exr(folder / "a.exr", *mixed_picture(layers, mix_of(layers)));
  CHECK(read_header(folder / "a.exr").channel_names.size() == 4 + 4 * 300);
  const std::string message = message_of<InputError>([&] { read_image(folder / "a.exr"); });
  CHECK(message.find("1204 channels") != std::string::npos);
  check_same_picture(to_image(*relit_picture(folder / "a.exr", {})),
                     mix_layers(layers, mix_of(layers)));
}

TEST_CASE("a relit picture may replace the file of many lights that it is read from") {
  const TemporaryFolder folder;
  const LightLayers layers = random_sparse_layers(3, 2, many);
  write_exr(folder / "a.exr", *mixed_picture(layers, mix_of(layers)));
  const Image expected = relight(mix_layers(layers, mix_of(layers)), {{"light5", "x2"}});
  write_exr(folder / "a.exr", *relit_picture(folder / "a.exr", {{"light5", "x2"}}));
  check_same_picture(to_image(*relit_picture(folder / "a.exr", {})), expected);
}

TEST_CASE("every limit of the space gives an error or the whole file of many lights") {
  const TemporaryFolder folder;
  const LightLayers layers = random_sparse_layers(8, 5, many);
  const auto picture = mixed_picture(layers, mix_of(layers));
  write_exr(folder / "a.exr", *picture);
  const std::string whole = bytes_of(folder / "a.exr");
  std::filesystem::remove(folder / "a.exr");
  std::vector<std::size_t> sizes{whole.size() - 1, whole.size() - 20};
  for (std::size_t bytes = 0; bytes < whole.size(); bytes += whole.size() / 50) {
    sizes.push_back(bytes);
  }
  for (const std::size_t bytes : sizes) {
    CAPTURE(bytes, whole.size());
    const FileSizeLimit limit(bytes);
    const std::string message =
        message_of<OutputError>([&] { write_exr(folder / "a.exr", *picture); });
    CHECK(message.find("a.exr") != std::string::npos);
    CHECK(message.find(".tmp") == std::string::npos);
    CHECK(message.find("free space") != std::string::npos);
    CHECK(files_in(folder.path) == 0);
  }
  put(folder / "a.exr", "earlier");
  {
    const FileSizeLimit limit(whole.size() / 2);
    CHECK_THROWS_AS(write_exr(folder / "a.exr", *picture), OutputError);
  }
  CHECK(bytes_of(folder / "a.exr") == "earlier");
  write_exr(folder / "a.exr", *picture);
  CHECK(bytes_of(folder / "a.exr") == whole);
}

TEST_CASE(
    "a file of many lights that is cut anywhere is refused, and what it was to replace kept") {
  const TemporaryFolder folder;
  const LightLayers layers = random_sparse_layers(8, 70, many);
  write_exr(folder / "a.exr", *mixed_picture(layers, mix_of(layers)));
  const std::string whole = bytes_of(folder / "a.exr");
  put(folder / "relit.exr", "earlier");
  for (std::size_t part = 0; part < 16; ++part) {
    INFO("cut at " << part << "/16");
    put(folder / "cut.exr", whole.substr(0, whole.size() * part / 16));
    const std::string message = message_of<InputError>(
        [&] { write_exr(folder / "relit.exr", *relit_picture(folder / "cut.exr", {})); });
    CHECK(message.find("cut.exr") != std::string::npos);
    CHECK(bytes_of(folder / "relit.exr") == "earlier");
    CHECK(files_in(folder.path) == 3);
  }
}

TEST_CASE("the picture of 256 lights is never whole in memory, neither written nor relit") {
  const TemporaryFolder folder;
  constexpr int width = 96, height = 384;
  constexpr std::size_t lights = 256;
  const LightLayers layers = local_layers(width, height, lights, 2);
  const LightMix mix = mix_of(layers);
  constexpr std::size_t dense = lights * 16 * width * height;
  // Each thread compresses or decodes two rows of every part; a quarter leaves room for 48 threads.
  constexpr std::size_t bound = dense / 4;
  {
    const MemoryMeter meter;
    write_exr(folder / "a.exr", *mixed_picture(layers, mix));
    CHECK(meter.peak() > std::size_t{16} * width * height);  // the root, so that the meter counts
    CHECK(meter.peak() < bound);
  }
  const MemoryMeter meter;
  write_exr(folder / "b.exr", *relit_picture(folder / "a.exr", {{"light7", "x2"}}));
  CAPTURE(meter.peak(), dense);
  CHECK(meter.peak() < bound);
}

TEST_CASE("of few lights the root is never whole in memory either") {
  const TemporaryFolder folder;
  constexpr int width = 128, height = limits::max_image_side;
  const LightLayers layers = local_layers(width, height, 2, 1);
  const MemoryMeter meter;
  write_exr(folder / "a.exr", *mixed_picture(layers, mix_of(layers)));
  CHECK(meter.peak() < std::size_t{16} * width * height / 2);
}

}  // namespace photile::test
