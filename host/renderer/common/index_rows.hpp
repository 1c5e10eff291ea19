// Rows of numbers in one array: what belongs to each of many elements.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "common/touched_memory.hpp"

namespace photile {

struct IndexRows {
  std::vector<std::uint32_t> first{0};  ///< per row, and the end of the last
  std::vector<std::uint32_t> items;

  std::size_t size() const { return first.size() - 1; }
  std::span<const std::uint32_t> of(std::size_t row) const {
    return std::span(items).subspan(first[row], first[row + 1] - first[row]);
  }
};

/// IndexRows whose items keep the order in which they are added.
///   for_each   is called twice, as for_each(put), and calls put(row, item) for all of them
template <class ForEach>
IndexRows rows_of(std::size_t count, const ForEach& for_each) {
  IndexRows rows;
  rows.first.assign(count + 1, 0);
  for_each([&](std::size_t row, std::uint32_t) { ++rows.first[row + 1]; });
  std::partial_sum(rows.first.begin(), rows.first.end(), rows.first.begin());
  rows.items.resize(rows.first.back());
  std::vector<std::uint32_t> next(rows.first.begin(), rows.first.end() - 1);
  for_each([&](std::size_t row, std::uint32_t item) { rows.items[next[row]++] = item; });
  return rows;
}

/// IndexRows that tasks write side by side.
///   write   (row, items) appends the items of a row
template <class Write>
IndexRows index_rows_by_tasks(std::size_t count, const Write& write) {
  constexpr std::size_t per_task = 256;
  std::vector<std::vector<std::uint32_t>> items((count + per_task - 1) / per_task);
  IndexRows rows;
  rows.first.resize(count + 1);
  tbb::parallel_for(std::size_t{0}, items.size(), [&](std::size_t task) {
    const std::size_t end = std::min(count, (task + 1) * per_task);
    for (std::size_t row = task * per_task; row < end; ++row) {
      const std::size_t before = items[task].size();
      write(row, items[task]);
      rows.first[row + 1] = static_cast<std::uint32_t>(items[task].size() - before);
    }
  });
  std::partial_sum(rows.first.begin(), rows.first.end(), rows.first.begin());
  rows.items = joined(
      items.size(), [&](std::size_t task) -> const auto& { return items[task]; });
  return rows;
}

}  // namespace photile
