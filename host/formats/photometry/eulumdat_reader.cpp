#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/foreign_text.hpp"
#include "files/scene_files.hpp"
#include "photile/limits.hpp"
#include "photometry/photometric_file.hpp"

namespace photile::photometry {
namespace {

// Lines of the format, counted from 1.
constexpr std::size_t symmetry_line = 3, plane_count_line = 4, angle_count_line = 6,
                      opening_line = 16, conversion_line = 24, set_count_line = 26;
constexpr std::size_t lines_per_set = 6, direct_ratios = 10;
constexpr std::size_t maker_line = 1, luminaire_line = 9, article_line = 10;
constexpr std::size_t type_in_set = 2, flux_in_set = 3, colour_in_set = 4, rendering_in_set = 5,
                      watts_in_set = 6;  ///< after the line of the number of sets

/// Symmetry indicator of the format.
enum Symmetry : std::size_t {
  asymmetric = 0,
  rotational = 1,
  about_c0 = 2,
  about_c90 = 3,
  about_both = 4
};

class Lines {
 public:
  explicit Lines(std::string_view text) : lines_(lines_of(text)) {}

  /// The number in line `line`, counted from 1.
  double number(const std::string& what, std::size_t line) const {
    if (line > lines_.size())
      throw files::ResourceError(fmt::format("the file ends before the {}", what));
    std::string text(trimmed(lines_[line - 1]));
    std::replace(text.begin(), text.end(), ',', '.');
    const auto value = parse_signed(text);
    if (!value)
      throw files::ResourceError(fmt::format("line {}: the {} is not a number", line, what));
    return *value;
  }

  double number_or_0(std::size_t line) const {
    if (line > lines_.size()) return 0.0;
    std::string text(trimmed(lines_[line - 1]));
    std::replace(text.begin(), text.end(), ',', '.');
    return parse_signed(text).value_or(0.0);
  }

  /// UTF-8; "" beyond the end.
  std::string text(std::size_t line) const {
    return line > lines_.size() ? "" : one_line(trimmed(lines_[line - 1]));
  }

  std::size_t count(const std::string& what, std::size_t line, std::uint64_t lowest,
                    std::uint64_t highest) const {
    const double value = number(what, line);
    if (value != std::floor(value) || value < static_cast<double>(lowest) ||
        value > static_cast<double>(highest)) {
      throw files::ResourceError(
          fmt::format("line {}: the {} is {}, not a whole number from {} to {}", line, what, value,
                      lowest, highest));
    }
    return static_cast<std::size_t>(value);
  }

 private:
  std::vector<std::string_view> lines_;
};

/// Length (along C90), width (0 = round) and the heights of the sides as seen from C0, C90, C180
/// and C270; millimetres in the file. A line that holds no number says nothing of it.
LuminousOpening opening_of(const Lines& lines) {
  const auto metres = [&](std::size_t line) {
    return std::abs(lines.number_or_0(opening_line + line)) / 1000.0;
  };
  const double length = metres(0), width = metres(1);
  return {
      .x = width > 0 ? width : length,
      .y = length,
      .heights = {metres(2), metres(3), metres(4), metres(5)},
      .shape = width > 0 ? LuminousOpening::Shape::box : LuminousOpening::Shape::upright_cylinder};
}

/// The first set of lamps counts.
LuminaireData data_of(const Lines& lines) {
  LuminaireData data{lines.text(maker_line), lines.text(article_line), lines.text(luminaire_line),
                     lines.text(set_count_line + type_in_set)};
  const std::string colour = lines.text(set_count_line + colour_in_set);
  data.kelvin = kelvin_in(colour);
  data.highest_kelvin = highest_kelvin_in(colour);
  data.rendering = rendering_in(lines.text(set_count_line + rendering_in_set));
  if (data.rendering == 0) data.rendering = coded_rendering_in(colour);
  data.watts = std::max(0.0, lines.number_or_0(set_count_line + watts_in_set));
  return data;
}

/// Numbers of the C planes whose intensities follow, counted from 0.
struct PlaneRange {
  std::size_t first, count;
};

PlaneRange measured_planes(Symmetry symmetry, std::size_t planes) {
  switch (symmetry) {
    case asymmetric:
      return {0, planes};
    case rotational:
      return {0, 1};
    case about_c0:
      return {0, planes / 2 + 1};
    case about_c90:
      return {3 * planes / 4, planes / 2 + 1};
    case about_both:
      return {0, planes / 4 + 1};
  }
  return {};
}

std::vector<double> ascending_angles(const std::string& what, std::size_t first_line,
                                     std::size_t count, double highest, const Lines& lines) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = lines.number(what, first_line + i);
    const bool ascends = i == 0 || angle - angles.back() >= least_angle_step;
    if (!(angle >= 0.0 && angle <= highest) || !ascends) {
      throw files::ResourceError(fmt::format(
          "line {}: the {} is {}; angles must ascend from 0 to {} degrees, by at least {:g}",
          first_line + i, what, angle, highest, least_angle_step));
    }
    angles.push_back(angle);
  }
  return angles;
}

