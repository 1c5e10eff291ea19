// A picture file, opened: what it says of itself, and its pixels a few rows at a time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "image/exr_input.hpp"
#include "photile/image.hpp"
#include "photile/light_layers.hpp"

namespace photile::image {

class ChannelRows {
 public:
  virtual ~ChannelRows() = default;
  virtual const PictureHeader& header() const = 0;
  /// Rows [first, end) of a channel, rows x width. Errors: InputError where they cannot be read.
  virtual std::vector<float> read(std::size_t channel, int first, int end) = 0;
};

/// The rows of a picture in memory.
class ImageRows : public ChannelRows {
 public:
  explicit ImageRows(std::shared_ptr<const Image> image) : image_(std::move(image)) {}
  const PictureHeader& header() const override { return *image_; }
  std::vector<float> read(std::size_t channel, int first, int end) override {
    const auto begin = image_->channels[channel].begin();
    return {begin + std::ptrdiff_t{first} * image_->width,
            begin + std::ptrdiff_t{end} * image_->width};
  }

 private:
  std::shared_ptr<const Image> image_;
};

/// Adds up the layers, each times its scale, from a row on: as many rows as the picture has room
/// for. `scales` has one per layer, power x tint.
void combine_rows(const LightLayers& layers, std::span<const glm::vec3> scales, int row,
                  std::span<glm::vec3> picture);

/// All parts of an EXR as one picture, or a picture of any other format that open_picture reads.
class PictureFile : public ChannelRows {
 public:
  /// Reads the headers. Checks each part against limits.hpp, but not their sum.
  /// Errors: InputError naming the file.
  explicit PictureFile(const std::filesystem::path& file);

  const PictureHeader& header() const override { return header_; }
  /// Errors: InputError naming the file where it is damaged.
  std::vector<float> read(std::size_t channel, int first, int end) override;

  std::size_t channels_of_largest_part() const { return largest_part_; }
  /// A channel of each part.
  std::vector<std::size_t> first_channels() const;

  /// Refuses a picture that would be too large in memory. Errors: InputError naming the file.
  void check_total() const;

 private:
  /// Where a channel is.
  struct Slot {
    int part;
    std::size_t index;  ///< among ExrInput::Part::channels
  };
  /// Rows of all channels of a part, as decoded last: channels x rows x width.
  struct Block {
    int part = -1, first = 0, end = 0;  ///< no part: nothing yet
    std::vector<float> planes;
  };
  void read_headers();
  void open_exr();
  void open_other();
  void add_part(const ExrInput::Part& part);
  void add_channel(const ExrInput::Part& part, std::size_t index);
  void decode(int part, int first, int end);
  [[noreturn]] void refuse(const std::string& reason) const;

  std::filesystem::path file_;
  std::unique_ptr<ExrInput> exr_;  ///< null for other formats
  PictureHeader header_;
  std::vector<Slot> slots_;      ///< per channel
  std::set<std::string> names_;  ///< of the channels
  int parts_ = 0;
  std::size_t largest_part_ = 0;
  Block block_;
};

}  // namespace photile::image
