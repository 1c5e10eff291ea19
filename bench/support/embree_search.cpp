// The benches' only file that includes Embree.
#include <embree3/rtcore.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "support/bounded_heap.hpp"
#include "support/neighbour_answers.hpp"

namespace photile::bench {
namespace {

/// One query on its way through Embree.
struct Visit {
  const SearchInput& input;
  BoundedHeap& heap;
  glm::vec3 position;
  float squared_radius;
  std::uint32_t oriented_face;
};

/// Box of a photon: the point itself.
void point_bounds(const RTCBoundsFunctionArguments* arguments) {
  const auto& positions = *static_cast<const std::vector<glm::vec3>*>(arguments->geometryUserPtr);
  const glm::vec3& p = positions[arguments->primID];
  *arguments->bounds_o = {p.x, p.y, p.z, 0, p.x, p.y, p.z, 0};
}

/// Offers a photon to the heap; true when the radius of the query shrank.
bool offer_photon(RTCPointQueryFunctionArguments* arguments) {
  Visit& visit = *static_cast<Visit*>(arguments->userPtr);
  const std::uint32_t photon = arguments->primID;
  const glm::vec3 d = visit.input.photons.position[photon] - visit.position;
  const float squared_distance = d.x * d.x + d.y * d.y + d.z * d.z;
  if (squared_distance >= visit.squared_radius) return false;
  if (!visit.input.counts(photon, visit.oriented_face)) return false;
  visit.heap.add({squared_distance, photon});
  if (!visit.heap.full()) return false;
  visit.squared_radius = visit.heap.farthest();
  // Rounded up: the root of a float may fall just below the distance.
  arguments->query->radius =
      std::nextafter(std::sqrt(visit.squared_radius), std::numeric_limits<float>::infinity());
  return true;
}

/// What a thread needs between its queries.
struct EmbreeWorker {
  BoundedHeap heap;
  float radius;
};

class EmbreeSearch final : public HitByHit<EmbreeSearch> {
 public:
  explicit EmbreeSearch(const SearchInput& input) : HitByHit(input) {
    device_ = rtcNewDevice(nullptr);
    if (!device_) throw std::runtime_error("Embree gives no device");
    scene_ = rtcNewScene(device_);
    const RTCGeometry points = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(points, static_cast<unsigned>(input.photons.size()));
    rtcSetGeometryUserData(points, const_cast<std::vector<glm::vec3>*>(&input_.photons.position));
    rtcSetGeometryBoundsFunction(points, point_bounds, nullptr);
    rtcCommitGeometry(points);
    rtcAttachGeometry(scene_, points);
    rtcReleaseGeometry(points);
    rtcCommitScene(scene_);
  }
  ~EmbreeSearch() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeSearch(const EmbreeSearch&) = delete;
  EmbreeSearch& operator=(const EmbreeSearch&) = delete;

  EmbreeWorker make_worker(const SearchParameters& parameters) const {
    return {BoundedHeap(parameters.k), parameters.radius};
  }
  template <class Write>
  void find(EmbreeWorker& worker, const PrimaryHits& hits, std::uint32_t hit, Write write) const {
    worker.heap.clear();
    const glm::vec3& p = hits.position[hit];
    Visit visit{input_, worker.heap, p, worker.radius * worker.radius, hits.oriented_face[hit]};
    RTCPointQuery point_query{p.x, p.y, p.z, 0.0f, worker.radius};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &point_query, &context, offer_photon, &visit);
    const auto& entries = worker.heap.entries();
    write(FoundNeighbours{entries.size(), std::size_t{0},
                          [&](std::size_t i) { return entries[i].photon; },
                          [&](std::size_t i) { return entries[i].squared_distance; }});
  }

 private:
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

}  // namespace

std::unique_ptr<HostSearch> make_embree_search(const SearchInput& input) {
  return std::make_unique<EmbreeSearch>(input);
}

std::string embree_version() { return RTC_VERSION_STRING; }

}  // namespace photile::bench
