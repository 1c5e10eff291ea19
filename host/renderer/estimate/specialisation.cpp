#include "estimate/specialisation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/ascii_text.hpp"
#include "maps/map_page.hpp"
#include "photile/device/constants.h"
#include "photile/errors.hpp"

namespace photile {

std::string_view name_of(EstimateStrategy strategy) {
  return name_in({"select", "lanes"}, strategy);
}

EstimateTuning shipped_tuning(const DeviceInfo& device) {
  const bool lanes = device.type != DeviceType::cpu &&
                     device.max_work_group_size >= std::size_t{estimate::lane_widths.front()};
  return shipped_tuning(device, lanes ? EstimateStrategy::lanes : EstimateStrategy::select);
}

EstimateTuning shipped_tuning(const DeviceInfo& device, EstimateStrategy strategy) {
  EstimateTuning tuning;
  tuning.strategy = strategy;
  if (strategy == EstimateStrategy::lanes) {
    // Measured on one card: docs/kernels/estimate.md.
    constexpr int usual_width = 32, width_of_shuffles = 16;
    const auto& widths = estimate::lane_widths;
    const auto in_step = static_cast<int>(device.lanes);
    const bool is_width = std::find(widths.begin(), widths.end(), in_step) != widths.end();
    tuning.shuffles = device.shuffles;
    int width = tuning.shuffles ? width_of_shuffles : is_width ? in_step : usual_width;
    while (width > widths.front() && static_cast<unsigned>(width) > device.max_work_group_size) {
      width /= 2;
    }
    tuning.vector_width = tuning.work_group_size = width;
  } else if (device.type == DeviceType::cpu) {
    tuning.vector_width = 16;
    tuning.hits_per_item = 16;
    // PoCL gives a thread at least 32 groups: of larger ones, few threads would have any.
    tuning.work_group_size = 1;
  }
  return tuning;
}

namespace estimate {

std::string tuning_problem(const EstimateTuning& tuning) {
  const auto is_one_of = [&](const auto& widths) {
    return std::find(widths.begin(), widths.end(), tuning.vector_width) != widths.end();
  };
  if (tuning.strategy == EstimateStrategy::lanes) {
    if (!is_one_of(lane_widths)) {
      return fmt::format("lanes of {} work-items: must be 16, 32 or 64", tuning.vector_width);
    }
  } else if (!is_one_of(vector_widths)) {
    return fmt::format("vector width {}: must be 1, 4, 8 or 16", tuning.vector_width);
  }
  if (tuning.shuffles && tuning.vector_width > warp_width) {
    return fmt::format("shuffles among {} lanes: must be at most {}", tuning.vector_width,
                       warp_width);
  }
  if (tuning.hits_per_item < 1 || tuning.hits_per_item > max_hits_per_item) {
    return fmt::format("{} hits per work-item: must be between 1 and {}", tuning.hits_per_item,
                       max_hits_per_item);
  }
  if (tuning.work_group_size < 1 || tuning.work_group_size > max_work_group_size) {
    return fmt::format("work-groups of {}: must be between 1 and {}", tuning.work_group_size,
                       max_work_group_size);
  }
  return {};
}

}  // namespace estimate

}  // namespace photile

