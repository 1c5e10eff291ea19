// Encoded pictures, opened: their size first, then their pixels.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace photile::image {

/// A picture that is damaged or of no format that is read. `what()` is the reason alone.
struct DecodeError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

using Encoded = std::span<const unsigned char>;

/// What OpenImageIO calls the reader of a picture's format: by its signature, or else by the
/// extension of the few formats without one.
/// Errors: DecodeError where it is no format that is read.
const char* reader_of(const std::string& name, Encoded bytes);

/// How the values of a picture are stored.
enum class Sample { byte, word, real };

struct PictureShape {
  int width = 0, height = 0;
  int channels = 0;  ///< 1: grey, 2: grey and alpha, 3: RGB, 4: RGBA; others: an EXR's first ones
  Sample sample = Sample::byte;

  std::uint64_t values() const {
    return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) *
           static_cast<std::uint64_t>(channels);
  }
  std::uint64_t bytes() const {
    return values() * (sample == Sample::byte ? 1 : sample == Sample::word ? 2 : 4);
  }
};

/// Rows x width x channels, with the values as they are stored: no curve is undone, no colour
/// multiplied with alpha. The alternative is that of PictureShape::sample.
using Pixels =
    std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>>;

/// The pixels of a file in the order in which it has them.
class Decoder {
 public:
  virtual ~Decoder() = default;

  /// The shape as the header has it.
  const PictureShape& shape() const { return shape_; }

  /// Once. Errors: DecodeError, std::bad_alloc.
  virtual Pixels decode() = 0;

 protected:
  PictureShape shape_;
};

struct PictureMetadata;

/// A picture in its place: upright, row 0 at the top.
class EncodedPicture {
 public:
  /// As open_picture.
  EncodedPicture(const std::string& name, Encoded bytes);
  ~EncodedPicture();

  const PictureShape& shape() const { return shape_; }
  const PictureMetadata& metadata() const { return *metadata_; }

  /// Once: the values as they are stored, for what is no colour. Errors: DecodeError,
  /// std::bad_alloc.
  Pixels decode();

  /// Once: linear Rec.709, and alpha as it is. A picture of real values has been multiplied with
  /// what its header says; integers are fractions of the largest, freed of their transfer curve.
  /// Errors: those of decode(); DecodeError where the picture's colour space is not read.
  std::vector<float> light();

 private:
  std::vector<unsigned char> rewritten_;  ///< for the decoder
  std::unique_ptr<Decoder> decoder_;
  std::unique_ptr<PictureMetadata> metadata_;
  PictureShape shape_;
};

/// Opens a picture: an EXR by photile's own reader, a PNG by libpng, all else by OpenImageIO, which
/// is loaded for the first of them. Only headers are read, and what they announce is within
/// limits.hpp. `bytes` must outlive the picture; `name` tells, by its extension, formats that have
/// no signature. Errors: DecodeError; UsageError where OpenImageIO's module is not installed.
std::unique_ptr<EncodedPicture> open_picture(const std::string& name, Encoded bytes);

}  // namespace photile::image

extern "C" {

/// OpenImageIO's readers, in a separate module (host/pictures/openimageio): opens a picture of any
/// format but EXR and PNG, which `bytes` must outlive; the caller deletes it. Errors: DecodeError.
__attribute__((visibility("default"))) photile::image::Decoder* photile_openimageio_decoder(
    const char* reader, photile::image::Encoded bytes);

}  // extern "C"
