// Rivals on the host: the density estimate, and the lists of neighbours, by nearest-neighbour
// libraries. They do the work of Estimator, with the threads of TBB, each with arrays of its own.
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
  /// Whether these faces have one normal, so that nobody need look.
  bool all_agree(std::span<const std::uint32_t> photons, std::span<const std::uint32_t> hits) const;

 private:
  std::vector<glm::vec3> normals_;  ///< per oriented face
  float least_cosine_;
};

/// What is searched. Must outlive the search.
struct SearchInput {
  const Photons& photons;
  const NormalFilter* filter;  ///< null: photons count whatever their normal
  std::size_t light_count;

  bool counts(std::uint32_t photon, std::uint32_t face_of_hit) const {
    return !filter || filter->agree(photons.oriented_face[photon], face_of_hit);
  }
};

struct SearchParameters {
  std::size_t k;
  float radius;  ///< metres
};

struct DensityAnswers {
  std::vector<glm::vec3> irradiance;  ///< [hit][light], as in LightTable
  std::vector<float> squared_radius;  ///< of the disc that flux is divided by, per hit
};

/// Neighbours of a batch of hits, as in NeighbourLists, in the order of the library.
struct ListAnswers {
  std::vector<std::uint32_t> photons;  ///< hits x k: indices, `none` beyond the last
  std::vector<float> squared_radius;   ///< per hit
};

/// One index over all photons.
class HostSearch {
 public:
  virtual ~HostSearch() = default;
  /// Estimates at the hits, taken in the given order; answers are in the order of the hits.
  virtual void estimate(const PrimaryHits& hits, std::span<const std::uint32_t> order,
                        const SearchParameters& parameters, DensityAnswers& answers) const = 0;
  /// The neighbours themselves.
  virtual void nearest(const PrimaryHits& hits, std::span<const std::uint32_t> order,
                       const SearchParameters& parameters, ListAnswers& answers) const = 0;
};

/// A nanoflann that the benches were built with.
struct Nanoflann {
  std::string name;  ///< of rows
  std::string version;
  /// Its 3D kd-tree, with leaves of so many, built on one thread; a search of each kind over it.
  struct Searches {
    std::unique_ptr<HostSearch> sorted_list;  ///< candidates in the library's own result set
    std::unique_ptr<HostSearch> heap;         ///< in a BoundedHeap: better for large k
  };
  Searches (*make)(const SearchInput& input, std::size_t leaf_size);
};

Nanoflann nanoflann_of_system();
Nanoflann nanoflann_given();  ///< of the header that CMake was given; only where it was

/// Embree's rtcPointQuery over a bounding volume hierarchy of points.
std::unique_ptr<HostSearch> make_embree_search(const SearchInput& input);
std::string embree_version();

}  // namespace photile::bench
