#include "pictures/textures.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>

#include "image/decoder.hpp"
#include "image/display.hpp"
#include "image/picture_metadata.hpp"
#include "photile/errors.hpp"
#include "scene/surface_models.hpp"

namespace photile::pictures {

namespace {

using image::PictureShape;

/// An encoded picture, opened and within the limits. What a decoder throws becomes a ResourceError.
class OpenPicture {
 public:
  OpenPicture(const std::string& name, std::span<const unsigned char> bytes) {
    guarded([&] { picture_ = image::open_picture(name, bytes); });
  }

  const PictureShape& shape() const { return picture_->shape(); }
  const image::PictureMetadata& metadata() const { return picture_->metadata(); }
  image::Pixels decode() {
    image::Pixels pixels;
    guarded([&] { pixels = picture_->decode(); });
    return pixels;
  }
  std::vector<float> light() {
    std::vector<float> light;
    guarded([&] { light = picture_->light(); });
    return light;
  }

 private:
  template <class Work>
  static void guarded(const Work& work) {
    try {
      work();
    } catch (const Error&) {  // no picture can be read
      throw;
    } catch (const std::exception& error) {  // a decoder's own, or no memory
      throw files::ResourceError(error.what());
    }
  }

  std::unique_ptr<image::EncodedPicture> picture_;
};

/// Of the textures of a scene together, beyond the expansion of pictures: those of one colour,
/// which are large and hardly take a byte, are common.
constexpr std::uint64_t unchecked_texture_bytes = 1ull << 30;

std::uint64_t bytes_of_texels(int width, int height) {
  return 4 * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
}

std::uint8_t byte_of(float value) {
  const float c = std::isnan(value) ? 0.0f : std::clamp(value, 0.0f, 1.0f);
  return static_cast<std::uint8_t>(c * 255.0f + 0.5f);
}

/// Red, green, blue and alpha of a pixel of 1 (grey), 2 (grey, alpha), 3, 4 or more channels.
/// `alpha` is that of pixels without one.
template <typename T>
std::array<T, 4> rgba(const T* pixel, int channels, T alpha) {
  if (channels < 3) return {pixel[0], pixel[0], pixel[0], channels == 2 ? pixel[1] : alpha};
  return {pixel[0], pixel[1], pixel[2], channels >= 4 ? pixel[3] : alpha};
}

/// Nearest 8 bits of 16.
std::uint8_t byte_of(std::uint16_t value) {
  return static_cast<std::uint8_t>((value * 255u + 32767u) / 65535u);
}

std::vector<std::array<std::uint8_t, 4>> decode(OpenPicture& picture, TextureContent content) {
  const int channels = picture.shape().channels;
  const bool alpha_is_first = content == TextureContent::opacity;
  const bool is_color = content == TextureContent::color || content == TextureContent::srgb;
  const bool real = picture.shape().sample == image::Sample::real;
  const bool own_space = content == TextureContent::color && !picture.metadata().color.is_srgb();
  const auto texels_of = [&](const auto& values) {
    using T = typename std::decay_t<decltype(values)>::value_type;
    std::vector<std::array<std::uint8_t, 4>> texels;
    texels.reserve(values.size() / static_cast<std::size_t>(channels));
    for (std::size_t i = 0; i < values.size(); i += static_cast<std::size_t>(channels)) {
      const T opaque = std::is_same_v<T, float> ? T{1} : std::numeric_limits<T>::max();
      const auto [r, g, b, a] = rgba<T>(&values[i], channels, alpha_is_first ? values[i] : opaque);
      if constexpr (std::is_same_v<T, std::uint8_t>) {
        texels.push_back({r, g, b, a});
      } else if constexpr (std::is_same_v<T, std::uint16_t>) {
        texels.push_back({byte_of(r), byte_of(g), byte_of(b), byte_of(a)});
      } else {
        const auto encoded = [&](float value) {
          return is_color ? image::srgb8_from_linear(value) : byte_of(value);
        };
        texels.push_back({encoded(r), encoded(g), encoded(b), byte_of(a)});
      }
    }
    return texels;
  };
  if (is_color && (real || own_space)) return texels_of(picture.light());
  return std::visit(texels_of, picture.decode());
}

}  // namespace

Texture decode_texture(const std::string& name, std::span<const unsigned char> bytes,
                       TextureContent content, std::uint64_t most_bytes) {
  try {
    OpenPicture picture(name, bytes);
    if (bytes_of_texels(picture.shape().width, picture.shape().height) > most_bytes) {
      throw files::ResourceError(fmt::format(
          "{} x {} texels exceed the limit for pictures of this many bytes; use smaller pictures",
          picture.shape().width, picture.shape().height));
    }
    return Texture(name, picture.shape().width, picture.shape().height, decode(picture, content));
  } catch (const files::ResourceError& error) {
    throw files::ResourceError(fmt::format("texture '{}': {}", name, error.what()));
  }
}

namespace {

RadiancePicture radiance_of(OpenPicture& picture) {
  const PictureShape& shape = picture.shape();
  if (shape.sample != image::Sample::real) {
    throw files::ResourceError("its pixels are not floating-point numbers");
  }
  const std::vector<float> pixels = picture.light();
  const double white = picture.metadata().white_luminance;
  RadiancePicture result{shape.width, shape.height, white > 0, {}};
  const float scale = white > 0 ? static_cast<float>(white) : 1.0f;
  result.texels.reserve(pixels.size() / static_cast<std::size_t>(shape.channels));
  for (std::size_t i = 0; i < pixels.size(); i += static_cast<std::size_t>(shape.channels)) {
    const std::array<float, 4> pixel = rgba(&pixels[i], shape.channels, 1.0f);
    result.texels.push_back(scale * glm::vec3(pixel[0], pixel[1], pixel[2]));
  }
  return result;
}

}  // namespace

RadiancePicture decode_radiance(const std::string& name, std::span<const unsigned char> bytes) {
  OpenPicture picture(name, bytes);
  return radiance_of(picture);
}

RadiancePicture decode_rgbd(const std::string& name, std::span<const unsigned char> bytes) {
  const Texture encoded = decode_texture(name, bytes, TextureContent::srgb);
  RadiancePicture result{encoded.width(), encoded.height(), false, {}};
  const glm::vec2 size(encoded.width(), encoded.height());
  for (int y = 0; y < encoded.height(); ++y) {
    for (int x = 0; x < encoded.width(); ++x) {
      const glm::vec2 middle = (glm::vec2(x, y) + 0.5f) / size;  // the texel itself
      const float alpha = std::max(encoded.sample_data(middle).a, 1.0f / 255.0f);
      result.texels.push_back(encoded.sample(middle) / alpha);
    }
  }
  return result;
}

namespace {

bool is_radiance(const glm::vec3& texel) {
  const auto valid = [](float value) { return std::isfinite(value) && value >= 0.0f; };
  return valid(texel.r) && valid(texel.g) && valid(texel.b);
}

void check_texels(const RadiancePicture& picture) {
  std::size_t wrong = 0, first = 0;
  for (std::size_t i = picture.texels.size(); i-- > 0;) {
    if (is_radiance(picture.texels[i])) continue;
    ++wrong;
    first = i;
  }
  if (wrong == 0) return;
  const auto width = static_cast<std::size_t>(picture.width);
  const glm::vec3& texel = picture.texels[first];
  throw files::ResourceError(fmt::format(
      "{} of {} texels are NaN, infinite or negative, the first at column {}, row {}: ({}, {}, {})",
      wrong, picture.texels.size(), first % width, first / width, texel.r, texel.g, texel.b));
}

}  // namespace

RadiancePicture read_radiance_picture(const std::filesystem::path& file) {
  try {
    const std::vector<unsigned char> bytes =
        files::read_regular_file(file, limits::max_external_bytes);
    OpenPicture opened(file.string(), bytes);
    if (const std::string& projection = opened.metadata().projection; !projection.empty()) {
      throw files::ResourceError("its projection is " + projection);
    }
    RadiancePicture picture = radiance_of(opened);
    check_texels(picture);
    return picture;
  } catch (const files::ResourceError& error) {
    throw InputError(
        fmt::format("{}: cannot use the environment: {}; give an equirectangular .hdr or .exr",
                    file.string(), error.what()));
  }
}

std::uint32_t TextureStore::from_file(const std::string& name, TextureContent content) {
  const Key key(name, content);
  if (const auto found = index_.find(key); found != index_.end()) return found->second;
  return add(key, folder_.read(name));
}

std::uint32_t TextureStore::from_memory(const std::string& name,
                                        std::span<const unsigned char> bytes,
                                        TextureContent content) {
  const Key key(name, content);
  if (const auto found = index_.find(key); found != index_.end()) return found->second;
  return add(key, bytes);
}

std::uint32_t TextureStore::add(const Key& key, std::span<const unsigned char> bytes) {
  ContentHash hash;  // the ending of the name is that of formats without a signature
  hash.add(std::filesystem::path(key.first).extension().string());
  hash.add(key.second);
  hash.add_bytes(bytes.data(), bytes.size());
  const auto [known, is_new] =
      of_content_.try_emplace(hash.digest(), static_cast<std::uint32_t>(scene_.textures.size()));
  if (is_new) {
    encoded_bytes_ += bytes.size();
    const std::uint64_t most =
        unchecked_texture_bytes + limits::max_image_expansion * encoded_bytes_;
    try {
      scene_.textures.push_back(
          decode_texture(key.first, bytes, key.second, most - std::min(most, decoded_bytes_)));
    } catch (...) {
      of_content_.erase(known);
      throw;
    }
    const Texture& texture = scene_.textures.back();
    decoded_bytes_ += bytes_of_texels(texture.width(), texture.height());
  }
  index_.emplace(key, known->second);
  return known->second;
}

void use_missing_texture_colour(Material& material) {
  material.diffuse = glm::vec3(scene::missing_albedo);
  material.diffuse_texture = none;
}

namespace {

constexpr int samples = 4;  ///< of a texel, each way

/// Where a face lies and which way up it is.
struct Face {
  glm::dvec3 forward, up;
};
constexpr std::array<Face, 6> faces{{{{1, 0, 0}, {0, 1, 0}},
                                     {{-1, 0, 0}, {0, 1, 0}},
                                     {{0, 1, 0}, {0, 0, -1}},
                                     {{0, -1, 0}, {0, 0, 1}},
                                     {{0, 0, 1}, {0, 1, 0}},
                                     {{0, 0, -1}, {0, 1, 0}}}};

std::size_t face_towards(const glm::dvec3& direction) {
  const glm::dvec3 size = glm::abs(direction);
  if (size.x >= size.y && size.x >= size.z) return direction.x > 0 ? 0 : 1;
  if (size.y >= size.z) return direction.y > 0 ? 2 : 3;
  return direction.z > 0 ? 4 : 5;
}

}  // namespace

const glm::vec3& radiance_towards(const CubeMap& cube, const glm::dvec3& direction) {
  const std::size_t number = face_towards(direction);
  const Face& face = faces[number];
  const RadiancePicture& picture = cube[number];
  const glm::dvec3 on_face = direction / glm::dot(direction, face.forward);
  const double right = glm::dot(on_face, glm::cross(face.forward, face.up)),
               up = glm::dot(on_face, face.up);
  const auto texel = [&](double from_border) {
    return std::clamp(static_cast<int>(0.5 * from_border * picture.width), 0, picture.width - 1);
  };
  return picture
      .texels[static_cast<std::size_t>(texel(1 - up)) * static_cast<std::size_t>(picture.width) +
              static_cast<std::size_t>(texel(1 + right))];
}

EnvironmentMap environment_of(const CubeMap& cube, const glm::dquat& rotation, std::string name) {
  const int height = 2 * cube[0].width, width = 2 * height;
  std::vector<glm::vec3> texels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const EnvironmentMap places("", width, height, texels);
  const glm::dmat3 to_cube = glm::transpose(glm::mat3_cast(rotation));
  tbb::parallel_for(0, height, [&](int row) {
    for (int column = 0; column < width; ++column) {
      glm::dvec3 sum(0.0);
      for (int i = 0; i < samples * samples; ++i) {
        const double u = (i % samples + 0.5) / samples, v = (i / samples + 0.5) / samples;
        sum +=
            glm::dvec3(radiance_towards(cube, to_cube * places.direction_at(column + u, row, v)));
      }
      texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
             static_cast<std::size_t>(column)] = glm::vec3(sum / double{samples * samples});
    }
  });
  return {std::move(name), width, height, std::move(texels)};
}

}  // namespace photile::pictures
