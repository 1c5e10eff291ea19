#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <nanoflann.hpp>

#include "support/bounded_heap.hpp"
#include "support/density_sum.hpp"
#include "support/host_search.hpp"

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

}  // namespace

class NanoflannIndex {
 public:
  explicit NanoflannIndex(const Photons& photons)
      : cloud_{photons.position}, tree_(3, cloud_, {10}) {
    tree_.buildIndex();
  }
  const Tree& tree() const { return tree_; }

 private:
  PointCloud cloud_;
  Tree tree_;
};

namespace {

/// nanoflann's own result set, bounded by the radius, behind the normal filter.
class FilteredList {
 public:
  using DistanceType = float;

  FilteredList(const SearchInput& input, const SearchParameters& parameters)
      : input_(input),
        parameters_(parameters),
        indices_(parameters.k),
        distances_(parameters.k),
        list_(parameters.k) {}

  void begin(std::uint32_t oriented_face) {
    oriented_face_ = oriented_face;
    list_.init(indices_.data(), distances_.data());
    distances_.back() = parameters_.radius * parameters_.radius;
  }
  bool full() const { return list_.full(); }
  float worstDist() const { return list_.worstDist(); }
  bool addPoint(float squared_distance, std::uint32_t photon) {
    if (!input_.filter.agree(input_.photons.oriented_face[photon], oriented_face_)) return true;
    return list_.addPoint(squared_distance, photon);
  }
  void end(std::size_t hit, DensityAnswers& answers) const {
    const std::size_t found = list_.size();
    sum_density(
        input_, parameters_, hit, found, found - 1, [this](std::size_t i) { return indices_[i]; },
        [this](std::size_t i) { return distances_[i]; }, answers);
  }

 private:
  const SearchInput& input_;
  const SearchParameters& parameters_;
  std::vector<std::uint32_t> indices_;
  std::vector<float> distances_;
  nanoflann::KNNResultSet<float, std::uint32_t> list_;
  std::uint32_t oriented_face_ = 0;
};

/// The filtered candidates, kept in a heap.
class FilteredHeap {
 public:
  using DistanceType = float;

  FilteredHeap(const SearchInput& input, const SearchParameters& parameters)
      : input_(input), parameters_(parameters), heap_(parameters.k) {}

  void begin(std::uint32_t oriented_face) {
    oriented_face_ = oriented_face;
    heap_.clear();
  }
  bool full() const { return heap_.full(); }
  float worstDist() const {
    return heap_.full() ? heap_.farthest() : parameters_.radius * parameters_.radius;
  }
  bool addPoint(float squared_distance, std::uint32_t photon) {
    // nanoflann looks at worstDist once a leaf; the heap needs it for each point.
    if (squared_distance >= worstDist()) return true;
    if (!input_.filter.agree(input_.photons.oriented_face[photon], oriented_face_)) return true;
    heap_.add({squared_distance, photon});
    return true;
  }
  void end(std::size_t hit, DensityAnswers& answers) const {
    const auto& found = heap_.entries();
    sum_density(
        input_, parameters_, hit, found.size(), 0, [&](std::size_t i) { return found[i].photon; },
        [&](std::size_t i) { return found[i].squared_distance; }, answers);
  }

 private:
  const SearchInput& input_;
  const SearchParameters& parameters_;
  BoundedHeap heap_;
  std::uint32_t oriented_face_ = 0;
};

template <class ResultSet>
class NanoflannSearch final : public HostSearch {
 public:
  NanoflannSearch(const SearchInput& input, std::shared_ptr<const NanoflannIndex> index)
      : input_(input), index_(std::move(index)) {}

  void estimate(const PrimaryHits& hits, std::span<const std::uint32_t> order,
                const SearchParameters& parameters, DensityAnswers& answers) const override {
    resize(answers, hits.size(), input_.light_count);
    constexpr std::size_t grain = 1024;
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, order.size(), grain), [&](const auto& range) {
          ResultSet results(input_, parameters);
          for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const std::uint32_t hit = order[i];
            results.begin(hits.oriented_face[hit]);
            index_->tree().findNeighbors(results, &hits.position[hit].x, nanoflann::SearchParams());
            results.end(hit, answers);
          }
        });
  }

 private:
  SearchInput input_;
  std::shared_ptr<const NanoflannIndex> index_;
};

}  // namespace

std::shared_ptr<const NanoflannIndex> make_nanoflann_index(const Photons& photons) {
  return std::make_shared<const NanoflannIndex>(photons);
}

std::unique_ptr<HostSearch> make_nanoflann_search(const SearchInput& input,
                                                  std::shared_ptr<const NanoflannIndex> index,
                                                  Candidates candidates) {
  if (candidates == Candidates::heap) {
    return std::make_unique<NanoflannSearch<FilteredHeap>>(input, std::move(index));
  }
  return std::make_unique<NanoflannSearch<FilteredList>>(input, std::move(index));
}

std::string nanoflann_version() {
  return fmt::format("{:x}.{:x}.{:x}", NANOFLANN_VERSION >> 8, (NANOFLANN_VERSION >> 4) & 0xF,
                     NANOFLANN_VERSION & 0xF);
}

}  // namespace photile::bench
