// Numbers in rows, all in one array: what belongs to each of many things.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

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

}  // namespace photile
