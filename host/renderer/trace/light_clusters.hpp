// Selection of the light to sample from a point of a surface: lights that are near and face it are
// chosen more often.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "photile/photons.hpp"
#include "photile/scene.hpp"
#include "trace/portals.hpp"
#include "trace/random_stream.hpp"

namespace photile::trace {

/// The probabilities with which light samples from a point choose each cluster of lights and each
/// portal. Empty: the same for all points, by the power of lights alone.
struct SelectionProbabilities {
  std::vector<double>
      up_to;               ///< of the clusters up to and including this one; the last is their sum
  PortalSizes portals;     ///< empty where there are none, or they are not known
  bool but_apart = false;  ///< without LightSampler::sampled_apart

  double of(std::size_t cluster) const {
    return (up_to[cluster] - (cluster == 0 ? 0.0 : up_to[cluster - 1])) / up_to.back();
  }
};

/// The probabilities that are the same for all points.
inline const SelectionProbabilities by_power_alone;

/// Lights cut into clusters: an area light may consist of many small lights in a room. A cluster's
/// weight at a point is an upper bound of what it would send there without occlusion, as in light
/// trees (Conty Estevez and Kulla, "Importance sampling of many lights with adaptive tree
/// splitting", 2018); half of the samples are still chosen by the power of lights, since occlusion
/// is unknown. Clusters are few enough to compute all of their weights.
class LightClusters {
 public:
  /// With more lights than this, weighing each would cost more than it saves.
  static constexpr std::size_t most_lights = 1024;

  /// Errors: none; there are no clusters where there are too many lights to weigh each.
  ///   fractions   of the lights, summing to 1: by which light samples are chosen whatever the
  ///   point left_out    lights of no cluster, ascending
  LightClusters(const Scene& scene, std::span<const double> fractions, const BoundingSphere& bounds,
                std::span<const std::uint32_t> left_out = {});

  /// The selection probabilities of light samples from a point of a surface; empty where there are
  /// no clusters.
  ///   normal   unit, towards the side of the samples
  void weigh(const glm::vec3& position, const glm::vec3& normal,
             SelectionProbabilities& probabilities) const;

  /// A choice: a light, and one of its triangles by their area.
  struct Choice {
    std::uint32_t light;
    std::uint32_t cluster;
    std::uint32_t triangle;  ///< into Light::triangles, where the light can be cut; else `none`
  };
  /// Chooses a cluster by probabilities that are not empty.
  ///   choice, on_light   blocks as for LightSampler::sample
  Choice choose(const SelectionProbabilities& probabilities, const RandomBlock& choice,
                const RandomBlock& on_light) const;

  /// The cluster that a light is as a whole, if it cannot be cut; else `none`.
  std::uint32_t whole(std::uint32_t light) const { return whole_[light]; }
  /// The cluster of a triangle of a light that can be cut.
  std::uint32_t cluster_of(std::uint32_t triangle) const { return of_triangle_[triangle]; }
  /// The area of one side of a cluster of such a light, square metres.
  double area(std::uint32_t cluster) const {
    return triangles_[clusters_[cluster].last - 1].area_up_to - area_before(clusters_[cluster]);
  }

 private:
  struct Cluster {
    std::uint32_t light;
    std::uint32_t first = 0, last = 0;  ///< of `triangles_`; none of lights that cannot be cut
    bool is_far = false;                ///< beyond the scene
    float fraction;
    glm::vec3 center{0.0f};  ///< of a sphere that holds it, metres
    float radius = 0;
    glm::vec3 axis{0.0f};  ///< of a cone that contains the normals of emitting surfaces
    float cone_cosine = -1, cone_sine = 0;
  };
  struct Triangle {
    std::uint32_t number;  ///< into Light::triangles
    double area_up_to;     ///< of the light's triangles up to and including this one, square metres
  };

  void add_area_light(const Scene& scene, Cluster cluster);
  void enclose(const Scene& scene, Cluster& cluster) const;
  void sum_areas(const Scene& scene, const Cluster& cluster);
  bool cut(const Scene& scene, std::size_t cluster);
  double area_before(const Cluster& cluster) const;
  float weight(const Cluster& cluster, const glm::vec3& position, const glm::vec3& normal) const;

  std::vector<Cluster> clusters_;
  std::vector<Triangle> triangles_;         ///< of area lights without textures, by cluster
  std::vector<std::uint32_t> whole_;        ///< per light: its cluster, if it cannot be cut
  std::vector<std::uint32_t> of_triangle_;  ///< clusters of those of the scene
  float far_;                               ///< 1 / squared radius of the scene, 1/m2
};

/// Fraction of each light, summing to 1 up to rounding; above 0 unless `quota` is `power`.
std::vector<double> light_fractions(const std::vector<Light>& lights, PhotonQuota quota);

}  // namespace photile::trace
