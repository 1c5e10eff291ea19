// Light maps as textures: a position on one picture for every triangle, and the light there.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "cache/light_maps.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"

namespace photile::bake {

/// A rectangle of a picture, in texels.
struct TexelRectangle {
  std::uint32_t x = 0, y = 0;  ///< its first texel
  std::uint32_t width = 0, height = 0;
};

struct Atlas {
  std::uint32_t width = 0, height = 0;
};

/// Places rectangles on shelves, the highest first (Coffman et al., "Performance bounds for
/// level-oriented two-dimensional packing algorithms", 1980: next-fit decreasing height), on a
/// picture about as wide as high. Nothing where no picture of this side holds them.
std::optional<Atlas> pack(std::span<TexelRectangle> rectangles, std::uint32_t most_side);

struct BakeParameters {
  double texel = 0;   ///< metres between texels, at most; 0 = half the coarsest nodes
  bool exact = true;  ///< a texel that is given is not made larger where the picture is too small
  int most_side = 4096;                           ///< of the picture
  std::uint64_t most_texels = ~std::uint64_t{0};  ///< of the picture's area
  std::vector<double> powers;      ///< per layer, by which the brighter side of a surface is found
  std::vector<std::uint8_t> open;  ///< as open_sides; empty = all sides are
};

/// The surface that is visible or that light can reach: the insides of closed objects need no light
/// maps. Per oriented face 1 where paths from the cameras and the lights come to it, or to its
/// sheet: what goes on over common edges. Else 0. Paths leave surfaces by the cosine and go on
/// through glass and cutouts, too. Depends on the scene alone.
std::vector<std::uint8_t> open_sides(const RayScene& rays);

/// Per oriented face 1 where such paths from the cameras alone come to it: the visible surface.
std::vector<std::uint8_t> seen_sides(const RayScene& rays);

/// A triangle on another: per corner the weights of the other's corners. Counter-clockwise as seen
/// from the side that it belongs to.
using DrawnTriangle = std::array<glm::vec3, 3>;

/// What an attribute of the corners of a triangle is at these weights.
template <class Value>
Value at_weights(const std::array<Value, 3>& corner, const glm::vec3& weights) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (weights[static_cast<int>(i)] == 1.0f) return corner[i];
  }
  return weights.x * corner[0] + weights.y * corner[1] + weights.z * corner[2];
}

/// The charts of the light maps side by side: of each triangle the side on which more light falls,
/// and the other where it is open and lit, too. Texels are points of the charts' lattices, so that
/// bilinear filtering blends neighbours of one chart; a border of one texel repeats the last.
/// Texels under things that stand on a surface hold the light beside these, for lookups there.
class BakedLight {
 public:
  /// Values the nodes that texels need. Errors: UsageError where the charts do not fit the picture
  /// at this distance of texels; those of LightMaps::fill.
  ///   progress   reports a stage
  BakedLight(const Scene& scene, cache::LightMaps& maps, const BakeParameters& parameters,
             Progress& progress);

  std::uint32_t width() const { return atlas_.width; }
  std::uint32_t height() const { return atlas_.height; }
  double texel() const { return texel_; }

  /// The oriented faces that are baked, ascending.
  std::span<const std::uint32_t> sides() const { return sides_; }
  /// Texture coordinates of a baked triangle's corners: (0, 0) is the top left corner of the
  /// picture.
  std::array<glm::vec2, 3> corners(std::uint32_t oriented_face) const;
  /// The triangles that a baked side is drawn by: itself, or those of its parts in which no other
  /// face in its place counts.
  std::vector<DrawnTriangle> drawn(std::uint32_t oriented_face) const;

  /// Irradiance of a layer at power 1: width x height, row 0 at the top; 0 where no chart lies.
  /// Where nodes know how light depends on the normal it is that of the shading normal.
  std::vector<glm::vec3> layer(std::size_t layer) const;
  /// Standard error of the luminance of `layer`, in the same form, from that of nodes.
  ///   of_nodes   as GatheredNodes::errors
  std::vector<float> errors(std::size_t layer, const LightTable& of_nodes) const;
  /// Root mean square of the standard errors of all light together, relative to the mean light:
  /// texels without light have none.
  ///   powers   per layer
  double standard_error(std::span<const double> powers, const LightTable& of_nodes) const;
  /// Per layer whether its light is on any texel of these sides.
  ///   sides   per oriented face 1, else 0
  std::vector<bool> reaches(std::span<const std::uint8_t> sides, std::size_t layers) const;
  /// The number of texels of the charts, without those between charts.
  std::uint64_t used_texels() const;

 private:
  struct Placed {
    std::uint32_t chart;
    glm::uvec2 cells;  ///< between texels
    TexelRectangle rectangle;
  };

  void choose_sides(const BakeParameters& parameters, const Progress& progress);
  bool place_charts(double texel, std::uint32_t most_side);
  /// Returns the points of all texels; the side is none where there is none.
  PrimaryHits fill(Progress& progress);
  void spread(const PrimaryHits& points);
  glm::dvec2 place(const Placed& placed, std::uint32_t x, std::uint32_t y) const;
  glm::vec3 point(const Placed& placed, std::uint32_t x, std::uint32_t y) const;

  const Scene& scene_;
  cache::LightMaps& maps_;
  std::vector<std::uint32_t> sides_;
  double texel_ = 0;
  Atlas atlas_;
  std::vector<Placed> placed_;
  std::vector<std::uint32_t> place_of_chart_;     ///< into placed_, or none
  std::vector<std::uint32_t> member_;             ///< per chart: an oriented face of it
  std::vector<cache::BilinearWeights> bilinear_;  ///< per texel
  std::vector<glm::vec3> normal_;                 ///< per texel, where light depends on it
};

}  // namespace photile::bake
