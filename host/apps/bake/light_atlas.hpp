// Where the light of each surface lies on one picture: the charts of light maps side by side.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "cache/charts.hpp"
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

/// Whether a face is drawn: no other in its place counts instead of all of it.
bool is_drawn(const Scene& scene, const cache::Charts& charts, std::uint32_t oriented_face);

/// The charts of some sides, side by side. Texels are points of the charts' lattices, so that
/// bilinear filtering blends neighbours of one chart; a border of one texel repeats the last.
class LightAtlas {
 public:
  /// References are kept.
  ///   sides   the oriented faces that are baked, ascending
  /// Errors: UsageError where the charts do not fit the picture at this distance of texels.
  LightAtlas(const Scene& scene, const cache::Charts& charts, std::vector<std::uint32_t> sides,
             const BakeParameters& parameters);

  std::uint32_t width() const { return atlas_.width; }
  std::uint32_t height() const { return atlas_.height; }
  double texel() const { return texel_; }
  std::size_t area() const { return std::size_t{atlas_.width} * atlas_.height; }

  /// The oriented faces that are baked, ascending.
  std::span<const std::uint32_t> sides() const { return sides_; }
  /// Texture coordinates of a baked triangle's corners: (0, 0) is the top left corner of the
  /// picture.
  std::array<glm::vec2, 3> corners(std::uint32_t oriented_face) const;
  /// The triangles that a baked side is drawn by: itself, or those of its parts in which no other
  /// face in its place counts.
  std::vector<DrawnTriangle> drawn(std::uint32_t oriented_face) const;
  /// The number of texels of the charts, without those between charts.
  std::uint64_t used_texels() const;

  /// Texels of the charts, and the point of the surface that each stands for.
  struct TexelPoints {
    std::vector<std::size_t> texels;
    PrimaryHits hits;
  };
  /// Appends those of chart `i` of `chart_count()`. Charts::prepare has been called for it.
  void add_points(std::size_t i, TexelPoints& points) const;
  std::size_t chart_count() const { return placed_.size(); }
  std::uint32_t chart(std::size_t i) const { return placed_[i].chart; }

 protected:
  struct Placed {
    std::uint32_t chart;
    glm::uvec2 cells;  ///< between texels
    TexelRectangle rectangle;
  };

  std::span<const Placed> placed() const { return placed_; }
  /// An oriented face of a chart.
  std::uint32_t member(std::uint32_t chart) const { return member_[chart]; }
  glm::vec3 point(const Placed& placed, std::uint32_t x, std::uint32_t y) const;

  const Scene& scene_;

 private:
  bool place_charts(double texel, std::uint32_t most_side);
  glm::dvec2 place(const Placed& placed, std::uint32_t x, std::uint32_t y) const;

  const cache::Charts& charts_;
  std::vector<std::uint32_t> sides_;
  double texel_ = 0;
  Atlas atlas_;
  std::vector<Placed> placed_;
  std::vector<std::uint32_t> place_of_chart_;  ///< into placed_, or none
  std::vector<std::uint32_t> member_;          ///< per chart: an oriented face of it
};

}  // namespace photile::bake
