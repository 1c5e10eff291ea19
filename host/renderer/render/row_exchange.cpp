#include "render/row_exchange.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "common/byte_stream.hpp"
#include "photile/shard.hpp"

namespace photile {
namespace {

/// Rows [first, first + count) of planes and sparse rows.
struct Rows {
  std::size_t first, count;
};

Rows rows_of(const LightLayers& layers, const Shard& shard) {
  const auto height = static_cast<std::uint64_t>(layers.height);
  return {shard.begin(height), shard.end(height) - shard.begin(height)};
}

template <class T>
void put(const std::vector<T>& plane, const Rows& rows, std::size_t width, ByteWriter& bytes) {
  if (plane.empty()) return;
  bytes.put(std::span<const T>(plane).subspan(rows.first * width, rows.count * width));
}

template <class T>
void take(std::vector<T>& plane, const Rows& rows, std::size_t width, ByteReader& reader) {
  if (plane.empty()) return;
  const std::vector<T> values = reader.take<T>();
  std::copy(values.begin(), values.end(),
            plane.begin() + static_cast<std::ptrdiff_t>(rows.first * width));
}

Communicator::Bytes bytes_of(const LightLayers& layers, const Rows& rows) {
  ByteWriter bytes;
  const auto width = static_cast<std::size_t>(layers.width);
  for (const LightLayers::Layer& layer : layers.layers) {
    put(layer.radiance, rows, width, bytes);
    put(layer.illuminance, rows, width, bytes);
  }
  if (!layers.sparse()) return bytes.take();
  for (std::size_t y = rows.first; y < rows.first + rows.count; ++y) {
    const LightLayers::Row& row = layers.rows[y];
    bytes.put(row.first);
    bytes.put(row.light);
    bytes.put(row.radiance);
    bytes.put(row.illuminance);
  }
  return bytes.take();
}

void set_rows(std::span<const std::byte> bytes, const Rows& rows, LightLayers& layers) {
  ByteReader reader(bytes);
  const auto width = static_cast<std::size_t>(layers.width);
  for (LightLayers::Layer& layer : layers.layers) {
    take(layer.radiance, rows, width, reader);
    take(layer.illuminance, rows, width, reader);
  }
  if (!layers.sparse()) return;
  for (std::size_t y = rows.first; y < rows.first + rows.count; ++y) {
    LightLayers::Row row;
    row.first = reader.take<std::uint32_t>();
    row.light = reader.take<std::uint16_t>();
    row.radiance = reader.take<glm::vec3>();
    row.illuminance = reader.take<float>();
    layers.rows[y] = std::move(row);
  }
}

}  // namespace

void bring_rows(Communicator& processes, LightLayers& layers) {
  const std::uint32_t ranks = processes.size();
  std::vector<Communicator::Bytes> to_each(ranks);
  if (processes.rank() > 0) {
    to_each[0] = bytes_of(layers, rows_of(layers, {processes.rank(), ranks}));
  }
  const std::vector<Communicator::Bytes> got = processes.exchange(std::move(to_each));
  if (processes.rank() > 0) return;
  for (std::uint32_t rank = 1; rank < ranks; ++rank) {
    set_rows(got[rank], rows_of(layers, {rank, ranks}), layers);
  }
}

}  // namespace photile
