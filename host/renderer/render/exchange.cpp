#include "render/exchange.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <utility>

#include "common/byte_stream.hpp"
#include "estimate/map_order.hpp"
#include "light/table_bytes.hpp"
#include "photile/communicator.hpp"
#include "render/pass_count.hpp"

namespace photile {
namespace {

std::vector<std::byte> bytes_of(const PrimaryHits& hits) {
  ByteWriter bytes;
  bytes.put(hits.position);
  bytes.put(hits.oriented_face);
  const bool glossy = !hits.outgoing.empty();
  bytes.put(glossy ? hits.diffuse_albedo : std::vector<glm::vec3>());
  bytes.put(hits.outgoing);
  bytes.put(hits.lobe);
  return bytes.take();
}

void append_hits(std::span<const std::byte> bytes, PrimaryHits& hits) {
  ByteReader reader(bytes);
  reader.append_to(hits.position);
  reader.append_to(hits.oriented_face);
  reader.append_to(hits.diffuse_albedo);
  reader.append_to(hits.outgoing);
  reader.append_to(hits.lobe);
}

std::vector<std::byte> bytes_of(const LightTable& rows) {
  ByteWriter bytes;
  light::put(rows, bytes);
  return bytes.take();
}

void append_rows(std::span<const std::byte> bytes, LightTable& all) {
  ByteReader reader(bytes);
  light::append(reader, all);
}

/// Calls visit(values, first, count) for all that a process's rows consist of: `count` values of
/// planes, from `first` on, or all of sparse rows.
template <class Visit>
void for_each_part(LightLayers& layers, const Shard& shard, const Visit& visit) {
  const auto height = static_cast<std::uint64_t>(layers.height);
  const auto width = static_cast<std::uint64_t>(layers.width);
  const std::uint64_t begin = shard.begin(height), end = shard.end(height);
  if (!layers.sparse()) {
    for (LightLayers::Layer& layer : layers.layers) {
      visit(layer.radiance, begin * width, (end - begin) * width);
      visit(layer.illuminance, begin * width, (end - begin) * width);
    }
    return;
  }
  const auto visit_all = [&](auto& values) { visit(values, 0, values.size()); };
  for (std::uint64_t y = begin; y < end; ++y) {
    visit_all(layers.rows[y].first);
    visit_all(layers.rows[y].light);
    visit_all(layers.rows[y].radiance);
    visit_all(layers.rows[y].illuminance);
  }
}

template <class Visit>
void for_each_part(LobeFilm& film, const Shard& shard, const Visit& visit) {
  for_each_part(film.halves, shard, visit);
  for_each_part(film.mixed, shard, visit);
  const auto height = static_cast<std::uint64_t>(film.mixed.height);
  const std::uint64_t width = film.lobes.size() / height, begin = shard.begin(height);
  visit(film.lobes, begin * width, (shard.end(height) - begin) * width);
}

template <class Film>
void bring_parts(Communicator& processes, Film& film) {
  const std::uint32_t ranks = processes.size(), own = processes.rank();
  std::vector<Communicator::Bytes> to_each(ranks);
  if (own > 0) {
    ByteWriter bytes;
    for_each_part(film, {own, ranks},
                  [&](const auto& values, std::size_t first, std::size_t count) {
                    bytes.put(std::span(values).subspan(first, count));
                  });
    to_each[0] = bytes.take();
  }
  const std::vector<Communicator::Bytes> got = processes.exchange(std::move(to_each));
  for (std::uint32_t rank = 1; own == 0 && rank < ranks; ++rank) {
    ByteReader reader(got[rank]);
    for_each_part(film, {rank, ranks},
                  [&]<class T>(std::vector<T>& values, std::size_t first, std::size_t count) {
                    std::vector<T> part = reader.take<T>();
                    if (count == values.size()) {
                      values = std::move(part);
                    } else {
                      std::copy(part.begin(), part.end(),
                                values.begin() + static_cast<std::ptrdiff_t>(first));
                    }
                  });
  }
}

std::vector<ContentHash::Digest> digests_of_all(Communicator& processes, const ContentHash& hash) {
  const ContentHash::Digest own = hash.digest();
  return processes.gather_values<ContentHash::Digest>(std::span(&own, 1));
}

}  // namespace

LightTable Exchange::at(const PrimaryHits& points, const Progress& progress) {
  return is_common(points) ? at_common(points, progress) : at_own(points, progress);
}

bool Exchange::is_common(const PrimaryHits& points) const {
  ContentHash hash;
  hash.add(bytes_of(points));
  const auto all = digests_of_all(processes_, hash);
  return std::count(all.begin(), all.end(), all.front()) == std::ssize(all);
}

std::vector<std::vector<std::uint32_t>> Exchange::by_owner(const PrimaryHits& points) const {
  std::vector<std::vector<std::uint32_t>> of_owners(processes_.size());
  for (std::uint32_t point = 0; point < points.size(); ++point) {
    of_owners[owners_->of(points.oriented_face[point])].push_back(point);
  }
  return of_owners;
}

LightTable Exchange::in_order(std::span<const std::vector<std::uint32_t>> of_owners,
                              std::span<const std::vector<std::byte>> bytes,
                              std::size_t points) const {
  std::vector<std::uint32_t> row_of(points);
  LightTable all = none_;
  std::uint32_t row = 0;
  for (std::size_t rank = 0; rank < of_owners.size(); ++rank) {
    for (const std::uint32_t point : of_owners[rank]) row_of[point] = row++;
    if (!of_owners[rank].empty()) append_rows(bytes[rank], all);
  }
  return all.gathered(row_of);
}

LightTable Exchange::at_own(const PrimaryHits& points, const Progress& progress) {
  const std::uint32_t ranks = processes_.size(), own = processes_.rank();
  const std::vector<std::vector<std::uint32_t>> of_owners = by_owner(points);
  std::vector<Communicator::Bytes> asked(ranks);
  for (std::uint32_t rank = 0; rank < ranks; ++rank) {
    if (of_owners[rank].empty()) continue;
    asked[rank] = bytes_of(estimate::reordered(points, of_owners[rank]));
    if (rank == own) continue;
    sent_.points += of_owners[rank].size();
    sent_.point_bytes += asked[rank].size();
  }
  asked = processes_.exchange(std::move(asked));
  PrimaryHits all;
  std::vector<std::size_t> first{0};
  for (Communicator::Bytes& bytes : asked) {
    if (!bytes.empty()) append_hits(bytes, all);
    first.push_back(all.size());
    bytes = {};
  }
  const LightTable found = all.size() > 0 ? here_->at(all, progress) : none_;
  std::vector<Communicator::Bytes> answers(ranks);
  for (std::uint32_t rank = 0; rank < ranks; ++rank) {
    const std::size_t count = first[rank + 1] - first[rank];
    if (count == 0) continue;
    answers[rank] = bytes_of(found.slice(first[rank], count));
    if (rank != own) sent_.point_bytes += answers[rank].size();
  }
  answers = processes_.exchange(std::move(answers));
  return in_order(of_owners, answers, points.size());
}

LightTable Exchange::at_common(const PrimaryHits& points, const Progress& progress) {
  const std::vector<std::vector<std::uint32_t>> of_owners = by_owner(points);
  const std::vector<std::uint32_t>& own = of_owners[processes_.rank()];
  const Communicator::Bytes bytes =
      own.empty() ? Communicator::Bytes()
                  : bytes_of(here_->at(estimate::reordered(points, own), progress));
  return in_order(of_owners, processes_.gather(bytes), points.size());
}

void require_same(Communicator& processes, const ContentHash& work, std::string_view what) {
  const auto all = digests_of_all(processes, work);
  for (std::size_t rank = 1; rank < all.size(); ++rank) {
    if (all[rank] == all.front()) continue;
    throw UsageError(fmt::format(
        "ranks {0} and 0 of one rendering differ in their {1}; give all the same files and options",
        rank, what));
  }
}

void bring_rows(Communicator& processes, LightLayers& layers) { bring_parts(processes, layers); }
void bring_rows(Communicator& processes, LobeFilm& film) { bring_parts(processes, film); }

std::uint64_t host_bytes_of_all(Communicator* processes) {
  if (!processes) return installed_host_bytes();
  constexpr std::uint64_t most = std::uint64_t{1} << 56;  // where nothing is known
  std::uint64_t bytes = std::min(most, installed_host_bytes()) / processes->on_this_machine();
  processes->sum(std::span(&bytes, 1));
  return bytes;
}

void add_processes(Communicator& all, RenderCosts& costs) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto memory = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts KiB
  const Communicator::Traffic traffic = all.traffic();
  const std::array own{costs.references,
                       costs.maps,
                       costs.normal_filtered_maps,
                       costs.largest_map,
                       costs.rays,
                       costs.hit_count,
                       costs.sent.photons,
                       costs.sent.photon_bytes,
                       costs.sent.photons_held,
                       costs.sent.points,
                       costs.sent.point_bytes,
                       traffic.bytes,
                       memory,
                       std::bit_cast<std::uint64_t>(costs.light_map_errors.squares),
                       std::bit_cast<std::uint64_t>(costs.light_map_errors.weight)};
  using Counts = std::array<std::uint64_t, own.size()>;
  const auto of_ranks = all.gather_values<Counts>(std::span<const Counts>(&own, 1));
  Counts sum{}, most{};
  for (const Counts& rank : of_ranks) {
    for (std::size_t i = 0; i < own.size(); ++i) {
      sum[i] += rank[i];
      most[i] = std::max(most[i], rank[i]);
    }
  }
  costs.references = sum[0], costs.maps = sum[1], costs.normal_filtered_maps = sum[2],
  costs.largest_map = most[3];
  costs.rays = sum[4], costs.hit_count = sum[5];
  costs.light_map_errors = {};
  for (const auto& rank : of_ranks) {
    costs.light_map_errors.squares += std::bit_cast<double>(rank[13]);
    costs.light_map_errors.weight += std::bit_cast<double>(rank[14]);
  }
  const auto number = [](std::uint64_t count) { return static_cast<double>(count); };
  const auto ratio = [](std::uint64_t a, std::uint64_t b) {
    return static_cast<double>(a) / static_cast<double>(std::max<std::uint64_t>(1, b));
  };
  costs.processes = {
      {"processes", number(all.size())},
      {"photons sent", number(sum[6])},
      {"bytes sent per stored photon", ratio(sum[7], costs.stored_photons)},
      {"photons held, largest over mean", ratio(most[8] * all.size(), sum[8])},
      {"photons held over stored", ratio(sum[8], costs.stored_photons + costs.caustic_photons)},
      {"hits sent", number(sum[9])},
      {"bytes per hit sent", ratio(sum[10], sum[9])},
      {"bytes sent", number(sum[11])},
      {"calls", number(traffic.calls)},
      {"seconds waited", traffic.seconds},
      {"host bytes of a process, most", number(most[12])},
      {"host bytes of a process, mean", ratio(sum[12], all.size())}};
}

}  // namespace photile
