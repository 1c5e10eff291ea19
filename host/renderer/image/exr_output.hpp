// EXR files of photile: their headers, and rows handed over as they are made.
#pragma once

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/files.hpp"
#include "photile/image.hpp"

namespace photile::image {

/// A part of 32-bit floats with the header's size and the given channels. Says what its colours
/// are, as every part of a file must, and nothing else.
Imf::Header exr_header(const PictureHeader& header, const std::vector<std::string>& channels,
                       Imf::Compression compression);

/// Adds the picture's attributes.
void add_attributes(const PictureHeader& picture, Imf::Header& header);

/// Writes parts one after the other, each from the top: a single-part file where there is one.
class ExrOutput {
 public:
  /// Errors: those of OutputFile::fail.
  ExrOutput(OutputFile& output, const std::vector<Imf::Header>& parts);
  ~ExrOutput();

  /// The next rows of a part: `planes`, one for each of `channels`, of rows x width.
  /// Errors: those of OutputFile::fail.
  void write(std::size_t part, int rows, const std::vector<std::string>& channels,
             std::span<const float* const> planes);

  /// Errors: those of OutputFile::commit.
  void close();

 private:
  class Stream;
  [[noreturn]] void fail(const std::exception& error);

  OutputFile& output_;
  std::unique_ptr<Stream> stream_;
  std::unique_ptr<Imf::MultiPartOutputFile> file_;
};

}  // namespace photile::image
