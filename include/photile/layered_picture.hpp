// A picture of light layers whose pixels are made when they are asked for, so that a picture of
// hundreds of lights is never whole in memory.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "photile/image.hpp"
#include "photile/light_layers.hpp"
#include "photile/light_mix.hpp"

namespace photile {

/// Rows of one light's layer at the light's power and tint; arrays of rows x width.
struct LightRows {
  std::array<std::vector<float>, 3> rgb;  ///< cd/m2 or W/(m2 sr)
  std::vector<float> illuminance;         ///< lux; empty where it is not known
};

class LayeredPicture {
 public:
  virtual ~LayeredPicture() = default;

  /// Size and attributes. No channels: their names are those of `root` and `channel_names`.
  PictureHeader& header() { return header_; }
  const PictureHeader& header() const { return header_; }

  std::size_t lights() const { return layers_.size(); }
  /// The channels of a light: `Combined_<light>.R/G/B`, and `Illuminance_<light>.Y` where it is
  /// known.
  std::vector<std::string> channel_names(std::size_t light) const;

  /// Rows [first, end) of a light: finite numbers, the nearest where a value is beyond them, and 0
  /// for what is none. Asking for lights in ascending order is the fastest.
  /// Errors: InputError where they come from a file that is damaged.
  LightRows read(std::size_t light, int first, int end) const;

  /// The root R G B A: the float sum of all lights in order, finite as they are. Errors: as `read`.
  Image root() const { return root(0, header_.height); }
  /// Rows [first, end) of it. To read them before those of the lights decodes a file once.
  Image root(int first, int end) const;

  /// A line for each light of whose pixels some were not finite, among those that have been read,
  /// or for the root where only their sum was not: which, how many and the remedy.
  std::vector<std::string> overflows() const;

 protected:
  /// As `read` and `root`, whatever the numbers.
  virtual LightRows read_any(std::size_t light, int first, int end) const = 0;
  virtual Image sum_any(int first, int end) const = 0;

  struct Layer {
    std::string light;
    bool illuminance;
  };
  PictureHeader header_;
  std::vector<Layer> layers_;

 private:
  struct Overflow {
    int counted = 0;  ///< rows, from the top
    std::uint64_t pixels = 0;
    void add(int first, int end, std::size_t lost);
  };
  mutable std::map<std::size_t, Overflow> overflows_;  ///< by light
  mutable Overflow lost_sums_;                         ///< of the root
};

/// Layers x powers, as mix_layers gives them. Keeps a reference to the layers. Errors: UsageError
/// when the mix lacks a layer's light.
std::unique_ptr<LayeredPicture> mixed_picture(const LightLayers& layers, const LightMix& mix);

/// A picture file with other powers, as `relight` gives it. One of few lights is read at once; of
/// others no more than a few rows of all lights are in memory. Errors: InputError; UsageError as
/// in `relight`.
std::unique_ptr<LayeredPicture> relit_picture(const std::filesystem::path& file,
                                              const std::vector<LightChange>& changes);

/// The whole picture: root and all layers.
Image to_image(const LayeredPicture& picture);

/// Writes a scan-line EXR of 32-bit floats: a single part with up to limits::max_single_part_lights
/// lights; with more, a part for the root and one for each light. Row by row, through a temporary
/// name and a rename. Errors: OutputError naming the file; an existing file is kept then. Those of
/// `read`.
void write_exr(const std::filesystem::path& file, const LayeredPicture& picture);

}  // namespace photile
