// What processes that share a picture send each other: points and their light, rows, statistics.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "common/content_hash.hpp"
#include "light/light_at_points.hpp"
#include "photile/communicator.hpp"
#include "photile/light_layers.hpp"
#include "render/lobe_filter.hpp"
#include "render/render_costs.hpp"
#include "render/shared_photons.hpp"

namespace photile {

/// Sends points to the owners of their maps, and returns their estimates. What a point gets
/// must not depend on the points beside it. Collective: all processes ask at the same time, each
/// for its own points or for none. Where all of them ask for the same points, such as nodes of
/// light maps, each estimates those of its maps, and all get all results.
class Exchange : public light::LightAtPoints {
 public:
  /// References are kept.
  ///   here   the source for maps of this process
  ///   none   light of the scene at no points
  ///   sent   is added to
  Exchange(Communicator& processes, std::shared_ptr<const MapOwners> owners,
           std::shared_ptr<light::LightAtPoints> here, LightTable none, SentData& sent)
      : processes_(processes),
        owners_(std::move(owners)),
        here_(std::move(here)),
        none_(std::move(none)),
        sent_(sent) {}

  LightTable at(const PrimaryHits& points, const Progress& progress) override;

 private:
  bool is_common(const PrimaryHits& points) const;
  LightTable at_own(const PrimaryHits& points, const Progress& progress);
  LightTable at_common(const PrimaryHits& points, const Progress& progress);
  /// Positions of points, by their owners.
  std::vector<std::vector<std::uint32_t>> by_owner(const PrimaryHits& points) const;
  LightTable in_order(std::span<const std::vector<std::uint32_t>> indices,
                      std::span<const std::vector<std::byte>> bytes, std::size_t points) const;

  Communicator& processes_;
  std::shared_ptr<const MapOwners> owners_;
  std::shared_ptr<light::LightAtPoints> here_;
  LightTable none_;
  SentData& sent_;
};

/// Refuses work that differs between processes: their parts would form an inconsistent picture.
/// Collective.
///   what   the work, in the words of the refusal
/// Errors: UsageError, on all of them.
void require_same(Communicator& processes, const ContentHash& work, std::string_view what);

/// Sends the rows of each process, its Shard of all rows, to rank 0. The layers of the others stay
/// as they are. Collective.
void bring_rows(Communicator& processes, LightLayers& layers);
void bring_rows(Communicator& processes, LobeFilm& film);

/// The memory of all machines together; of this machine where there is one process. Collective.
std::uint64_t host_bytes_of_all(Communicator* processes);

/// Replaces counts by those of all processes, and fills in their figures. Times stay those of this
/// process. Collective.
void add_processes(Communicator& all, RenderCosts& costs);

}  // namespace photile
