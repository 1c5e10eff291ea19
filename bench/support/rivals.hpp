// The libraries that search on the host, each at its best.
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "support/host_search.hpp"

namespace photile::bench {

/// nanoflann with leaves of several sizes, with its own result set and with a heap, and Embree,
/// over the same photons in Morton order: neighbours that lie together in space do so in memory, as
/// they do in the cells of the grid. Normals are looked up only where they differ.
class Rivals {
 public:
  /// Builds every index.
  ///   filter   must outlive the rivals, which ask it at `faces_of_hits`
  Rivals(const Photons& photons, const NormalFilter& filter,
         std::span<const std::uint32_t> faces_of_hits, std::size_t light_count);

  struct Variant {
    std::string name;  ///< "leaves of 32, heap"
    const HostSearch* search;
    double build_seconds;
    double seconds = 0;  ///< of the trial
  };

  /// A library and its variants, the fastest first.
  struct Library {
    std::string name;  ///< of rows: "nanoflann", "nanoflann, newer", "embree"
    std::vector<Variant> variants;

    const Variant& best() const { return variants.front(); }
    /// Adds to a row the seconds of the build, and of the variants in the trial, the best first.
    void add_to(nlohmann::json& row) const;
  };

  /// Tries every variant at some hits, in turn and several times.
  std::vector<Library> at_their_best(const PrimaryHits& hits, const SearchParameters& parameters);

 private:
  Photons photons_;
  SearchInput input_;
  std::vector<std::unique_ptr<HostSearch>> searches_;
  std::vector<Library> libraries_;
};

/// The version of each library.
std::map<std::string, std::string> rival_versions();

}  // namespace photile::bench
