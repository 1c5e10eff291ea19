// The emission of lights, from the quantities by which people describe them: flux in closed form,
// colour, and the surface of a textured light in cells of even radiance. SI units: radiance (or
// luminance) per square metre and steradian, intensity per steradian, irradiance per square metre.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "photile/scene.hpp"

namespace photile::scene {

/// Triangles of an area light with an emission texture, each cut into congruent triangles about as
/// large as a texel. A cell's light is the mean of a few lookups in it.
class EmissionCells {
 public:
  /// References are kept. `light` has an emission texture and Light::texel_radiance, in any unit.
  EmissionCells(const Scene& scene, const Light& light);

  /// Integral of the radiance over one side of the light, per channel; times square metres.
  const glm::dvec3& integral() const { return integral_; }

  /// A point of the light's surface.
  struct Point {
    std::uint32_t triangle;  ///< into Scene::triangles
    double u, v;             ///< barycentric weights of the second and third corner
  };
  /// Maps numbers in [0, 1) to a point: a cell in proportion to its luminance times its area, then
  /// evenly over the cell. Each cell counts at least a fiftieth of the mean luminance.
  Point sample(double cell, double u1, double u2) const;
  /// The density of `sample` at a position, per square metre.
  double density(const Point& point) const;

 private:
  struct Triangle {
    std::uint32_t cuts;  ///< of each edge; cuts^2 cells
    std::size_t first_cell;
    double cell_area;  ///< square metres
  };
  double weight(std::size_t cell) const {
    return weight_up_to_[cell] - (cell == 0 ? 0.0 : weight_up_to_[cell - 1]);
  }

  /// The first of the cells [first, last) whose weight_up_to_ exceeds a weight; else `last`.
  std::uint32_t first_beyond(std::size_t first, std::size_t last, double weight) const;

  const Light* light_;
  std::vector<Triangle> triangles_;   ///< of the light's, in their order
  std::vector<double> weight_up_to_;  ///< of the cells up to and including this one
  /// For 2^n equal parts of all weight the cell in which each begins, and the number of cells:
  /// where to look for a weight (Chen and Asau's guide table, 1974). Without it, half of the time
  /// of sampling a light with a large picture would go into a search through all cells.
  std::vector<std::uint32_t> first_of_fraction_;
  glm::dvec3 integral_{0.0};
};

/// Radiance of a textured light at a point, in the unit of Light::texel_radiance.
glm::dvec3 textured_radiance(const Scene& scene, const Light& light,
                             const EmissionCells::Point& point);

/// `light.color` and the luminance of `rgb`, which may be any radiometric colour; false if black.
bool set_light_color(const glm::dvec3& rgb, Light& light, double& luminance_of_rgb);

/// Colour and power of an area light whose emission texture has white texels of radiance
/// `texel_radiance`, per triangle of `light.triangles`; scales that radiance to power 1. False if
/// black.
bool set_textured_emission(const Scene& scene, Light& light);

/// Flux of a directional light through a disc of `radius` metres that faces it, where a surface
/// that faces it gets `irradiance`; `angular_diameter` of its disc in radians.
double distant_flux(double irradiance, double angular_diameter, double radius);

/// Adds a light that is a map of all that surrounds the scene, which must have its triangles.
void add_environment_light(const std::string& name, EnvironmentMap map, Scene& scene);

/// Flux of a surface of `area` that emits `radiance` uniformly over the hemisphere of each side.
double area_flux(double radiance, double area, bool two_sided);

/// Flux of a point light of uniform `intensity`.
double point_flux(double intensity);

/// Flux of a spot light as KHR_lights_punctual defines it: `intensity` up to the inner cone angle,
/// then the square of a ramp that is linear in the cosine, zero from the outer cone angle on.
/// Angles in radians from the axis, 0 <= inner <= outer <= pi/2.
double spot_flux(double intensity, double inner_cone_angle, double outer_cone_angle);

/// Flux of parallel light of `irradiance` through a disc of `radius` that faces it.
double directional_flux(double irradiance, double radius);

/// CIE 1931 chromaticity (x, y) of light of a correlated colour temperature in kelvin, from
/// limits::min_color_temperature to limits::max_color_temperature: the reference illuminants of
/// ANSI/IES TM-30. Up to 4000 K a black body (Krystek 1985, within 1e-4), from 5000 K CIE daylight
/// (CIE 15, extrapolated above 25000 K), between them a mix.
glm::dvec2 chromaticity_of_temperature(double kelvin);

/// Linear Rec.709 of that light at luminance 1. Below about 1900 K its blue lies outside the gamut
/// and is 0.
glm::dvec3 color_of_temperature(double kelvin);

}  // namespace photile::scene
