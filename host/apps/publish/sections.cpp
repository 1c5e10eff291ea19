#include "publish/sections.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "photile/scene.hpp"

namespace photile::publish {
namespace {

/// Small for numbers near 0 of either sign.
template <class Number>
Number zigzag(std::int64_t difference) {
  return static_cast<Number>(difference < 0 ? -2 * difference - 1 : 2 * difference);
}

/// All first bytes, all second bytes, and so on.
template <class Number>
std::vector<std::uint8_t> byte_planes(std::span<const Number> numbers) {
  std::vector<std::uint8_t> bytes(numbers.size() * sizeof(Number));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (std::size_t plane = 0; plane < sizeof(Number); ++plane) {
      bytes[plane * numbers.size() + i] = static_cast<std::uint8_t>(numbers[i] >> (8 * plane));
    }
  }
  return bytes;
}

/// The prediction of a texel from those to the left, above and at the corner between.
int predicted(int left, int above, int corner) {
  if (corner >= std::max(left, above)) return std::min(left, above);
  if (corner <= std::min(left, above)) return std::max(left, above);
  return left + above - corner;
}

/// Calls code(i, value less its prediction) for each texel of a plane.
template <class Value, class Code>
void for_each_residual(std::size_t count, std::size_t width, const Value& value, const Code& code) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t x = i % width;
    const int left = x > 0 ? value(i - 1) : 0;
    const int above = i >= width ? value(i - width) : 0;
    const int corner = x > 0 && i >= width ? value(i - width - 1) : 0;
    code(i, value(i) - predicted(left, above, corner));
  }
}

}  // namespace

void Sections::add(const std::string& name, std::span<const std::uint8_t> bytes,
                   const char* coding) {
  uLongf size = compressBound(bytes.size());
  std::vector<Bytef> packed(size);
  if (compress2(packed.data(), &size, bytes.data(), bytes.size(), level_) != Z_OK) {
    throw std::bad_alloc();
  }
  table_[name] = {
      {"at", bytes_.size()}, {"packed", size}, {"bytes", bytes.size()}, {"coding", coding}};
  bytes_.append(reinterpret_cast<const char*>(packed.data()), size);
}

void Sections::add_bytes(const std::string& name, std::span<const std::uint8_t> bytes) {
  add(name, bytes, "bytes");
}

void Sections::add_floats(const std::string& name, std::span<const float> numbers) {
  std::vector<std::uint32_t> bits;
  for (const float number : numbers) bits.push_back(std::bit_cast<std::uint32_t>(number));
  add(name, byte_planes<std::uint32_t>(bits), "floats");
}

void Sections::add_words(const std::string& name, std::span<const std::uint16_t> numbers) {
  add(name, byte_planes(numbers), "words");
}

void Sections::add_indices(const std::string& name, std::span<const std::uint32_t> numbers) {
  std::vector<std::uint32_t> steps;
  std::int64_t before = 0;
  for (const std::uint32_t number : numbers) {
    steps.push_back(zigzag<std::uint32_t>(number - before));
    before = number;
  }
  add(name, byte_planes<std::uint32_t>(steps), "indices");
}

double Sections::add_light(const std::string& name, std::span<const glm::vec3> texels,
                           std::size_t width) {
  double brightest = 0;
  for (const glm::vec3& texel : texels) {
    brightest = std::max(brightest, luminance(glm::dvec3(texel)));
  }
  // Luminance, red, blue. Dark texels count as white.
  constexpr int white = chroma_steps / 3;
  std::vector<std::array<int, 3>> codes;
  for (const glm::vec3& texel : texels) {
    const double bright = luminance(glm::dvec3(texel));
    const double place =
        bright > 0 ? std::round(steps_per_octave * (std::log2(bright / brightest) + octaves)) : 0;
    if (!(place > 0)) {
      codes.push_back({0, white, white});
      continue;
    }
    const double sum = double{texel.r} + texel.g + texel.b;
    codes.push_back({static_cast<int>(place),
                     static_cast<int>(std::lround(chroma_steps * texel.r / sum)),
                     static_cast<int>(std::lround(chroma_steps * texel.b / sum))});
  }
  std::vector<std::uint16_t> words(3 * texels.size());
  for (std::size_t plane = 0; plane < 3; ++plane) {
    for_each_residual(
        texels.size(), width, [&](std::size_t i) { return codes[i][plane]; },
        [&](std::size_t i, int residual) {
          words[plane * texels.size() + i] = zigzag<std::uint16_t>(residual);
        });
  }
  add(name, byte_planes<std::uint16_t>(words), "light");
  return brightest;
}

void Sections::add_texture(const std::string& name, std::span<const std::uint8_t> rgba,
                           std::size_t width) {
  const std::size_t count = rgba.size() / 4;
  std::vector<std::uint8_t> bytes(rgba.size());
  constexpr std::size_t green = 1, alpha = 3;
  for (std::size_t plane = 0; plane < 4; ++plane) {
    const auto value = [&](std::size_t i) {
      const int own = rgba[4 * i + plane];
      return plane == green || plane == alpha ? own : (own - rgba[4 * i + green] + 128) & 255;
    };
    for_each_residual(count, width, value, [&](std::size_t i, int residual) {
      bytes[plane * count + i] = static_cast<std::uint8_t>(residual);
    });
  }
  add(name, bytes, "texture");
}

}  // namespace photile::publish
