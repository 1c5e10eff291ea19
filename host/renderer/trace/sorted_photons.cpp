#include "trace/sorted_photons.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "common/touched_memory.hpp"

namespace photile::trace {
namespace {

/// Runs in a row that are counted by one task.
struct Share {
  std::span<const LayerRun> runs;
  std::vector<std::uint32_t> next;  ///< per sided triangle: its photons, then the place of the next
};

/// As many as there are threads, unless their counts would take more memory than the photons.
std::vector<Share> shares_of(std::span<const LayerRun> runs, std::size_t sided_triangle_count) {
  std::size_t photons = 0;
  for (const LayerRun& run : runs) photons += run.photons->size();
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  const std::size_t count =
      std::clamp<std::size_t>(photons / (sided_triangle_count + 1), 1, threads);
  std::vector<Share> shares(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = i * runs.size() / count, last = (i + 1) * runs.size() / count;
    shares[i].runs = runs.subspan(first, last - first);
  }
  return shares;
}

/// Turns the runs' sided triangles into the places of their photons; returns Photons::first_of.
std::vector<std::uint32_t> find_places(std::span<const LayerRun> runs,
                                       std::size_t sided_triangle_count) {
  std::vector<Share> shares = shares_of(runs, sided_triangle_count);
  tbb::parallel_for(std::size_t{0}, shares.size(), [&](std::size_t i) {
    shares[i].next.assign(sided_triangle_count, 0);
    for (const LayerRun& run : shares[i].runs) {
      for (const std::uint32_t s : run.photons->sided_triangle) ++shares[i].next[s];
    }
  });
  std::vector<std::uint32_t> first_of(sided_triangle_count + 1);
  std::uint32_t place = 0;
  for (std::size_t s = 0; s < sided_triangle_count; ++s) {
    first_of[s] = place;
    for (Share& share : shares) place += std::exchange(share.next[s], place);
  }
  first_of.back() = place;
  tbb::parallel_for(std::size_t{0}, shares.size(), [&](std::size_t i) {
    for (const LayerRun& run : shares[i].runs) {
      for (std::uint32_t& s : run.photons->sided_triangle) s = shares[i].next[s]++;
    }
  });
  return first_of;
}

/// One array of all runs, whose sided triangles tell the places now.
template <class T>
std::vector<T> in_places(std::span<const LayerRun> runs, std::vector<T> PhotonRun::*array,
                         std::size_t count) {
  std::vector<T> all = touched_vector<T>(count);
  tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t r) {
    const std::vector<std::uint32_t>& place = runs[r].photons->sided_triangle;
    const std::vector<T> own = std::move(runs[r].photons->*array);
    for (std::size_t i = 0; i < own.size(); ++i) all[place[i]] = own[i];
  });
  return all;
}

}  // namespace

Photons sorted_photons(std::span<const LayerRun> runs, bool tell_layers,
                       std::size_t sided_triangle_count) {
  Photons photons;
  const bool keeps_incoming = std::any_of(
      runs.begin(), runs.end(), [](const LayerRun& run) { return !run.photons->incoming.empty(); });
  photons.first_of = find_places(runs, sided_triangle_count);
  const std::size_t count = photons.first_of.back();
  photons.position = in_places(runs, &PhotonRun::position, count);
  photons.flux = in_places(runs, &PhotonRun::flux, count);
  if (keeps_incoming) photons.incoming = in_places(runs, &PhotonRun::incoming, count);
  if (tell_layers) {
    photons.light = touched_vector<std::uint16_t>(count);
    tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t r) {
      for (const std::uint32_t place : runs[r].photons->sided_triangle) {
        photons.light[place] = runs[r].layer;
      }
    });
  }
  tbb::parallel_for(std::size_t{0}, runs.size(),
                    [&](std::size_t r) { *runs[r].photons = PhotonRun{}; });
  return_freed_memory();
  photons.sided_triangle = touched_vector<std::uint32_t>(count);
  tbb::parallel_for(std::size_t{0}, sided_triangle_count, [&](std::size_t s) {
    const auto at = photons.sided_triangle.begin();
    std::fill(at + photons.first_of[s], at + photons.first_of[s + 1],
              static_cast<std::uint32_t>(s));
  });
  return photons;
}

}  // namespace photile::trace
