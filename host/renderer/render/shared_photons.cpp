#include "render/shared_photons.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "common/byte_stream.hpp"
#include "geometry/box.hpp"
#include "geometry/radix_sort.hpp"
#include "groups/automatic_radius.hpp"
#include "groups/merge_patches.hpp"
#include "maps/build_maps.hpp"
#include "maps/candidate_maps.hpp"
#include "photile/defaults.hpp"

namespace photile {

namespace {

constexpr int bits_of_axis = 21;

/// Pairs along the curve.
std::vector<std::uint32_t> along_curve(std::span<const geometry::Box> boxes) {
  geometry::Box bounds;
  for (const geometry::Box& box : boxes) bounds.extend(box);
  const glm::vec3 extent = glm::max(bounds.size(), glm::vec3(std::numeric_limits<float>::min()));
  std::vector<std::uint64_t> code;
  for (const geometry::Box& box : boxes) {
    const glm::dvec3 within =
        glm::clamp(glm::dvec3((box.centre() - bounds.lower) / extent), 0.0, 1.0);
    code.push_back(geometry::morton_code(glm::uvec3(within * double{(1 << bits_of_axis) - 1})));
  }
  std::vector<std::uint32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return code[a] < code[b]; });
  return order;
}

}  // namespace

MapOwners::MapOwners(const Scene& scene, const Patches& patches,
                     std::span<const std::uint32_t> landed, std::uint32_t processes) {
  const std::vector<geometry::Box> boxes = maps::map_boxes(scene, patches);
  std::vector<std::uint64_t> photons(boxes.size(), 0);
  for (std::uint32_t s = 0; s < landed.size(); ++s) photons[patches.map(s) / 2] += landed[s];
  const std::uint64_t all = std::accumulate(photons.begin(), photons.end(), std::uint64_t{0});
  of_pair_.resize(boxes.size(), 0);
  std::uint64_t before = 0;
  for (const std::uint32_t pair : along_curve(boxes)) {
    // The owner is the process in whose share the middle of the pair's photons falls.
    const double middle = static_cast<double>(before) + 0.5 * static_cast<double>(photons[pair]);
    if (all > 0) {
      of_pair_[pair] = std::min(
          processes - 1, static_cast<std::uint32_t>(middle / static_cast<double>(all) * processes));
    }
    before += photons[pair];
  }
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    of_triangle_.push_back(of_pair_[patches.map(oriented(t, 0)) / 2]);
  }
}

std::vector<std::uint8_t> MapOwners::maps_of(std::uint32_t rank) const {
  std::vector<std::uint8_t> maps(2 * of_pair_.size());
  for (std::size_t map = 0; map < maps.size(); ++map) maps[map] = of_pair_[map / 2] == rank ? 1 : 0;
  return maps;
}

std::vector<std::uint8_t> MapOwners::triangles_of(std::uint32_t rank) const {
  std::vector<std::uint8_t> triangles(2 * of_triangle_.size());
  for (std::size_t s = 0; s < triangles.size(); ++s) {
    triangles[s] = of_triangle_[s / 2] == rank ? 1 : 0;
  }
  return triangles;
}

namespace {

/// The positions of a process's photons among all, sorted by oriented face.
class GlobalIndices {
 public:
  GlobalIndices(Communicator& processes, const Photons& own) : own_(own) {
    std::vector<std::uint64_t> counts;
    for (std::size_t s = 0; s + 1 < own.first_of.size(); ++s) {
      counts.push_back(own.first_of[s + 1] - own.first_of[s]);
    }
    before_ = processes.sum_before(counts);
    processes.sum(counts);
    first_of_.push_back(0);
    for (const std::uint64_t count : counts) first_of_.push_back(first_of_.back() + count);
  }

  std::uint64_t total() const { return first_of_.back(); }
  std::uint64_t landed(std::size_t oriented_face) const {
    return first_of_[oriented_face + 1] - first_of_[oriented_face];
  }

  /// Calls visit(i, oriented_face, photon) for i from 0 up to `count`: `photon` is that of this
  /// process which has the photon of number index_of(i) among all, or none. Numbers ascend.
  template <class IndexOf, class Visit>
  void for_each(std::uint64_t count, const IndexOf& index_of, const Visit& visit) const {
    std::uint32_t s = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t index = index_of(i);
      while (first_of_[s + 1] <= index) ++s;
      const std::uint64_t offset = index - first_of_[s], first = before_[s];
      const std::uint32_t own = own_.first_of[s + 1] - own_.first_of[s];
      const bool here = offset >= first && offset - first < own;
      visit(i, s, here ? own_.first_of[s] + static_cast<std::uint32_t>(offset - first) : none);
    }
  }

