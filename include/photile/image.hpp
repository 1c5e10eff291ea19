// Pictures with named channels, read and written.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "photile/defaults.hpp"

namespace photile {

/// The metadata of a picture.
struct PictureHeader {
  int width = 0, height = 0;
  std::vector<std::string> channel_names;  ///< "R", "Combined_lamp.G", ...

  /// EXR attributes: strings, and named 4x4 matrices (row vectors, as OpenEXR stores them).
  std::map<std::string, std::string> attributes;
  std::map<std::string, std::array<float, 16>> matrices;
  std::map<std::string, float> numbers;

  std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

/// Float channels by name, all of one size, row 0 at the top.
struct Image : PictureHeader {
  std::vector<std::vector<float>> channels;  ///< one plane per name

  /// The plane of a channel, or nullptr.
  const std::vector<float>* find(const std::string& channel) const;
  std::vector<float>& add(const std::string& channel);  ///< a new plane of zeros
};

/// Reads the header of a picture: that of all parts of an EXR together, however many channels they
/// have. Errors: InputError naming the file.
PictureHeader read_header(const std::filesystem::path& file);

/// Reads an EXR (all parts; channels of part P that do not carry its name keep theirs), a PNG,
/// JPEG, TIFF, WebP, BMP, GIF, Targa, PNM or Radiance picture: upright and in linear Rec.709, as
/// docs/reference/scene-files.md describes; integers are scaled to [0, 1]. Checks limits.hpp before
/// decoding. Errors: InputError naming the file.
Image read_image(const std::filesystem::path& file);

/// Reads every pixel of a picture, a few rows at a time, and discards it. Errors: InputError naming
/// the file where it is damaged or incomplete.
void check_pixels(const std::filesystem::path& file);

/// Writes a single-part scan-line EXR of 32-bit floats, through a temporary name and a rename.
/// Errors: OutputError naming the file; an existing file is kept then.
void write_exr(const std::filesystem::path& file, const Image& image);

/// Writes an 8-bit sRGB PNG of the channels R, G, B, through a temporary name and a rename.
void write_png(const std::filesystem::path& file, const Image& display_referred);

/// Writes a Radiance picture (RGBE) of the channels R, G, B, through a temporary name and a rename.
/// Values times the attribute `whiteLuminance` are cd/m2; in the file, 179 times the `bright` of
/// Radiance's primaries gives the same cd/m2, up to the rounding to 8 bits: colours are scaled to
/// its primaries. Its VIEW is the attribute `photile.view`. Errors: OutputError naming the file; an
/// existing file is kept then. InputError without R, G, B or `whiteLuminance`.
void write_hdr(const std::filesystem::path& file, const Image& scene_referred);

/// How scene-referred colours, white at 1, become those of a display.
enum class DisplayView {
  /// Khronos PBR Neutral, by its specification (Khronos Group, "PBR Neutral Tone Mapper", 2024):
  /// colours up to 0.8 less 0.04, the reflection of a dielectric under white light; brighter ones
  /// roll off towards white and keep their hue.
  neutral,
  /// The sRGB curve alone: colours as they are up to 1, brighter ones scaled to 1 as a whole.
  standard
};

/// "neutral", "standard".
std::string_view name_of(DisplayView view);
inline constexpr std::array all_display_views = {DisplayView::neutral, DisplayView::standard};

struct ToneMapping {
  bool automatic_exposure = true;        ///< scale so that the log-average luminance becomes 0.36
  double exposure = defaults::exposure;  ///< stops on top
  DisplayView view = DisplayView::neutral;
  /// Linear Rec.709 of light that is shown as white, each above 0; luminance 1.
  std::array<float, 3> white = {1, 1, 1};
};

/// Factor that brings the log-average luminance of R, G, B to 0.36 of white (Reinhard et al.,
/// "Photographic tone reproduction for digital images", 2002), or less, so that at most a tenth of
/// all surfaces exceed 2.5 times white. Black, dark corners and lights do not count, lights up to a
/// tenth of the picture (docs/reference/pictures.md). 1 where no luminance is finite and positive.
/// Errors: InputError where there is no R, G or B.
double automatic_exposure(const Image& scene_referred);
/// The same of several pictures together.
double automatic_exposure(std::span<const Image* const> scene_referred);

/// With the automatic exposure of several pictures together as stops, so that they can be compared.
ToneMapping with_one_exposure(ToneMapping parameters, std::span<const Image* const> scene_referred);

/// Root R, G, B to display-referred values in [0,1], still linear; `write_png` applies the sRGB
/// curve. Every pixel keeps its hue, except those on the border of a lamp or a window, which become
/// a mix of what is displayed on both sides. NaN and negative values count as 0.
Image tone_map(const Image& scene_referred, const ToneMapping& parameters);

/// Errors of a picture. Pixels that see a light, more than 20 times as bright as the reference's
/// median, are left out of all of them, and so are those next to them: their part of a mean would
/// hide the room's, and a single sample on the border of a light would outweigh all other pixels.
struct PictureError {
  /// Mean over pixels and channels of (a - b)^2 / (b^2 + 0.01 m^2): a the picture, b the reference,
  /// m the mean of b. Its square root is the relative error of a pixel.
  double relative_mse = 0;
  double mean_ratio = 1;  ///< mean of the picture over that of the reference
  /// Largest |mean(a) / mean(b) - 1| of the tiles of a sixteenth of the picture's height: bias that
  /// many pixels share, where a pixel's noise has averaged out. Tiles darker than a tenth of m, or
  /// that mostly see lights, do not count.
  double worst_region = 0;
  /// The position of that tile: its upper left corner and size, pixels; empty where no tile counts.
  struct Region {
    int x = 0, y = 0, width = 0, height = 0;
  } worst_area;
  /// Peak signal-to-noise ratio of the displayed pictures, decibel: both exposed so that m becomes
  /// mid grey, and clipped at white. Infinite where they are equal.
  double psnr = 0;

  double relative_error() const;  ///< root of relative_mse
};

/// Errors: UsageError when the sizes differ or one lacks R, G and B; InputError when the reference
/// is black.
PictureError picture_error(const Image& picture, const Image& reference);

/// The pixels that count, and what a squared difference of their channels is divided by: 3 x
/// pixels values, 0 where the pixel sees a light or is next to one that does. Errors: as above.
class RelativeErrorWeights {
 public:
  explicit RelativeErrorWeights(const Image& reference);

  bool counts(std::size_t pixel) const { return counts_[pixel]; }
  std::size_t counted() const { return counted_; }  ///< pixels
  double mean() const { return mean_; }  ///< of the reference over these pixels and all channels
  /// Mean over channels and pixels that count of (a - b)^2 / (b^2 + 0.01 m^2).
  double relative_mse(const Image& picture, const Image& reference) const;

 private:
  std::vector<bool> counts_;
  std::vector<double> divisor_;  ///< 3 x pixels
  std::size_t counted_ = 0;
  double mean_ = 0;
};

}  // namespace photile
