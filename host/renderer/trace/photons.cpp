#include "photile/photons.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "common/touched_memory.hpp"
#include "trace/photon_tracer.hpp"

namespace photile {

namespace {

template <class T>
std::uint64_t bytes_of(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}

/// Moves element i to `destination[i]`. An empty array stays empty.
template <class T>
void scatter(std::vector<T>& values, const std::vector<std::uint32_t>& destination) {
  if (values.empty()) return;
  std::vector<T> sorted(values.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, values.size(), 1 << 16),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i != range.end(); ++i)
                        sorted[destination[i]] = values[i];
                    });
  values = std::move(sorted);
}

/// Brings one array of all runs together, triangle by triangle.
template <auto array>
void merge_arrays(std::vector<Photons>& runs, Photons& merged) {
  auto& all = merged.*array;
  std::size_t count = 0;
  for (const Photons& run : runs) count += (run.*array).size();
  if (count == 0) return;
  all.reserve(count);
  for (std::size_t s = 0; s + 1 < merged.first_of.size(); ++s) {
    for (const Photons& run : runs) {
      const auto first = (run.*array).begin();
      all.insert(all.end(), first + run.first_of[s], first + run.first_of[s + 1]);
    }
  }
  for (Photons& run : runs) run.*array = {};
}

}  // namespace

std::uint64_t Photons::bytes() const {
  return bytes_of(position) + bytes_of(flux) + bytes_of(incoming) + bytes_of(light) +
         bytes_of(oriented_face) + bytes_of(first_of) + bytes_of(emitted_per_light);
}

Photons sort_by_oriented_face(Photons photons, std::size_t oriented_face_count) {
  photons.first_of.assign(oriented_face_count + 1, 0);
  for (const std::uint32_t s : photons.oriented_face) ++photons.first_of[s + 1];
  for (std::size_t s = 0; s < oriented_face_count; ++s)
    photons.first_of[s + 1] += photons.first_of[s];

  // The two passes over the keys are serial: they take a few nanoseconds a photon where tracing it
  // took hundreds. The arrays then move one by one, so that only one of them exists twice.
  std::vector<std::uint32_t> next = photons.first_of;
  std::vector<std::uint32_t> destination(photons.size());
  for (std::size_t i = 0; i < photons.size(); ++i)
    destination[i] = next[photons.oriented_face[i]]++;

  scatter(photons.position, destination);
  scatter(photons.flux, destination);
  scatter(photons.incoming, destination);
  scatter(photons.light, destination);
  scatter(photons.oriented_face, destination);
  return photons;
}

Photons merge_runs(std::vector<Photons> runs) {
  if (runs.size() == 1) return std::move(runs.front());
  Photons merged;
  merged.emitted_per_light = runs.front().emitted_per_light;
  merged.first_of.assign(runs.front().first_of.size(), 0);
  for (const Photons& run : runs) {
    for (std::size_t s = 0; s < merged.first_of.size(); ++s) merged.first_of[s] += run.first_of[s];
  }
  merge_arrays<&Photons::position>(runs, merged);
  merge_arrays<&Photons::flux>(runs, merged);
  merge_arrays<&Photons::incoming>(runs, merged);
  merge_arrays<&Photons::light>(runs, merged);
  merge_arrays<&Photons::oriented_face>(runs, merged);
  return merged;
}

}  // namespace photile

namespace photile::trace {

namespace {

/// Runs in a row that are counted by one task.
struct Chunk {
  std::span<const LayerRun> runs;
  std::vector<std::uint32_t> next;  ///< per oriented face: its photons, then its next position
};

/// Parts of the runs, as many as there are threads, unless their counts would take more memory than
/// the photons.
std::vector<Chunk> chunks_of(std::span<const LayerRun> runs, std::size_t oriented_face_count) {
  std::size_t photons = 0;
  for (const LayerRun& run : runs) photons += run.photons->size();
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  const std::size_t count =
      std::clamp<std::size_t>(photons / (oriented_face_count + 1), 1, threads);
  std::vector<Chunk> chunks(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = i * runs.size() / count, last = (i + 1) * runs.size() / count;
    chunks[i].runs = runs.subspan(first, last - first);
  }
  return chunks;
}

/// Turns the runs' oriented faces into the positions of their photons; returns Photons::first_of.
std::vector<std::uint32_t> find_slots(std::span<const LayerRun> runs,
                                      std::size_t oriented_face_count) {
  std::vector<Chunk> chunks = chunks_of(runs, oriented_face_count);
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t i) {
    chunks[i].next.assign(oriented_face_count, 0);
    for (const LayerRun& run : chunks[i].runs) {
      for (const std::uint32_t s : run.photons->oriented_face) ++chunks[i].next[s];
    }
  });
  std::vector<std::uint32_t> first_of(oriented_face_count + 1);
  std::uint32_t index = 0;
  for (std::size_t s = 0; s < oriented_face_count; ++s) {
    first_of[s] = index;
    for (Chunk& chunk : chunks) index += std::exchange(chunk.next[s], index);
  }
  first_of.back() = index;
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t i) {
    for (const LayerRun& run : chunks[i].runs) {
      for (std::uint32_t& s : run.photons->oriented_face) s = chunks[i].next[s]++;
    }
  });
  return first_of;
}

/// One array of all runs, whose oriented faces tell the positions now.
template <class T>
std::vector<T> in_slots(std::span<const LayerRun> runs, std::vector<T> PhotonRun::*array,
                        std::size_t count) {
  std::vector<T> all = touched_vector<T>(count);
  tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t r) {
    const std::vector<std::uint32_t>& index = runs[r].photons->oriented_face;
    const std::vector<T> own = std::move(runs[r].photons->*array);
    for (std::size_t i = 0; i < own.size(); ++i) all[index[i]] = own[i];
  });
  return all;
}

}  // namespace

Photons sorted_photons(std::span<const LayerRun> runs, bool tell_layers,
                       std::size_t oriented_face_count) {
  Photons photons;
  const bool keeps_incoming = std::any_of(
      runs.begin(), runs.end(), [](const LayerRun& run) { return !run.photons->incoming.empty(); });
  photons.first_of = find_slots(runs, oriented_face_count);
  const std::size_t count = photons.first_of.back();
  photons.position = in_slots(runs, &PhotonRun::position, count);
  photons.flux = in_slots(runs, &PhotonRun::flux, count);
  if (keeps_incoming) photons.incoming = in_slots(runs, &PhotonRun::incoming, count);
  if (tell_layers) {
    photons.light = touched_vector<std::uint16_t>(count);
    tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t r) {
      for (const std::uint32_t index : runs[r].photons->oriented_face) {
        photons.light[index] = runs[r].layer;
      }
    });
  }
  tbb::parallel_for(std::size_t{0}, runs.size(),
                    [&](std::size_t r) { *runs[r].photons = PhotonRun{}; });
  return_freed_memory();
  photons.oriented_face = touched_vector<std::uint32_t>(count);
  tbb::parallel_for(std::size_t{0}, oriented_face_count, [&](std::size_t s) {
    const auto at = photons.oriented_face.begin();
    std::fill(at + photons.first_of[s], at + photons.first_of[s + 1],
              static_cast<std::uint32_t>(s));
  });
  return photons;
}

}  // namespace photile::trace