/// Azimuths of the measured planes, ascending.
std::vector<double> measured_azimuths(const std::vector<double>& planes, const PlaneRange& range) {
  std::vector<double> azimuths;
  for (std::size_t i = 0; i < range.count; ++i) {
    const std::size_t plane = range.first + i;
    azimuths.push_back(plane < planes.size() ? planes[plane]
                                             : planes[plane - planes.size()] + 360.0);
  }
  return azimuths;
}

/// From C270 by C0 to C90: what is symmetric about the plane C90-C270 counts from its middle.
std::vector<MeasuredPlane> planes_about_c90(const std::vector<double>& azimuths) {
  std::vector<double> turned = azimuths;  // 90 to 270, as planes_all_around knows it
  for (double& azimuth : turned) azimuth -= 180.0;
  std::vector<MeasuredPlane> planes = planes_all_around(turned);
  for (MeasuredPlane& plane : planes) plane.azimuth += 180.0;
  return planes;
}

}  // namespace

IntensityDistribution read_eulumdat(const std::string& name, std::string_view text,
                                    files::Warnings& warnings) {
  const Lines lines(text);
  const auto symmetry =
      static_cast<Symmetry>(lines.count("symmetry indicator", symmetry_line, 0, 4));
  const std::size_t planes =
      lines.count("number of C planes", plane_count_line, 1, limits::max_photometric_angles);
  const std::size_t angles = lines.count("number of intensities in a C plane", angle_count_line, 2,
                                         limits::max_photometric_angles);
  if (planes * angles > limits::max_photometric_values) {
    throw files::ResourceError(fmt::format("{} C planes x {} angles; the limit is {} values",
                                           planes, angles, limits::max_photometric_values));
  }
  if ((symmetry == about_c0 && planes % 2 != 0) || (symmetry > about_c0 && planes % 4 != 0)) {
    throw files::ResourceError(fmt::format("line {}: {} C planes cannot have symmetry {}",
                                           plane_count_line, planes, static_cast<int>(symmetry)));
  }
  const double conversion = lines.number("conversion factor", conversion_line);
  const std::size_t sets =
      lines.count("number of sets of lamps", set_count_line, 1, limits::max_photometric_angles);
  if (sets > 1) {
    warnings.add("photometric file", name,
                 fmt::format("it has {} sets of lamps; the first is used", sets));
  }
  const std::size_t flux_line = set_count_line + flux_in_set;
  const double factor = conversion * lines.number("flux of the lamps", flux_line) / 1000.0;
  if (!(factor > 0.0)) {
    throw files::ResourceError(
        fmt::format("conversion factor (line {}) times flux of the lamps (line {}) is not above 0",
                    conversion_line, flux_line));
  }
  const std::size_t first_plane = set_count_line + lines_per_set * sets + direct_ratios + 1;
  const std::vector<double> plane_angles =
      ascending_angles("angle of a C plane", first_plane, planes, 360.0, lines);
  const std::vector<double> polar =
      ascending_angles("angle gamma", first_plane + planes, angles, 180.0, lines);

  const PlaneRange range = measured_planes(symmetry, planes);
  const std::size_t first_value = first_plane + planes + angles;
  std::vector<float> measured;
  for (std::size_t i = 0; i < range.count * angles; ++i) {
    const double value = factor * lines.number("intensity", first_value + i);
    if (!(value >= 0.0) || !std::isfinite(static_cast<float>(value))) {
      throw files::ResourceError(
          fmt::format("line {}: an intensity of {} cd is not possible", first_value + i, value));
    }
    measured.push_back(static_cast<float>(value));
  }
  const std::vector<double> azimuths = measured_azimuths(plane_angles, range);
  std::vector<double> azimuth;
  std::vector<float> intensity;
  for (const MeasuredPlane& plane :
       symmetry == about_c90 ? planes_about_c90(azimuths) : planes_all_around(azimuths)) {
    azimuth.push_back(plane.azimuth);
    const auto first = measured.begin() + static_cast<std::ptrdiff_t>(plane.measured * angles);
    intensity.insert(intensity.end(), first, first + static_cast<std::ptrdiff_t>(angles));
  }
  IntensityDistribution distribution(name, PhotometricAxes{}, polar, azimuth, std::move(intensity));
  distribution.set_opening(opening_of(lines));
  distribution.set_data(data_of(lines));
  return distribution;
}

}  // namespace photile::photometry
