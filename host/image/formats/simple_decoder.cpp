// Formats of few bytes' header, by stb_image.
#include <algorithm>
#include <cstring>

#include "image/formats/formats.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_THREAD_LOCALS
#define STBI_ONLY_BMP
#define STBI_ONLY_GIF
#define STBI_ONLY_TGA
#define STBI_MAX_DIMENSIONS 65536
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace photile::image {
namespace {

/// Bytes for stb_image, which takes the bytes behind the end for zeros.
struct Source {
  Encoded bytes;
  std::size_t place = 0;
  bool beyond = false;  ///< more was needed than there is
  const char* buffer = nullptr;

  int read(char* to, int count) {
    const std::size_t left = bytes.size() - std::min(place, bytes.size());
    const std::size_t taken = std::min(static_cast<std::size_t>(std::max(count, 0)), left);
    // Into its own buffer, the first that it fills, it takes what it gets; elsewhere it needs all.
    if (buffer == nullptr) buffer = to;
    beyond |= count > 0 && (to == buffer ? taken == 0 : taken < static_cast<std::size_t>(count));
    if (taken > 0) std::memcpy(to, bytes.data() + place, taken);
    place += taken;
    return static_cast<int>(taken);
  }
  void skip(int count) {
    const auto there = static_cast<std::int64_t>(place) + count;
    beyond |= there > static_cast<std::int64_t>(bytes.size());
    place = static_cast<std::size_t>(std::max<std::int64_t>(there, 0));
  }
};

constexpr stbi_io_callbacks callbacks{
    [](void* self, char* to, int count) { return static_cast<Source*>(self)->read(to, count); },
    [](void* self, int count) { static_cast<Source*>(self)->skip(count); },
    [](void* self) {
      const auto* source = static_cast<Source*>(self);
      return source->place >= source->bytes.size() ? 1 : 0;
    }};

class SimpleDecoder : public Decoder {
 public:
  explicit SimpleDecoder(Encoded bytes) : bytes_(bytes) {
    Source source{bytes};
    if (stbi_info_from_callbacks(&callbacks, &source, &shape_.width, &shape_.height,
                                 &shape_.channels) == 0 ||
        shape_.width < 1 || shape_.height < 1) {
      throw DecodeError("the header is damaged, or of a kind that is not read");
    }
  }

  Pixels decode() override {
    Source source{bytes_};
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_callbacks(&callbacks, &source, &width, &height, &channels, shape_.channels),
        stbi_image_free);
    if (!pixels) throw DecodeError("the pixels are damaged, or of a kind that is not read");
    if (source.beyond) throw DecodeError("the file ends too early");
    if (width != shape_.width || height != shape_.height) throw DecodeError("the size is damaged");
    return std::vector<std::uint8_t>(pixels.get(), pixels.get() + shape_.values());
  }

 private:
  Encoded bytes_;
};

}  // namespace

std::unique_ptr<Decoder> open_simple(Encoded bytes) {
  return std::make_unique<SimpleDecoder>(bytes);
}

}  // namespace photile::image