 private:
  const Photons& own_;
  std::vector<std::uint64_t> before_;    ///< per oriented face: photons of the ranks before
  std::vector<std::uint64_t> first_of_;  ///< as Photons has it, of all
};

/// A position of a list that several processes fill.
struct IndexedPosition {
  std::uint32_t index;
  glm::vec3 position;
};

/// The list that all of them have then.
std::vector<glm::vec3> filled(Communicator& processes, std::span<const IndexedPosition> own,
                              std::uint64_t count) {
  std::vector<glm::vec3> all(count);
  for (const IndexedPosition& one : processes.gather_values(own)) all[one.index] = one.position;
  return all;
}

/// Tells which processes a photon goes to: those of the maps that it may enter.
class Destinations {
 public:
  Destinations(const Scene& scene, const NeighbourGroups& groups, const MapOwners& owners,
               double radius)
      : groups_(groups), owners_(owners), boxes_(maps::map_boxes(scene, groups.patches)) {
    const float reach = maps::reach_of(scene, radius);
    squared_reach_ = reach * reach;
  }

  /// Appends the photons of an oriented face, by number, to the lists of their ranks.
  void append(std::uint32_t oriented_face, const Photons& photons,
              std::vector<std::vector<std::uint32_t>>& of_rank) const {
    const std::uint32_t home = owners_.of(oriented_face);
    std::vector<std::uint32_t> others;  // maps of other processes
    for (const std::uint32_t map : groups_.of(oriented_face)) {
      if (owners_.of_map(map) != home) others.push_back(map);
    }
    std::vector<std::uint32_t> ranks;
    for (std::uint32_t i = photons.first_of[oriented_face]; i < photons.first_of[oriented_face + 1];
         ++i) {
      of_rank[home].push_back(i);
      if (others.empty()) continue;
      ranks.clear();
      geometry::Box box;
      box.extend(photons.position[i]);
      for (const std::uint32_t map : others) {
        // kernels/grid/insertion.clh tests the same distance more closely.
        if (geometry::squared_distance(boxes_[map / 2], box) > squared_reach_) continue;
        const std::uint32_t rank = owners_.of_map(map);
        if (std::find(ranks.begin(), ranks.end(), rank) == ranks.end()) ranks.push_back(rank);
      }
      for (const std::uint32_t rank : ranks) of_rank[rank].push_back(i);
    }
  }

 private:
  const NeighbourGroups& groups_;
  const MapOwners& owners_;
  std::vector<geometry::Box> boxes_;
  float squared_reach_ = 0;
};

/// Per rank: the photons that go there, ascending.
std::vector<std::vector<std::uint32_t>> photons_for(const Destinations& destinations,
                                                    const Photons& photons, std::uint32_t ranks) {
  constexpr std::size_t triangles_per_chunk = 256;  // of oriented faces
  const std::size_t sides = photons.first_of.size() - 1;
  std::vector<std::vector<std::vector<std::uint32_t>>> chunks((sides + triangles_per_chunk - 1) /
                                                              triangles_per_chunk);
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
    chunks[c].resize(ranks);
    const std::size_t last = std::min(sides, (c + 1) * triangles_per_chunk);
    for (std::size_t s = c * triangles_per_chunk; s < last; ++s) {
      destinations.append(static_cast<std::uint32_t>(s), photons, chunks[c]);
    }
  });
  std::vector<std::vector<std::uint32_t>> all(ranks);
  for (auto& chunk : chunks) {
    for (std::uint32_t rank = 0; rank < ranks; ++rank) {
      all[rank].insert(all[rank].end(), chunk[rank].begin(), chunk[rank].end());
    }
    chunk = {};
  }
  return all;
}

template <class T>
std::vector<T> chosen(const std::vector<T>& values, std::span<const std::uint32_t> photons) {
  std::vector<T> result;
  if (values.empty()) return result;
  result.reserve(photons.size());
  for (const std::uint32_t i : photons) result.push_back(values[i]);
  return result;
}

std::vector<std::byte> packed(const Photons& all, std::span<const std::uint32_t> photons) {
  ByteWriter bytes;
  bytes.put(chosen(all.position, photons));
  bytes.put(chosen(all.flux, photons));
  bytes.put(chosen(all.incoming, photons));
  bytes.put(chosen(all.light, photons));
  bytes.put(chosen(all.oriented_face, photons));
  return bytes.take();
}

void unpack(std::span<const std::byte> bytes, Photons& to) {
  if (bytes.empty()) return;
  ByteReader reader(bytes);
  reader.append_to(to.position);
  reader.append_to(to.flux);
  reader.append_to(to.incoming);
  reader.append_to(to.light);
  reader.append_to(to.oriented_face);
}

