#include <png.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>

#include "image/formats/formats.hpp"

namespace photile::image {
namespace {

// libpng's frames hold nothing that an exception on its way through them would leave behind.
[[noreturn]] void png_failure(png_structp, png_const_charp reason) { throw DecodeError(reason); }
void png_warning(png_structp, png_const_charp) {}

/// Bytes that libpng may take at once where the file is shorter: texts and profiles are compressed,
/// rows are long.
constexpr std::size_t least_memory_limit = 8'000'000;

/// libpng's own limit is none for texts: it warns, and takes the two gigabytes that one is said to
/// have.
png_voidp limited_memory(png_structp png, png_alloc_size_t bytes) {
  const std::size_t most = *static_cast<const std::size_t*>(png_get_mem_ptr(png));
  return bytes > most ? nullptr : std::malloc(bytes);
}
void free_memory(png_structp, png_voidp memory) { std::free(memory); }

/// libpng's state.
struct PngReader {
  std::size_t most_memory;  ///< bytes, at once
  png_structp png =
      png_create_read_struct_2(PNG_LIBPNG_VER_STRING, nullptr, png_failure, png_warning,
                               &most_memory, limited_memory, free_memory);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;

  explicit PngReader(std::size_t file_bytes)
      : most_memory(std::max(file_bytes, least_memory_limit)) {}
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

class PngDecoder : public Decoder {
 public:
  explicit PngDecoder(Encoded bytes) : rest_(bytes), reader_(bytes.size()) {
    if (info_ == nullptr) throw std::bad_alloc();
    png_set_read_fn(png_, this, [](png_structp png, png_bytep to, std::size_t count) {
      static_cast<PngDecoder*>(png_get_io_ptr(png))->take(to, count);
    });
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // the caller has its own
    png_set_chunk_malloc_max(png_, reader_.most_memory);
    png_read_info(png_, info_);
    png_set_expand(png_);  // palettes, 1 to 4 bits, a transparent colour
    if constexpr (std::endian::native == std::endian::little) png_set_swap(png_);
    passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    shape_ = {static_cast<int>(png_get_image_width(png_, info_)),
              static_cast<int>(png_get_image_height(png_, info_)), png_get_channels(png_, info_),
              png_get_bit_depth(png_, info_) == 16 ? Sample::word : Sample::byte};
  }

  Pixels decode() override {
    if (shape_.sample == Sample::word) return rows<std::uint16_t>();
    return rows<std::uint8_t>();
  }

 private:
  void take(png_bytep to, std::size_t count) {
    if (count > rest_.size()) throw DecodeError("the file ends too early");
    std::memcpy(to, rest_.data(), count);
    rest_ = rest_.subspan(count);
  }

  template <class T>
  std::vector<T> rows() {
    std::vector<T> values(shape_.values());
    const std::size_t stride = values.size() / static_cast<std::size_t>(shape_.height);
    for (int pass = 0; pass < passes_; ++pass) {
      for (std::size_t first = 0; first < values.size(); first += stride) {
        png_read_row(png_, reinterpret_cast<png_bytep>(&values[first]), nullptr);
      }
    }
    png_read_end(png_, nullptr);
    return values;
  }

  Encoded rest_;
  const PngReader reader_;
  const png_structp png_ = reader_.png;
  const png_infop info_ = reader_.info;
  int passes_ = 1;
};

}  // namespace

std::unique_ptr<Decoder> open_png(Encoded bytes) { return std::make_unique<PngDecoder>(bytes); }

}  // namespace photile::image
