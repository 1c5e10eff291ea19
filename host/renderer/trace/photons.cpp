#include "photile/photons.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <utility>

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
         bytes_of(sided_triangle) + bytes_of(first_of) + bytes_of(emitted_per_light);
}

Photons sort_by_sided_triangle(Photons photons, std::size_t sided_triangle_count) {
  photons.first_of.assign(sided_triangle_count + 1, 0);
  for (const std::uint32_t s : photons.sided_triangle) ++photons.first_of[s + 1];
  for (std::size_t s = 0; s < sided_triangle_count; ++s)
    photons.first_of[s + 1] += photons.first_of[s];

  // The two passes over the keys are serial: they take a few nanoseconds a photon where tracing it
  // took hundreds. The arrays then move one by one, so that only one of them exists twice.
  std::vector<std::uint32_t> next = photons.first_of;
  std::vector<std::uint32_t> destination(photons.size());
  for (std::size_t i = 0; i < photons.size(); ++i)
    destination[i] = next[photons.sided_triangle[i]]++;

  scatter(photons.position, destination);
  scatter(photons.flux, destination);
  scatter(photons.incoming, destination);
  scatter(photons.light, destination);
  scatter(photons.sided_triangle, destination);
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
  merge_arrays<&Photons::sided_triangle>(runs, merged);
  return merged;
}

}  // namespace photile