std::uint64_t bytes_of_photon(const Photons& photons) {
  return 2 * sizeof(glm::vec3) + sizeof(std::uint32_t) +
         (photons.incoming.empty() ? 0 : sizeof(glm::vec3)) +
         (photons.light.empty() ? 0 : sizeof(std::uint16_t));
}

void set_first_of(Photons& photons, std::size_t sides) {
  photons.first_of.assign(sides + 1, 0);
  for (const std::uint32_t s : photons.oriented_face) ++photons.first_of[s + 1];
  for (std::size_t s = 0; s < sides; ++s) photons.first_of[s + 1] += photons.first_of[s];
}

}  // namespace

std::shared_ptr<const PhotonsOfAll> photons_of_all(Communicator& processes, const Photons& own) {
  const GlobalIndices indices(processes, own);
  auto all = std::make_shared<PhotonsOfAll>();
  all->processes = &processes;
  all->count = indices.total();
  for (std::size_t s = 0; s + 1 < own.first_of.size(); ++s) {
    all->landed.push_back(static_cast<std::uint32_t>(indices.landed(s)));
  }
  std::vector<IndexedPosition> found;
  const auto find = [&](std::uint64_t i, std::uint32_t, std::uint32_t photon) {
    if (photon != none) found.push_back({static_cast<std::uint32_t>(i), own.position[photon]});
  };
  const std::uint64_t spread = std::min<std::uint64_t>(all->count, groups::max_subsample);
  indices.for_each(
      spread, [&](std::uint64_t i) { return groups::spread_index(i, spread, all->count); }, find);
  all->spread = filled(processes, found, spread);

  found.clear();
  const std::uint64_t step = groups::sample_step(all->count);
  const std::uint64_t samples =
      all->count < step / 2 + 1 ? 0 : (all->count - step / 2 - 1) / step + 1;
  indices.for_each(
      samples, [&](std::uint64_t i) { return step / 2 + i * step; },
      [&](std::uint64_t i, std::uint32_t s, std::uint32_t photon) {
        all->sample_triangle.push_back(s);
        find(i, s, photon);
      });
  all->sample = filled(processes, found, samples);
  return all;
}

Photons to_owners(Communicator& processes, const Scene& scene, const NeighbourGroups& groups,
                  const MapOwners& owners, double radius, Photons own, SentData& sent) {
  const std::uint32_t ranks = processes.size();
  const std::vector<std::vector<std::uint32_t>> for_rank =
      photons_for(Destinations(scene, groups, owners, radius), own, ranks);
  const std::uint64_t each = bytes_of_photon(own);
  std::size_t most = 0;
  for (std::uint32_t rank = 0; rank < ranks; ++rank) {
    most = std::max(most, for_rank[rank].size());
    if (rank == processes.rank()) continue;
    sent.photons += for_rank[rank].size();
    sent.photon_bytes += for_rank[rank].size() * each;
  }
  // A process without photons does not know what others send.
  const std::size_t in_round =
      std::max<std::size_t>(1, defaults::exchange_round_bytes / (each * ranks));
  const std::uint64_t own_rounds = (most + in_round - 1) / in_round;
  const auto of_ranks =
      processes.gather_values<std::uint64_t>(std::span<const std::uint64_t>(&own_rounds, 1));
  const std::uint64_t rounds = *std::max_element(of_ranks.begin(), of_ranks.end());
  std::vector<Photons> from(ranks);
  for (std::uint64_t round = 0; round < rounds; ++round) {
    std::vector<Communicator::Bytes> to_each(ranks);
    for (std::uint32_t rank = 0; rank < ranks; ++rank) {
      const std::span<const std::uint32_t> all = for_rank[rank];
      const std::size_t first = std::min(all.size(), round * in_round);
      const std::size_t count = std::min(in_round, all.size() - first);
      if (count > 0) to_each[rank] = packed(own, all.subspan(first, count));
    }
    const std::vector<Communicator::Bytes> got = processes.exchange(std::move(to_each));
    for (std::uint32_t rank = 0; rank < ranks; ++rank) unpack(got[rank], from[rank]);
  }
  const std::size_t sides = 2 * scene.triangle_count();
  for (Photons& run : from) set_first_of(run, sides);
  auto of_all = std::make_shared<PhotonsOfAll>(*own.of_all);
  of_all->own = owners.triangles_of(processes.rank());
  const std::vector<std::uint64_t> emitted = std::move(own.emitted_per_light);
  own = {};
  Photons held = merge_runs(std::move(from));
  held.emitted_per_light = emitted;
  held.of_all = std::move(of_all);
  sent.photons_held += held.size();
  return held;
}

}  // namespace photile
