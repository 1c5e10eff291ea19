#include "support/rivals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "photile/statistics.hpp"
#include "support/morton_order.hpp"
#include "support/timing.hpp"

namespace photile::bench {
namespace {

constexpr std::array<std::size_t, 4> leaf_sizes{10, 20, 32, 64};
constexpr int trials = 3;

std::vector<Nanoflann> nanoflanns() {
  std::vector<Nanoflann> all{nanoflann_of_system()};
#ifdef PHOTILE_GIVEN_NANOFLANN
  all.push_back(nanoflann_given());
#endif
  return all;
}

/// What a search reads of photons, in Morton order.
Photons in_morton_order(const Photons& photons) {
  Photons ordered;
  for (const std::uint32_t i : morton_order(photons.position)) {
    ordered.position.push_back(photons.position[i]);
    ordered.flux.push_back(photons.flux[i]);
    ordered.oriented_face.push_back(photons.oriented_face[i]);
    if (!photons.light.empty()) ordered.light.push_back(photons.light[i]);
  }
  return ordered;
}

}  // namespace

Rivals::Rivals(const Photons& photons, const NormalFilter& filter,
               std::span<const std::uint32_t> faces_of_hits, std::size_t light_count)
    : photons_(in_morton_order(photons)),
      input_{photons_, filter.all_agree(photons_.oriented_face, faces_of_hits) ? nullptr : &filter,
             light_count} {
  const auto keep = [&](std::unique_ptr<HostSearch> search) {
    return searches_.emplace_back(std::move(search)).get();
  };
  for (const Nanoflann& nanoflann : nanoflanns()) {
    Library library{nanoflann.name, {}};
    for (const std::size_t leaf : leaf_sizes) {
      const Stopwatch stopwatch;
      Nanoflann::Searches searches = nanoflann.make(input_, leaf);
      const double seconds = stopwatch.seconds();
      library.variants.push_back({fmt::format("leaves of {}, its own set", leaf),
                                  keep(std::move(searches.sorted_list)), seconds});
      library.variants.push_back(
          {fmt::format("leaves of {}, heap", leaf), keep(std::move(searches.heap)), seconds});
    }
    libraries_.push_back(std::move(library));
  }
  const Stopwatch stopwatch;
  const HostSearch* const embree = keep(make_embree_search(input_));
  libraries_.push_back({"embree", {{"heap", embree, stopwatch.seconds()}}});
}

std::vector<Rivals::Library> Rivals::at_their_best(const PrimaryHits& hits,
                                                   const SearchParameters& parameters) {
  std::vector<Library> libraries = libraries_;
  const std::vector<std::uint32_t> order = morton_order(hits.position);
  for (Library& library : libraries) {
    if (library.variants.size() == 1) continue;
    for (Variant& variant : library.variants) {
      variant.seconds = std::numeric_limits<double>::infinity();
    }
    for (int trial = 0; trial < trials; ++trial) {
      for (Variant& variant : library.variants) {
        DensityAnswers answers;
        RunTimes times;
        times.count([&] { variant.search->estimate(hits, order, parameters, answers); });
        variant.seconds = std::min(variant.seconds, times.processor.seconds.back());
      }
    }
    std::sort(library.variants.begin(), library.variants.end(),
              [](const Variant& a, const Variant& b) { return a.seconds < b.seconds; });
  }
  return libraries;
}

void Rivals::Library::add_to(nlohmann::json& row) const {
  row["build"] = best().build_seconds;
  if (variants.size() == 1) return;
  nlohmann::json& tried = row["variants"];
  for (const Variant& variant : variants) {
    tried.push_back({{"variant", variant.name}, {"seconds", variant.seconds}});
  }
}

std::map<std::string, std::string> rival_versions() {
  std::map<std::string, std::string> versions{{"embree", embree_version()}};
  for (const Nanoflann& nanoflann : nanoflanns()) versions[nanoflann.name] = nanoflann.version;
  return versions;
}

}  // namespace photile::bench
