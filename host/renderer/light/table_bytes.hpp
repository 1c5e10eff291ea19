// The columns of tables of light, and these as bytes, for processes that send them to each other.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "common/byte_stream.hpp"
#include "photile/light_table.hpp"

namespace photile::light {

/// Calls visit(column of a, column of b, values for each entry) for the columns of two tables.
template <class A, class B, class Visit>
void for_each_column(A& a, B& b, const Visit& visit) {
  visit(a.irradiance, b.irradiance, std::size_t{1});
  visit(a.radiance, b.radiance, std::size_t{1});
  visit(a.by_normal, b.by_normal, std::size_t{1});
  visit(a.batch, b.batch, static_cast<std::size_t>(b.batches));
  visit(a.shared_variance, b.shared_variance, std::size_t{1});
  visit(a.light, b.light, std::size_t{1});
}

/// The rows of all parts, one part after the other; `none`, which has no rows, where there are no
/// parts. All are of one form.
LightTable joined(LightTable none, std::vector<LightTable> parts);

/// Adds the rows of a table.
inline void put(const LightTable& rows, ByteWriter& bytes) {
  bytes.put(rows.first);
  for_each_column(rows, rows,
                  [&](const auto& column, const auto&, std::size_t) { bytes.put(column); });
}

/// Appends the rows that `put` has added, of a table of the same form.
inline void append(ByteReader& bytes, LightTable& all) {
  LightTable part(all.lights, false);
  part.batches = all.batches;
  bytes.append_to(part.first);
  for_each_column(part, part,
                  [&](auto& column, const auto&, std::size_t) { bytes.append_to(column); });
  all.append(std::move(part));
}

}  // namespace photile::light
