// Rivals on the host: the density estimate by nearest-neighbour libraries. They do the work of
// Estimator::estimate, with the threads of TBB, each with arrays of its own.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"

namespace photile::bench {

/// Which photons count at a hit: those of triangles whose normals agree with the hit's.
class NormalFilter {
 public:
  NormalFilter(const Scene& scene, double angle_degrees);
  /// A filter of given unit normals, one per oriented face.
  NormalFilter(std::vector<glm::vec3> normals, double angle_degrees);
  std::span<const glm::vec3> normals() const { return normals_; }
  bool agree(std::uint32_t a, std::uint32_t b) const {
    return a == b || glm::dot(normals_[a], normals_[b]) >= least_cosine_;
  }

 private:
  std::vector<glm::vec3> normals_;  ///< per oriented face
  float least_cosine_;
};

/// What is searched. Must outlive the search.
struct SearchInput {
  const Photons& photons;
  const NormalFilter& filter;
  std::size_t light_count;
};

struct SearchParameters {
  std::size_t k;
  float radius;  ///< metres
};

struct DensityAnswers {
  std::vector<glm::vec3> irradiance;  ///< [hit][light], as in Estimates
  std::vector<float> squared_radius;  ///< of the disc that flux is divided by, per hit
};

/// One index over all photons.
class HostSearch {
 public:
  virtual ~HostSearch() = default;
  /// Estimates at the hits, taken in the given order; answers are in the order of the hits.
  virtual void estimate(const PrimaryHits& hits, std::span<const std::uint32_t> order,
                        const SearchParameters& parameters, DensityAnswers& answers) const = 0;
};

/// How nanoflann keeps its candidates.
enum class Candidates {
  sorted_list,  ///< nanoflann's own KNNResultSet
  heap          ///< BoundedHeap: better for large k
};

class NanoflannIndex;
/// nanoflann's 3D kd-tree with leaves of 10, built on one thread.
std::shared_ptr<const NanoflannIndex> make_nanoflann_index(const Photons& photons);
/// A search over an index of the same photons; several may share one.
std::unique_ptr<HostSearch> make_nanoflann_search(const SearchInput& input,
                                                  std::shared_ptr<const NanoflannIndex> index,
                                                  Candidates candidates);
/// Embree's rtcPointQuery over a bounding volume hierarchy of points.
std::unique_ptr<HostSearch> make_embree_search(const SearchInput& input);

std::string nanoflann_version();
std::string embree_version();

}  // namespace photile::bench
