// Scenes whose light is known in closed form, and what they are made of: simple rooms built in
// code, and form factors.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <span>
#include <string>
#include <vector>

#include "photile/scene.hpp"
#include "photile/sensors.hpp"

namespace photile::validation {

enum class Quantity {
  illuminance,  ///< lux
  luminance     ///< cd/m2, seen along the sensor's normal
};

/// One reading: the mean over sensors at points of like light, and what it must be.
struct Reading {
  std::string place;
  std::vector<Sensor> sensors;
  double expected = 0;
  Quantity quantity = Quantity::illuminance;
};

struct AnalyticCase {
  std::string name;
  std::string source;  ///< what it follows, and the closed form
  Scene scene;         ///< one light
  std::vector<Reading> readings;
  /// The fraction of the requested photons that this case needs: cases whose readings are means
  /// over whole rooms need few.
  double photon_fraction = 1;
  /// The fraction of the requested neighbours that an estimate takes: the mean over many sensors is
  /// quiet with few, whose small discs see no curvature of the irradiance.
  double neighbour_fraction = 1;
  /// As RenderParameters has it: where rays find the direct light, the photons are those that were
  /// reflected, and none lies where it is not asked for.
  int direct_rays = 0;
};

/// All cases, in the order of the documentation. Expected values are computed from form factors,
/// not quoted: some of the tables printed in CIE 171:2006 are known to be wrong (Ashdown, "CIE
/// 171:2006 errata", 2016, on table 19 of case 5.7).
std::vector<AnalyticCase> analytic_cases();

// The parts of that list.
void add_direct_cases(std::vector<AnalyticCase>& cases);
void add_reflection_cases(std::vector<AnalyticCase>& cases);
void add_furnace_cases(std::vector<AnalyticCase>& cases);

inline constexpr double pi = glm::pi<double>();

Material diffuse(float albedo);

/// A flat rectangle: corner, two sides at a right angle. Its front is on the side of u x v.
struct Rectangle {
  glm::dvec3 corner, u, v;

  glm::dvec3 normal() const { return glm::normalize(glm::cross(u, v)); }
  double area() const { return glm::length(glm::cross(u, v)); }
  glm::dvec3 at(double along_u, double along_v) const { return corner + along_u * u + along_v * v; }
  /// Its front becomes its back.
  Rectangle turned() const { return {corner, v, u}; }
};

/// The walls of the box from the origin to `size`, fronts inwards: -x, +x, -y, +y, floor, ceiling.
std::vector<Rectangle> box_walls(const glm::dvec3& size);

/// On the fronts of rectangles, the middles of squares of 1 / `per_metre` metres: their mean is
/// that over the area where sides are whole numbers of squares.
std::vector<Sensor> grid_of_sensors(const std::vector<Rectangle>& rectangles, double per_metre);

class Room {
 public:
  /// `name` stands for the scene's file in messages.
  explicit Room(const std::string& name);

  std::uint32_t add_material(const Material& material);
  /// The scene's light.
  std::uint32_t add_light(LightKind kind);
  Light& light(std::uint32_t index) { return lights_[index]; }

  void add(const Rectangle& rectangle, std::uint32_t material, std::uint32_t light = none);
  void add_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                    std::uint32_t material, std::uint32_t light = none);
  /// A closed ball of flat facets between `rings` circles of latitude and twice as many meridians.
  /// Fronts outwards, or inwards.
  void add_ball(const glm::dvec3& centre, double radius, int rings, std::uint32_t material,
                bool inwards = false);

  /// The scene, its only light at `power` lumens. Call once.
  Scene build(double power) const;

 private:
  struct Triangle {
    std::array<glm::dvec3, 3> corners;
    std::uint32_t material, light;
  };
  std::string name_;
  std::vector<Material> materials_;
  std::vector<Light> lights_;
  std::vector<Triangle> triangles_;
};

// Form factors in closed form, in double precision.

/// Factor from a small surface at `point` with unit `normal` to a polygon that lies above its
/// horizon, in [0, 1]: irradiance from the polygon over pi times its radiance. Corners
/// counter-clockwise as seen from the point give a positive value (Lambert, Photometria, 1760; in
/// vectors: Baum, Rushmeier and Winget, "Improving radiosity solutions through the use of
/// analytically determined form-factors", 1989).
double polygon_factor(const glm::dvec3& point, const glm::dvec3& normal,
                      std::span<const glm::dvec3> corners);

/// The absolute value of the above for the parallelogram origin, origin + u, origin + u + v,
/// origin + v.
double rectangle_factor(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& origin,
                        const glm::dvec3& u, const glm::dvec3& v);

/// Factor between equal, opposed rectangles of sides `a` and `b` at distance `c`, metres (Howell,
/// "A catalog of radiation heat transfer configuration factors", C-11).
double opposed_rectangles_factor(double a, double b, double c);

/// Factor from a rectangle of depth `w` to one of height `h` at a right angle to it, with the
/// common edge `l`, metres (the same catalog, C-14).
double perpendicular_rectangles_factor(double w, double h, double l);

/// Luminance along the normal over the luminance of uniform surroundings: the integral of
/// f (n.i) over the hemisphere, for albedo and F0 of one channel, F90 = 1 and GGX `alpha`. Relative
/// error below 1e-5.
double glossy_reflectance(double albedo, double f0, double alpha);

}  // namespace photile::validation
