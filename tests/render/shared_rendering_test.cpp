// Photons that several processes share; threads stand in for them. Pictures of real processes are
// in tests/equal_bits and tests/cluster.
#include <barrier>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstring>
#include <exception>
#include <functional>
#include <mutex>
#include <numeric>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "photile/communicator.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"
#include "photile/renderer.hpp"
#include "photile/surface_index.hpp"
#include "render/shared_photons.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

// Threads of one process that stand in for several processes.

/// What the threads share: a place for what each gives.
struct ThreadGroup {
  explicit ThreadGroup(std::uint32_t size)
      : given(size), meeting(static_cast<std::ptrdiff_t>(size)) {}
  std::vector<std::vector<Communicator::Bytes>> given;  ///< [from][to]
  std::barrier<> meeting;
};

class ThreadCommunicator : public Communicator {
 public:
  ThreadCommunicator(ThreadGroup& group, std::uint32_t rank) : group_(group), rank_(rank) {}
  std::uint32_t rank() const override { return rank_; }
  std::uint32_t size() const override { return static_cast<std::uint32_t>(group_.given.size()); }
  std::uint32_t on_this_machine() const override { return size(); }
  Traffic traffic() const override { return traffic_; }
  Conclusion conclude(int, const std::function<void()>&) override { return {}; }

  std::vector<Bytes> exchange(std::vector<Bytes> to_each) override {
    ++traffic_.calls;
    group_.given[rank_] = std::move(to_each);
    group_.meeting.arrive_and_wait();
    std::vector<Bytes> from;
    for (const auto& all : group_.given) from.push_back(all[rank_]);
    group_.meeting.arrive_and_wait();
    return from;
  }
  std::vector<Bytes> gather(std::span<const std::byte> own) override {
    return exchange(std::vector<Bytes>(size(), Bytes(own.begin(), own.end())));
  }
  void sum(std::span<std::uint64_t> values) override {
    std::vector<std::uint64_t> sums(values.size(), 0);
    for (const Bytes& bytes : gather(std::as_bytes(values))) add(bytes, sums);
    std::copy(sums.begin(), sums.end(), values.begin());
  }
  std::vector<std::uint64_t> sum_before(std::span<const std::uint64_t> values) override {
    std::vector<std::uint64_t> sums(values.size(), 0);
    const std::vector<Bytes> all = gather(std::as_bytes(values));
    for (std::uint32_t r = 0; r < rank_; ++r) add(all[r], sums);
    return sums;
  }

 private:
  static void add(const Bytes& bytes, std::vector<std::uint64_t>& sums) {
    std::vector<std::uint64_t> values(sums.size());
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += values[i];
  }

  ThreadGroup& group_;
  std::uint32_t rank_;
  Traffic traffic_;
};

/// Runs work(communicator) on so many threads. It must not throw on some of them alone.
void on_threads(std::uint32_t size, const std::function<void(Communicator&)>& work) {
  ThreadGroup group(size);
  std::vector<std::exception_ptr> errors(size);
  {
    std::vector<std::jthread> threads;
    for (std::uint32_t rank = 0; rank < size; ++rank) {
      threads.emplace_back([&, rank] {
        ThreadCommunicator communicator(group, rank);
        try {
          work(communicator);
        } catch (...) {
          errors[rank] = std::current_exception();
        }
      });
    }
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

TEST_CASE("each process has all photons of its maps, in the order of one process, and no others") {
  const Scene scene = furnished_room(6);
  const RayScene rays(scene);
  constexpr double radius = 0.15;
  constexpr std::uint32_t processes = 4;
  const PhotonTracerParameters tracing{.emitted_photons = 20'000};
  const Photons all = trace_photons(rays, tracing).photons;
  const NeighbourGroups groups =
      find_map_groups(scene, all, MapMode::patch, {radius, 60}, Progress::none());
  std::vector<std::uint64_t> owned(processes), held(processes);
  on_threads(processes, [&](Communicator& communicator) {
    PhotonTracerParameters own = tracing;
    own.shard = {communicator.rank(), communicator.size()};
    Photons photons = trace_photons(rays, own).photons;
    photons.of_all = photons_of_all(communicator, photons);
    const bool known =
        photons.of_all->count == all.size() && photons.of_all->landed == landed_on(scene, all) &&
        find_map_groups(scene, photons, MapMode::patch, {radius, 60}).members == groups.members &&
        automatic_radius(photons, 20) == automatic_radius(all, 20);
    const MapOwners owners(scene, groups.patches, photons.of_all->landed, processes);
    SentData sent;
    photons = to_owners(communicator, scene, groups, owners, radius, std::move(photons), sent);
    held[communicator.rank()] = photons.size();
    // It holds every photon of the triangles that it answers for, and those of others within the
    // radius.
    bool same = known;
    std::size_t lacking = 0;
    for (std::uint32_t s = 0; s + 1 < all.first_of.size(); ++s) {
      const bool own_triangle = owners.of(s) == communicator.rank();
      std::uint32_t next = photons.first_of[s];
      for (std::uint32_t i = all.first_of[s]; i < all.first_of[s + 1]; ++i) {
        const bool there = next < photons.first_of[s + 1] &&
                           photons.position[next] == all.position[i] &&
                           photons.flux[next] == all.flux[i];
        if (there) {
          ++next;
          owned[communicator.rank()] += own_triangle ? 1 : 0;
          continue;
        }
        same = same && !own_triangle;
        for (const std::uint32_t map : groups.of(s)) {
          if (owners.of_map(map) != communicator.rank()) continue;
          for (const std::uint32_t member : groups.patches.of(map / 2)) {
            const auto corners = scene.corners(triangle_of(member));
            const glm::dvec3 p(all.position[i]);
            const double apart = triangle_triangle_distance(
                {glm::dvec3(corners[0]), glm::dvec3(corners[1]), glm::dvec3(corners[2])},
                {p, p + glm::dvec3(1e-9, 0, 0), p + glm::dvec3(0, 1e-9, 0)});
            lacking += apart < 0.999 * radius ? 1 : 0;
          }
        }
      }
      same = same && next == photons.first_of[s + 1];
    }
    static std::mutex catch_is_no_friend_of_threads;
    const std::scoped_lock lock(catch_is_no_friend_of_threads);
    CHECK(same);
    CHECK(lacking == 0);
  });
  CHECK(std::accumulate(owned.begin(), owned.end(), std::uint64_t{0}) == all.size());
  for (const std::uint64_t count : owned) CHECK(count < all.size() / 2);
  for (const std::uint64_t count : held) CHECK(count < all.size());
}

}  // namespace
}  // namespace photile::test