namespace photile::estimate {

namespace {

/// Near records listed before they are added, where they are: about all of k = 50.
constexpr int near_capacity = 128;

int rounded_up(int value, int multiple) { return (value + multiple - 1) / multiple * multiple; }

constexpr int least_capacity = 256;

/// Work-items of a group where it may hold several that each estimate a hit, or several sets of
/// lanes with shuffles.
constexpr std::size_t usual_group = 64;

/// Local memory that a group of every device with shuffles may have.
constexpr std::size_t max_local_bytes_of_shuffles = 48u << 10;

/// Distances kept for a hit: a block holds some 3 k candidates in chunks that are four fifths full,
/// and several times as many where a map holds more than one surface. Chunks of one are counted,
/// too.
int capacity_for(int neighbours, EstimateStrategy strategy, int vector_width) {
  if (strategy == EstimateStrategy::lanes) {
    return std::clamp(rounded_up(std::min(neighbours, largest_lane_capacity) * 8, vector_width),
                      least_capacity, largest_lane_capacity);
  }
  const int most = vector_width == 1 ? largest_scalar_capacity : largest_capacity;
  return std::clamp(rounded_up(std::min(neighbours, most) * 8, 16), least_capacity, most);
}

/// Halves work-groups until their private memory is within its bound.
void bound_group(Specialisation& choice) {
  while (choice.work_group_size > 1 &&
         choice.work_group_size * choice.private_bytes() > max_private_bytes_per_group) {
    choice.work_group_size /= 2;
  }
}

}  // namespace

device::Defines Specialisation::defines() const {
  device::Defines defines;
  const bool lanes = strategy == EstimateStrategy::lanes;
  if (lanes) defines.set("LANES");
  if (shuffles) {
    defines.set("SHUFFLES");
    defines.set("GROUP_SIZE", static_cast<long long>(work_group_size));
  }
  defines.set("VECTOR_WIDTH", static_cast<long long>(vector_width));
  defines.set("CAPACITY", static_cast<long long>(capacity));
  // Lanes list the near records of a hit all at once.
  defines.set("NEAR_CAPACITY", static_cast<long long>(lanes ? neighbours : near_capacity));
  defines.set("HITS_PER_ITEM", static_cast<long long>(hits_per_item));
  maps::set_record_defines(defines, needs);
  sums.set_defines(defines);
  if (needs.normal_maps) defines.set("NORMAL_MAPS");
  return defines;
}

std::size_t Specialisation::work_items(std::uint32_t hits) const {
  const auto divisor = static_cast<std::uint32_t>(hits_per_item);
  const std::size_t workers = hits / divisor + (hits % divisor != 0);
  return strategy == EstimateStrategy::lanes ? workers * static_cast<std::size_t>(vector_width)
                                             : workers;
}

std::uint32_t Specialisation::nearest_items(std::uint32_t hits) const {
  if (strategy != EstimateStrategy::lanes) return hits;
  // More hits are taken in turn: work-items are counted in 32 bits.
  constexpr std::uint32_t most_groups = 1u << 24;
  return std::min(hits, most_groups) * static_cast<std::uint32_t>(vector_width);
}

std::size_t Specialisation::private_bytes() const {
  const auto width = static_cast<std::size_t>(vector_width);
  const bool listed = needs.glossy || needs.many_lights();
  if (strategy == EstimateStrategy::lanes) {
    return needs.many_lights() ? 0 : sums.private_bytes();
  }
  std::size_t bytes = sums.private_bytes();
  bytes += static_cast<std::size_t>(capacity) * sizeof(float) +
           static_cast<std::size_t>(capacity) / width * sizeof(std::uint32_t);
  if (listed) bytes += (near_capacity + 2 * width) * sizeof(std::uint32_t);
  return bytes;
}

std::size_t Specialisation::local_bytes() const {
  if (strategy != EstimateStrategy::lanes) return 0;
  // The members of WorkerMemory, in their order; those that a scene does not need have one element.
  const auto width = static_cast<std::size_t>(vector_width);
  const auto kept = static_cast<std::size_t>(capacity);
  const std::size_t chunks = kept / width;
  const bool many_lights = needs.many_lights();
  const bool listed = needs.glossy || many_lights;
  const std::size_t ballot = listed ? chunks * ((width + 31) / 32) : 1;
  const std::size_t near = listed ? static_cast<std::size_t>(neighbours) : 1;
  const std::size_t flux = many_lights ? width : 1;
  const std::size_t radiance = many_lights && needs.glossy ? width : 1;
  constexpr std::size_t word = sizeof(std::uint32_t);
  const std::size_t words = 5 * (width + PHOTILE_LANE_COLUMNS) + kept + chunks + ballot + near +
                            4 * flux + 3 * radiance + sums.table_bytes() / word + 1 +
                            PHOTILE_SURFACE_STACK + PHOTILE_LEAF_QUEUE + PHOTILE_SURFACE_WIDTH;
  return work_group_size / width * words * word;
}

Specialisation specialise(const EstimateTuning& tuning, const SceneNeeds& needs, int neighbours) {
  Specialisation choice;
  choice.strategy = tuning.strategy;
  choice.vector_width = tuning.vector_width;
  choice.capacity = capacity_for(neighbours, choice.strategy, choice.vector_width);
  choice.neighbours = neighbours;
  choice.needs = needs;
  choice.sums = LightSums(needs, static_cast<std::uint32_t>(neighbours));
  const bool lanes = choice.strategy == EstimateStrategy::lanes;
  choice.work_group_size =
      static_cast<std::size_t>(lanes ? tuning.vector_width : tuning.work_group_size);
  choice.shuffles = lanes && tuning.shuffles;
  if (choice.local_bytes() > max_local_bytes) {
    choice.strategy = EstimateStrategy::select;
    choice.vector_width = 1;
    choice.shuffles = false;
    choice.capacity = capacity_for(neighbours, choice.strategy, choice.vector_width);
    choice.work_group_size = usual_group;
  }
  choice.hits_per_item = tuning.hits_per_item;
  if (choice.strategy == EstimateStrategy::lanes) {
    while (choice.shuffles && choice.work_group_size < usual_group &&
           2 * choice.local_bytes() <= max_local_bytes_of_shuffles) {
      choice.work_group_size *= 2;
    }
    return choice;
  }
  bound_group(choice);
  return choice;
}

Specialisation independent_of_k(Specialisation choice) {
  choice.strategy = EstimateStrategy::select;
  choice.vector_width = 1;
  choice.shuffles = false;
  choice.capacity = least_capacity;
  choice.work_group_size = usual_group;
  bound_group(choice);
  return choice;
}

bool fits(const Specialisation& choice, const device::KernelResources& taken,
          const DeviceInfo& device) {
  const bool lanes = choice.strategy == EstimateStrategy::lanes;
  return taken.local_bytes <= device.local_memory_bytes &&
         (!lanes || taken.largest_group >= choice.work_group_size) &&
         (device.type == DeviceType::cpu || taken.private_bytes <= max_private_bytes);
}

}  // namespace photile::estimate
