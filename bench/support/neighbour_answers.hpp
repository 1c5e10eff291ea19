// The answers of a rival from the neighbours that it found.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <numbers>

#include "support/host_search.hpp"

namespace photile::bench {

/// Neighbours of one hit, whatever holds them, in any order.
template <class Photon, class SquaredDistance>
struct FoundNeighbours {
  std::size_t count;
  std::size_t farthest;              ///< which of them
  Photon photon;                     ///< (i): index of the i-th
  SquaredDistance squared_distance;  ///< (i)
};
template <class Photon, class SquaredDistance>
FoundNeighbours(std::size_t, std::size_t, Photon, SquaredDistance)
    -> FoundNeighbours<Photon, SquaredDistance>;

/// The squared radius of the estimate's disc: to the k-th, or of the search.
template <class Found>
float squared_radius_of(const Found& found, const SearchParameters& parameters) {
  return found.count == parameters.k ? found.squared_distance(found.farthest)
                                     : parameters.radius * parameters.radius;
}

/// Writes the estimate of one hit: flux of the k - 1 nearest over the disc through the k-th; of all
/// over the disc of the radius, where fewer than k were found.
template <class Found>
void write_density(const SearchInput& input, const SearchParameters& parameters, std::size_t hit,
                   const Found& found, DensityAnswers& answers) {
  const float squared_radius = squared_radius_of(found, parameters);
  glm::vec3* irradiance = &answers.irradiance[hit * input.light_count];
  std::fill_n(irradiance, input.light_count, glm::vec3(0.0f));
  for (std::size_t i = 0; i < found.count; ++i) {
    if (found.count == parameters.k && i == found.farthest) continue;
    const std::uint32_t p = found.photon(i);
    const std::size_t light = input.photons.light.empty() ? 0 : input.photons.light[p];
    irradiance[light] += input.photons.flux[p];
  }
  const float per_area = 1.0f / (std::numbers::pi_v<float> * squared_radius);
  for (std::size_t light = 0; light < input.light_count; ++light) irradiance[light] *= per_area;
  answers.squared_radius[hit] = squared_radius;
}

template <class Found>
void write_list(const SearchParameters& parameters, std::size_t hit, const Found& found,
                ListAnswers& answers) {
  std::uint32_t* const list = &answers.photons[hit * parameters.k];
  for (std::size_t i = 0; i < found.count; ++i) list[i] = found.photon(i);
  std::fill(list + found.count, list + parameters.k, none);
  answers.squared_radius[hit] = squared_radius_of(found, parameters);
}

/// A search that asks hit by hit, on all threads. Derived has `Worker make_worker(parameters)
/// const` and `find(worker, hits, hit, write) const`, which calls write(FoundNeighbours).
template <class Derived>
class HitByHit : public HostSearch {
 public:
  void estimate(const PrimaryHits& hits, std::span<const std::uint32_t> order,
                const SearchParameters& parameters, DensityAnswers& answers) const override {
    // Old contents stay where the size is right: every answer is written.
    answers.irradiance.resize(hits.size() * input_.light_count);
    answers.squared_radius.resize(hits.size());
    ask(hits, order, parameters, [&](std::size_t hit, const auto& found) {
      write_density(input_, parameters, hit, found, answers);
    });
  }
  void nearest(const PrimaryHits& hits, std::span<const std::uint32_t> order,
               const SearchParameters& parameters, ListAnswers& answers) const override {
    answers.photons.resize(hits.size() * parameters.k);
    answers.squared_radius.resize(hits.size());
    ask(hits, order, parameters,
        [&](std::size_t hit, const auto& found) { write_list(parameters, hit, found, answers); });
  }

 protected:
  explicit HitByHit(const SearchInput& input) : input_(input) {}
  SearchInput input_;

 private:
  template <class Write>
  void ask(const PrimaryHits& hits, std::span<const std::uint32_t> order,
           const SearchParameters& parameters, Write write) const {
    constexpr std::size_t grain = 1024;
    const auto& search = static_cast<const Derived&>(*this);
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, order.size(), grain), [&](const auto& range) {
          auto worker = search.make_worker(parameters);
          for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const std::uint32_t hit = order[i];
            search.find(worker, hits, hit, [&](const auto& found) { write(hit, found); });
          }
        });
  }
};

}  // namespace photile::bench
