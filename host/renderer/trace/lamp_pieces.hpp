// Which lamp to look at from a point of a surface: what is near and faces it more often.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "photile/photons.hpp"
#include "photile/scene.hpp"
#include "trace/random_stream.hpp"

namespace photile::trace {

/// How likely looks from a point choose each piece of the lamps. Empty: as from everywhere, by the
/// shares of lamps alone.
struct LampChances {
  std::vector<double> up_to;  ///< of the pieces up to and with this one; the last is their sum

  double of(std::size_t piece) const {
    return (up_to[piece] - (piece == 0 ? 0.0 : up_to[piece - 1])) / up_to.back();
  }
};

/// The chances of looks from everywhere.
inline const LampChances by_shares_alone;

/// Lamps cut into pieces: an area light may be many small lamps of a room. A piece's weight at a
/// point is what it would send there if nothing stood between, at most, as in light trees (Conty
/// Estevez and Kulla, "Importance sampling of many lights with adaptive tree splitting", 2018);
/// half of the looks go by the shares of lamps all the same, since much may stand between. Pieces
/// are few enough to weigh them all.
class LampPieces {
 public:
  /// Errors: none; there are no pieces where there are too many lamps to weigh each.
  ///   shares   of the lights, summing to 1: what looks from everywhere go by
  LampPieces(const Scene& scene, std::span<const double> shares, const BoundingSphere& bounds);

  /// The selection probabilities of light samples from a point of a surface; empty where there are
  /// no clusters.
  ///   normal   unit, to the side from which is looked
  void weigh(const glm::vec3& position, const glm::vec3& normal, LampChances& chances) const;

  /// What is chosen: a light, and one of its triangles by their area.
  struct Choice {
    std::uint32_t light;
    std::uint32_t piece;
    std::uint32_t triangle;  ///< into Light::triangles, where the light can be cut; else `none`
  };
  /// By chances that are not empty.
  ///   choice, place   blocks as LightSampler::sample takes them
  Choice choose(const LampChances& chances, const RandomBlock& choice,
                const RandomBlock& place) const;

  /// That a light is, if it cannot be cut; else `none`.
  std::uint32_t whole(std::uint32_t light) const { return whole_[light]; }
  /// The cluster of a triangle of a light that can be cut.
  std::uint32_t piece_of(std::uint32_t triangle) const { return of_triangle_[triangle]; }
  /// The area of one side of a cluster of such a light, square metres.
  double area(std::uint32_t piece) const {
    return triangles_[pieces_[piece].last - 1].area_up_to - area_before(pieces_[piece]);
  }

 private:
  struct Piece {
    std::uint32_t light;
    std::uint32_t first = 0, last = 0;  ///< of `triangles_`; none of lights that cannot be cut
    bool is_far = false;                ///< beyond the scene
    float share;
    glm::vec3 center{0.0f};  ///< of a sphere that holds it, metres
    float radius = 0;
    glm::vec3 axis{0.0f};  ///< of a cone that holds the normals of what shines
    float cone_cosine = -1, cone_sine = 0;
  };
  struct Triangle {
    std::uint32_t number;  ///< into Light::triangles
    double area_up_to;     ///< of those of the light up to and with this one, square metres
  };

  void add_area_light(const Scene& scene, Piece piece);
  void enclose(const Scene& scene, Piece& piece) const;
  void sum_areas(const Scene& scene, const Piece& piece);
  bool cut(const Scene& scene, std::size_t piece);
  double area_before(const Piece& piece) const;
  float weight(const Piece& piece, const glm::vec3& position, const glm::vec3& normal) const;

  std::vector<Piece> pieces_;
  std::vector<Triangle> triangles_;         ///< of area lights without textures, by piece
  std::vector<std::uint32_t> whole_;        ///< per light: its piece, if it cannot be cut
  std::vector<std::uint32_t> of_triangle_;  ///< pieces of those of the scene
  float far_;                               ///< 1 / squared radius of the scene, 1/m2
};

// How lights share what is drawn from all of them.

/// Share of each light, summing to 1 up to rounding; above 0 unless `quota` is `power`.
std::vector<double> light_shares(const std::vector<Light>& lights, PhotonQuota quota);

}  // namespace photile::trace
