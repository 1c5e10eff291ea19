// The pixels of a picture, a few rows of a channel at a time.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <utility>
#include <vector>

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

/// Those of a picture in memory.
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

}  // namespace photile::image
