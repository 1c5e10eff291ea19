// Compiled for each nanoflann: given_nanoflann_search.cpp includes it under other names.
#include <fmt/format.h>

#include <nanoflann.hpp>

#include "support/bounded_heap.hpp"
#include "support/neighbour_answers.hpp"

#ifndef PHOTILE_NANOFLANN_NAME
#define PHOTILE_NANOFLANN_NAME "nanoflann"
#endif

namespace photile::bench {
namespace {

/// The photons as nanoflann reads them, in place.
struct PointCloud {
  const std::vector<glm::vec3>& positions;
  std::size_t kdtree_get_point_count() const { return positions.size(); }
  float kdtree_get_pt(std::size_t point, std::size_t axis) const {
    return positions[point][static_cast<int>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PointCloud>,
                                                 PointCloud, 3, std::uint32_t>;

#if NANOFLANN_VERSION < 0x150
using Parameters = nanoflann::SearchParams;
/// Has no set that is bounded by a radius: its farthest place takes the bound.
class ResultSet : public nanoflann::KNNResultSet<float, std::uint32_t> {
 public:
  ResultSet(std::size_t k, float squared_radius)
      : KNNResultSet(k), k_(k), squared_radius_(squared_radius) {}
  void init(std::uint32_t* indices, float* distances) {
    KNNResultSet::init(indices, distances);
    distances[k_ - 1] = squared_radius_;
  }

 private:
  std::size_t k_;
  float squared_radius_;
};
#else
using Parameters = nanoflann::SearchParameters;
using ResultSet = nanoflann::RKNNResultSet<float, std::uint32_t>;
#endif

struct Index {
  Index(const Photons& photons, std::size_t leaf_size)
      : cloud{photons.position}, tree(3, cloud, {leaf_size}) {
    tree.buildIndex();
  }
  PointCloud cloud;
  Tree tree;
};

/// nanoflann's own result set, bounded by the radius, behind the normal filter.
class FilteredList {
 public:
  using DistanceType = float;
  using IndexType = std::uint32_t;

  FilteredList(const SearchInput& input, const SearchParameters& parameters)
      : input_(input),
        indices_(parameters.k),
        distances_(parameters.k),
        list_(parameters.k, parameters.radius * parameters.radius) {}

  void begin(std::uint32_t oriented_face) {
    oriented_face_ = oriented_face;
    list_.init(indices_.data(), distances_.data());
  }
  bool full() const { return list_.full(); }
  float worstDist() const { return list_.worstDist(); }
  void sort() const {}  // it is
  bool addPoint(float squared_distance, std::uint32_t photon) {
    if (!input_.counts(photon, oriented_face_)) return true;
    return list_.addPoint(squared_distance, photon);
  }
  auto found() const {
    return FoundNeighbours{list_.size(), list_.size() - 1,
                           [this](std::size_t i) { return indices_[i]; },
                           [this](std::size_t i) { return distances_[i]; }};
  }

 private:
  const SearchInput& input_;
  std::vector<std::uint32_t> indices_;
  std::vector<float> distances_;
  ResultSet list_;
  std::uint32_t oriented_face_ = 0;
};

/// The filtered candidates, kept in a heap.
class FilteredHeap {
 public:
  using DistanceType = float;
  using IndexType = std::uint32_t;

  FilteredHeap(const SearchInput& input, const SearchParameters& parameters)
      : input_(input),
        squared_radius_(parameters.radius * parameters.radius),
        heap_(parameters.k) {}

  void begin(std::uint32_t oriented_face) {
    oriented_face_ = oriented_face;
    heap_.clear();
  }
  bool full() const { return heap_.full(); }
  float worstDist() const { return heap_.full() ? heap_.farthest() : squared_radius_; }
  void sort() const {}
  bool addPoint(float squared_distance, std::uint32_t photon) {
    // Debian's nanoflann looks at worstDist once a leaf; the heap needs it for each point.
    if (squared_distance >= worstDist()) return true;
    if (input_.counts(photon, oriented_face_)) heap_.add({squared_distance, photon});
    return true;
  }
  auto found() const {
    const auto& entries = heap_.entries();
    return FoundNeighbours{entries.size(), std::size_t{0},
                           [&entries](std::size_t i) { return entries[i].photon; },
                           [&entries](std::size_t i) { return entries[i].squared_distance; }};
  }

 private:
  const SearchInput& input_;
  float squared_radius_;
  BoundedHeap heap_;
  std::uint32_t oriented_face_ = 0;
};

template <class Candidates>
class NanoflannSearch final : public HitByHit<NanoflannSearch<Candidates>> {
 public:
  NanoflannSearch(const SearchInput& input, std::shared_ptr<const Index> index)
      : HitByHit<NanoflannSearch>(input), index_(std::move(index)) {}

  Candidates make_worker(const SearchParameters& parameters) const {
    return {this->input_, parameters};
  }
  template <class Write>
  void find(Candidates& candidates, const PrimaryHits& hits, std::uint32_t hit, Write write) const {
    candidates.begin(hits.oriented_face[hit]);
    index_->tree.findNeighbors(candidates, &hits.position[hit].x, Parameters());
    write(candidates.found());
  }

 private:
  std::shared_ptr<const Index> index_;
};

}  // namespace

Nanoflann nanoflann_of_system() {
#if NANOFLANN_VERSION < 0x10000
  constexpr int digit = 4;
#else
  constexpr int digit = 8;
#endif
  const auto part = [](int place) {
    return (NANOFLANN_VERSION >> (place * digit)) & ((1 << digit) - 1);
  };
  return {PHOTILE_NANOFLANN_NAME, fmt::format("{}.{}.{}", part(2), part(1), part(0)),
          [](const SearchInput& input, std::size_t leaf_size) {
            const auto index = std::make_shared<const Index>(input.photons, leaf_size);
            return Nanoflann::Searches{
                std::make_unique<NanoflannSearch<FilteredList>>(input, index),
                std::make_unique<NanoflannSearch<FilteredHeap>>(input, index)};
          }};
}

}  // namespace photile::bench
