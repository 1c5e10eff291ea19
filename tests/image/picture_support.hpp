// What the tests of pictures share: files, small layered pictures, bit comparison.
#pragma once

#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "file_bytes.hpp"
#include "image/decoder.hpp"
#include "message_of.hpp"
#include "photile/errors.hpp"
#include "photile/layered_picture.hpp"
#include "temporary_folder.hpp"

namespace photile::test {

inline std::filesystem::path operator/(const TemporaryFolder& folder, const std::string& name) {
  return folder.path / name;
}

inline std::span<const unsigned char> span_of(const std::string& bytes) {
  return {reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()};
}

/// A decoder of bytes, which have to outlive it.
inline auto opened(const std::string& name, const std::string& bytes) {
  return image::open_picture(name, span_of(bytes));
}

/// Equal bit for bit, so that NaN equals itself and 0 differs from -0.
inline bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::bit_cast<std::uint32_t>(a[i]) != std::bit_cast<std::uint32_t>(b[i])) return false;
  }
  return true;
}

/// Layers of random positive radiance and illuminance; the seed is fixed.
inline LightLayers random_layers(int width, int height, const std::vector<std::string>& names) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<float> value(0.01f, 3.0f);
  LightLayers layers;
  layers.width = width;
  layers.height = height;
  for (const std::string& name : names) {
    LightLayers::Layer layer{name, {}, {}};
    for (int pixel = 0; pixel < width * height; ++pixel) {
      const float r = value(engine), g = value(engine), b = value(engine);
      layer.radiance.emplace_back(r, g, b);
      layer.illuminance.push_back(value(engine));
    }
    layers.layers.push_back(std::move(layer));
  }
  return layers;
}

/// Sparse layers in which about one in three lights reaches a pixel.
inline LightLayers random_sparse_layers(int width, int height, std::size_t lights) {
  std::vector<std::string> named;
  for (std::size_t i = 0; i < lights; ++i) named.push_back("light" + std::to_string(i));
  LightLayers layers(width, height, named);
  std::mt19937 engine(8);
  std::uniform_real_distribution<float> value(0.01f, 3.0f);
  for (LightLayers::Row& row : layers.rows) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
      for (std::size_t light = 0; light < lights; ++light) {
        if (engine() % 3 != 0) continue;
        row.light.push_back(static_cast<std::uint16_t>(light));
        row.radiance.emplace_back(value(engine), value(engine), value(engine));
        row.illuminance.push_back(value(engine));
      }
      row.first[x + 1] = static_cast<std::uint32_t>(row.light.size());
    }
  }
  return layers;
}

inline MixedLight mixed(const std::string& name, double power, PowerUnit unit = PowerUnit::lumen) {
  MixedLight light;
  light.name = name;
  light.power = power;
  light.unit = unit;
  return light;
}

}  // namespace photile::test
