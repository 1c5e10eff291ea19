#include "render/exchange.hpp"

#include <numeric>
#include <utility>

#include "common/byte_stream.hpp"
#include "estimate/map_order.hpp"

namespace photile {
namespace {

std::vector<std::byte> bytes_of(const PrimaryHits& hits) {
  ByteWriter bytes;
  bytes.put(hits.position);
  bytes.put(hits.sided_triangle);
  const bool glossy = !hits.outgoing.empty();
  bytes.put(glossy ? hits.diffuse_albedo : std::vector<glm::vec3>());
  bytes.put(hits.outgoing);
  bytes.put(hits.lobe);
  return bytes.take();
}

void append_hits(std::span<const std::byte> bytes, PrimaryHits& hits) {
  ByteReader reader(bytes);
  reader.append_to(hits.position);
  reader.append_to(hits.sided_triangle);
  reader.append_to(hits.diffuse_albedo);
  reader.append_to(hits.outgoing);
  reader.append_to(hits.lobe);
}

/// Estimates [first, first + count).
Estimates part_of(const Estimates& all, std::size_t first, std::size_t count, std::size_t lights) {
  const bool many = !all.first.empty();
  const std::size_t begin = many ? all.first[first] : first * lights;
  const std::size_t end = many ? all.first[first + count] : (first + count) * lights;
  const auto slice = [&](const auto& values) {
    using Values = std::remove_cvref_t<decltype(values)>;
    if (values.empty()) return Values{};
    return Values(values.begin() + static_cast<std::ptrdiff_t>(begin),
                  values.begin() + static_cast<std::ptrdiff_t>(end));
  };
  Estimates part;
  part.irradiance = slice(all.irradiance);
  part.radiance = slice(all.radiance);
  part.light = slice(all.light);
  for (std::size_t hit = 0; many && hit <= count; ++hit) {
    part.first.push_back(all.first[first + hit] - begin);
  }
  return part;
}

std::vector<std::byte> bytes_of(const Estimates& estimates) {
  ByteWriter bytes;
  bytes.put(estimates.irradiance);
  bytes.put(estimates.radiance);
  bytes.put(estimates.first);
  bytes.put(estimates.light);
  return bytes.take();
}

void append_estimates(std::span<const std::byte> bytes, Estimates& estimates) {
  ByteReader reader(bytes);
  Estimates part;
  part.irradiance = reader.take<glm::vec3>();
  part.radiance = reader.take<glm::vec3>();
  part.first = reader.take<std::uint64_t>();
  part.light = reader.take<std::uint16_t>();
  estimates.append(std::move(part));
}

}  // namespace

Estimates Exchange::none_yet() const {
  Estimates estimates;
  if (many_) estimates.first.push_back(0);
  return estimates;
}

std::vector<std::vector<std::uint32_t>> Exchange::by_owner(const PrimaryHits& points) const {
  std::vector<std::vector<std::uint32_t>> places(processes_.size());
  for (std::uint32_t point = 0; point < points.size(); ++point) {
    places[owners_->of(points.sided_triangle[point])].push_back(point);
  }
  return places;
}

Estimates Exchange::in_order(std::span<const std::vector<std::uint32_t>> places,
                             std::span<const std::vector<std::byte>> bytes,
                             std::size_t points) const {
  std::vector<std::uint32_t> order;
  Estimates all = none_yet();
  order.reserve(points);
  for (std::size_t rank = 0; rank < places.size(); ++rank) {
    order.insert(order.end(), places[rank].begin(), places[rank].end());
    if (!places[rank].empty()) append_estimates(bytes[rank], all);
  }
  return estimate::restored(std::move(all), order, lights_);
}

Estimates Exchange::at_own(const PrimaryHits& points, const Progress& progress) {
  const std::uint32_t ranks = processes_.size(), own = processes_.rank();
  const std::vector<std::vector<std::uint32_t>> places = by_owner(points);
  std::vector<Communicator::Bytes> asked(ranks);
  for (std::uint32_t rank = 0; rank < ranks; ++rank) {
    if (places[rank].empty()) continue;
    asked[rank] = bytes_of(estimate::reordered(points, 0, places[rank]));
    if (rank == own) continue;
    traffic_.points += places[rank].size();
    traffic_.bytes += asked[rank].size();
  }
  asked = processes_.exchange(std::move(asked));
  PrimaryHits all;
  std::vector<std::size_t> first{0};
  for (Communicator::Bytes& bytes : asked) {
    if (!bytes.empty()) append_hits(bytes, all);
    first.push_back(all.size());
    bytes = {};
  }
  const Estimates found = all.size() > 0 ? here_->at(all, progress) : none_yet();
  std::vector<Communicator::Bytes> answers(ranks);
  for (std::uint32_t rank = 0; rank < ranks; ++rank) {
    const std::size_t count = first[rank + 1] - first[rank];
    if (count == 0) continue;
    answers[rank] = bytes_of(part_of(found, first[rank], count, lights_));
    if (rank != own) traffic_.bytes += answers[rank].size();
  }
  answers = processes_.exchange(std::move(answers));
  return in_order(places, answers, points.size());
}

Estimates Exchange::at_common(const PrimaryHits& points, const Progress& progress) {
  const std::vector<std::vector<std::uint32_t>> places = by_owner(points);
  const std::vector<std::uint32_t>& own = places[processes_.rank()];
  const Communicator::Bytes bytes =
      own.empty() ? Communicator::Bytes()
                  : bytes_of(here_->at(estimate::reordered(points, 0, own), progress));
  return in_order(places, processes_.gather(bytes), points.size());
}

}  // namespace photile
