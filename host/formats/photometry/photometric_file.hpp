// Photometric files: ANSI/IES LM-63 from 1986 to 2019 (.ies), and EULUMDAT, those of Europe (.ldt).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/ascii_text.hpp"
#include "files/scene_files.hpp"
#include "photile/scene.hpp"

namespace photile::photometry {

/// Reads EULUMDAT where the file's name ends with .ldt, else LM-63.
/// Errors: ResourceError naming the file, the line, what is wrong and the remedy.
IntensityDistribution read_photometry(const std::string& name, std::span<const unsigned char> bytes,
                                      files::Warnings& warnings);

/// Reads numbers separated by blanks, commas or ends of lines, whatever the locale says.
class NumberReader {
 public:
  /// `lines` must outlive this; reading starts at line `first`, counted from 0.
  NumberReader(const std::vector<std::string_view>& lines, std::size_t first)
      : lines_(lines), line_(first) {}

  /// Errors: ResourceError that tells `what` is missing, or no number, and in which line.
  double number(const std::string& what);
  /// A whole number in [lowest, highest]. Errors: ResourceError.
  std::size_t count(const std::string& what, std::uint64_t lowest, std::uint64_t highest);
  std::vector<double> numbers(const std::string& what, std::size_t count);

  /// For messages: "line 12".
  std::string place() const;

 private:
  std::string_view token();

  const std::vector<std::string_view>& lines_;
  std::size_t line_;
  std::size_t column_ = 0;
};

/// Degrees between the angles of a file: mirrored, or turned by right angles, they still differ.
inline constexpr double least_angle_step = 1e-6;

/// A half-plane of intensities: its azimuth, and which of the measured ones it repeats.
struct MeasuredPlane {
  double azimuth;  ///< degrees
  std::size_t measured;
};

/// The planes all around a lamp, ascending, from the azimuths that were measured: one (rotational
/// symmetry), 0 to 90 (symmetric to two planes), 0 to 180 or 90 to 270 (to one), or 360 degrees,
/// of which the last may be missing. Azimuths ascend. Errors: ResourceError for any other range.
std::vector<MeasuredPlane> planes_all_around(const std::vector<double>& azimuths);

/// The colour temperature, 1000 to 25000 K, that a text states: "4000", "ww/3000 K", or the last
/// two digits of "840"; of a range, "tw 2700-6500", the lowest. 0 = none.
double kelvin_in(std::string_view text);
/// The end of a range of them; 0 = none.
double highest_kelvin_in(std::string_view text);
/// Ra that a text states, or the least: "85", "CRI 90", "80-89", "1B/86". Without a value that of
/// EULUMDAT's group of DIN 5035, "1B", or the first digit of "840". 0 = none.
double rendering_in(std::string_view text);
/// The last of these alone.
double coded_rendering_in(std::string_view text);

/// Reads an LM-63 file of photometric type A, B or C. Intensities are the candela values times the
/// multiplier and the ballast factor, and in files of 1986 and 1991 times the ballast-lamp factor:
/// where the rated lumens of the lamps count, they count already, and in absolute
/// photometry (-1 lumens) there are none. Light at angles between those measured is interpolated,
/// beyond them there is none. TILT is read and ignored, with a warning if it changes anything.
/// The axes are those of the glTF extension EXT_lights_ies: vertical angle 0 of type C, or both
/// angles 0, is -z; horizontal angle 0 of type C is +x, and 90 is +y.
///   name  of the file, for messages
/// Errors: ResourceError with the line and what is wrong.
IntensityDistribution read_ies(const std::string& name, std::string_view text,
                               files::Warnings& warnings);

/// Reads an EULUMDAT file (Stockmar 1990). Intensities, in cd per 1000 lm, are multiplied by the
/// flux of the first set of lamps and by the file's conversion factor. Decimal commas count as
/// points. C0 is +x and C90 is +y of the lamp, gamma 0 is -z.
///   name  of the file, for messages
/// Errors: ResourceError with the line and what is wrong.
IntensityDistribution read_eulumdat(const std::string& name, std::string_view text,
                                    files::Warnings& warnings);

}  // namespace photile::photometry
