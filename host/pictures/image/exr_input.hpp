// EXR files through OpenEXR: their parts, and floats of a few rows at a time.
#pragma once

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
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
    int width = 0, height = 0;          ///< of the display window
    std::string name;                   ///< "" where the file gives none
    std::vector<std::string> channels;  ///< R, G, B, A of the root first, the others by name
    /// Where the colours have other primaries than Rec.709's.
    std::optional<glm::dmat3> to_rec709;
    double white_luminance = 0;  ///< cd/m2 of RGB (1,1,1); 0 where the file does not say it
    bool is_cube_map = false;
  };
  const std::vector<Part>& parts() const { return parts_; }
  const Imf::Header& header(std::size_t part) const;

  /// Rows [first, end) of the display window, of some channels of a part, in Rec.709: channels x
  /// rows x width. Pixels of the display window that the data window leaves out are 0.
  /// Errors: those of OpenEXR where the file is damaged.
  ///   channels   into Part::channels; all three of a colour whose primaries are others
  void read(std::size_t part, int first, int end, std::span<const std::size_t> channels,
            std::vector<float>& planes);

 private:
  struct File;
  void find_parts(std::uint64_t bytes);
  void read_stored(std::size_t part, int first, int end, std::span<const std::size_t> channels,
                   std::vector<float>& planes);

  std::unique_ptr<Imf::IStream> stream_;
  std::unique_ptr<File> file_;
  std::vector<Part> parts_;
};

}  // namespace photile::image
