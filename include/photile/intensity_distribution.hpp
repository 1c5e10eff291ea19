// The luminous intensity of a lamp in every direction, as a goniophotometer measures it.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace photile {

/// Axes of the spherical coordinates in which a lamp was measured, in the space of the lamp: its
/// -z axis is where it is aimed, as for lights of glTF.
struct PhotometricAxes {
  glm::dvec3 pole{0.0, 0.0, -1.0};    ///< unit; polar angle 0
  glm::dvec3 zero{1.0, 0.0, 0.0};     ///< unit; polar angle 90 degrees, azimuth 0
  glm::dvec3 quarter{0.0, 1.0, 0.0};  ///< unit; polar angle 90 degrees, azimuth 90 degrees
};

/// The part of a lamp that shines, as its photometric file gives it: a box, or an upright cylinder
/// on a circle or an ellipse, around the lamp's axis. All zero where the file says nothing.
struct LuminousOpening {
  double along_zero = 0;     ///< metres along PhotometricAxes::zero; of a round one a diameter
  double along_quarter = 0;  ///< metres along PhotometricAxes::quarter
  double height = 0;         ///< metres along the pole, of sides that shine too
  bool round = false;

  /// m2 of its projection onto a plane that faces `direction`.
  ///   direction   unit, in the lamp's space, away from it
  double projected_area(const PhotometricAxes& axes, const glm::dvec3& direction) const;
};

/// Intensities on a grid of polar angles and azimuths, bilinear in the two angles between them and
/// zero beyond the outermost. One point emits all light: the lamp's own size is left out, which is
/// the approximation of the files themselves (far-field photometry).
class IntensityDistribution {
 public:
  /// `polar`, `azimuth`: degrees, strictly ascending, at least two of each; polar angles within
  /// [0, 180], azimuths within 360 degrees. `intensity`: cd, [azimuth][polar], not negative.
  /// Errors: std::invalid_argument.
  IntensityDistribution(std::string name, const PhotometricAxes& axes,
                        const std::vector<double>& polar, const std::vector<double>& azimuth,
                        std::vector<float> intensity);

  /// cd in a unit direction of the lamp's space.
  double intensity(const glm::dvec3& direction) const;

  /// lm: the integral of `intensity` over the sphere, in closed form.
  double flux() const { return flux_; }

  const std::string& name() const { return name_; }
  const PhotometricAxes& axes() const { return axes_; }

  const LuminousOpening& opening() const { return opening_; }
  void set_opening(const LuminousOpening& opening) { opening_ = opening; }

  // Cells of the grid: column of azimuths x row of polar angles.
  std::size_t columns() const { return azimuth_.size() - 1; }
  std::size_t rows() const { return polar_.size() - 1; }
  /// lm that a cell emits.
  double cell_flux(std::size_t column, std::size_t row) const;

  /// A place in a cell; `u` of the way from its first azimuth to its last, `v` of the way between
  /// the cosines of its polar angles, each in [0, 1].
  struct Place {
    glm::dvec3 direction;  ///< unit, in the lamp's space
    double intensity;      ///< cd
  };
  Place in_cell(std::size_t column, std::size_t row, double u, double v) const;
  /// Largest intensity in a cell, cd.
  double cell_maximum(std::size_t column, std::size_t row) const;

 private:
  double at(std::size_t column, std::size_t row) const {
    return intensity_[column * polar_.size() + row];
  }
  double interpolated(std::size_t column, std::size_t row, double azimuth, double polar) const;

  std::string name_;
  PhotometricAxes axes_;
  std::vector<double> polar_, azimuth_;  ///< radians
  std::vector<float> intensity_;
  LuminousOpening opening_;
  double flux_ = 0;
};

}  // namespace photile
