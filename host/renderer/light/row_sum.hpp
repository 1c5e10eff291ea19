// The sums of one row of a table of light.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "light/table_bytes.hpp"
#include "photile/light_table.hpp"

namespace photile::light {

/// The sums of lights in a row, with room for every light: lights with a sum are listed, so that
/// only these are read and reset. Sums run in the order in which they are added.
///   Sums   the sums of one light; zero by default
template <class Sums>
class RowSum {
 public:
  explicit RowSum(std::size_t lights) : sums_(lights), is_lit_(lights) {}

  /// The sums of a light, to add to.
  Sums& of(std::size_t light) {
    if (!is_lit_[light]) {
      is_lit_[light] = 1;
      lit_.push_back(static_cast<std::uint16_t>(light));
    }
    return sums_[light];
  }
  bool has(std::size_t light) const { return is_lit_[light] != 0; }

  /// The lights with a sum, in the order of their first addition.
  std::span<const std::uint16_t> lit() const { return lit_; }

  /// Calls visit(light, its sums) for these lights, ascending, and clears the sums.
  template <class Visit>
  void take_lit(const Visit& visit) {
    std::sort(lit_.begin(), lit_.end());
    for (const std::uint16_t light : lit_) {
      visit(light, sums_[light]);
      sums_[light] = Sums{};
      is_lit_[light] = 0;
    }
    lit_.clear();
  }

  /// Ends the row: calls write(light, its sums) for each entry that it has, and begins the next.
  template <class Write>
  void end_row(LightTable& table, const Write& write) {
    if (!table.sparse()) {
      for (std::size_t light = 0; light < sums_.size(); ++light) {
        write(light, sums_[light]);
        sums_[light] = Sums{};
        is_lit_[light] = 0;
      }
      lit_.clear();
      return;
    }
    take_lit([&](std::uint16_t light, const Sums& sums) {
      write(light, sums);
      table.light.push_back(light);
    });
    table.first.push_back(table.irradiance.size());
  }

 private:
  std::vector<Sums> sums_;
  std::vector<std::uint8_t> is_lit_;
  std::vector<std::uint16_t> lit_;
};

/// The irradiance of a light at a point, W/m2 or lm/m2, and the radiance that the point reflects of
/// it, W/(m2 sr) or cd/m2.
struct Reflection {
  glm::vec3 irradiance{0.0f}, radiance{0.0f};

  void add(const glm::vec3& arriving, const glm::vec3& reflected) {
    irradiance += arriving;
    radiance += reflected;
  }
};

/// Ends a row of such sums.
///   has_radiance   whether radiance is a column of the table
inline void end_row(RowSum<Reflection>& sums, LightTable& table, bool has_radiance) {
  sums.end_row(table, [&](std::size_t, const Reflection& sum) {
    table.irradiance.push_back(sum.irradiance);
    if (has_radiance) table.radiance.push_back(sum.radiance);
  });
}

/// Rows that tasks write, joined in their order. Work is shared by TBB.
///   none    a table without rows, in the form of the result
///   write   (first, last, rows) appends the rows [first, last) to `rows`, which has none
template <class Write>
LightTable rows_by_tasks(std::size_t count, std::size_t rows_per_task, const LightTable& none,
                         const Write& write) {
  std::vector<LightTable> parts((count + rows_per_task - 1) / rows_per_task, none);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    const std::size_t first = part * rows_per_task;
    write(first, std::min(count, first + rows_per_task), parts[part]);
  });
  return joined(none, std::move(parts));
}

}  // namespace photile::light
