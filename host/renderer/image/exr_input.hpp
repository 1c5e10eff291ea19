// EXR files through OpenEXR: their parts, and floats of a few rows at a time.
#pragma once

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace photile::image {

/// Lets OpenEXR use the cores that photile may use. Called before a file is opened.
void set_up_openexr();

class ExrInput {
 public:
  /// Reads the headers. Errors: DecodeError, also for sides and pixels a byte
  /// beyond limits.hpp; those of OpenEXR.
  explicit ExrInput(const std::filesystem::path& file);
  explicit ExrInput(std::span<const unsigned char> bytes);  ///< which must outlive it
  ~ExrInput();

  struct Part {
    int width = 0, height = 0;
    std::string name;                   ///< "" where the file gives none
    std::vector<std::string> channels;  ///< R, G, B, A of the root first, the others by name
  };
  const std::vector<Part>& parts() const { return parts_; }
  const Imf::Header& header(std::size_t part) const;

  /// Rows [first, end) of the first channels of a part: channels x rows x width.
  /// Errors: those of OpenEXR where the file is damaged.
  void read(std::size_t part, int first, int end, std::size_t channels, std::vector<float>& planes);

 private:
  struct File;
  void find_parts(std::uint64_t bytes);

  std::unique_ptr<Imf::IStream> stream_;
  std::unique_ptr<File> file_;
  std::vector<Part> parts_;
};

}  // namespace photile::image
