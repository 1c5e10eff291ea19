// Tables of light as bytes, for processes that send them to each other.
#pragma once

#include <utility>

#include "common/byte_stream.hpp"
#include "photile/light_table.hpp"

namespace photile::light {

/// Adds the rows of a table.
inline void put(const LightTable& rows, ByteWriter& bytes) {
  bytes.put(rows.irradiance);
  bytes.put(rows.radiance);
  bytes.put(rows.by_normal);
  bytes.put(rows.first);
  bytes.put(rows.light);
  bytes.put(rows.batch);
  bytes.put(rows.shared_variance);
}

/// Appends the rows that `put` has added, of a table of the same form.
inline void append(ByteReader& bytes, LightTable& all) {
  LightTable part(all.lights, false);
  part.batches = all.batches;
  bytes.append_to(part.irradiance);
  bytes.append_to(part.radiance);
  bytes.append_to(part.by_normal);
  bytes.append_to(part.first);
  bytes.append_to(part.light);
  bytes.append_to(part.batch);
  bytes.append_to(part.shared_variance);
  all.append(std::move(part));
}

}  // namespace photile::light
