// Large vectors whose memory all cores touch first and write, and the return of memory.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

#if defined(__GLIBC__)  // which the headers above define
#include <malloc.h>
#endif

namespace photile {

/// A vector of zeros. The system clears memory page by page as it is touched first, which takes
/// several times as long as writing to it, so this is divided among all cores.
template <class T>
std::vector<T> touched_vector(std::size_t count) {
  constexpr std::size_t page = 4096, pages_per_task = 256;
  std::vector<T> values;
  values.reserve(count);
  auto* const bytes = reinterpret_cast<volatile char*>(values.data());
  const std::size_t pages = count * sizeof(T) / page;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pages, pages_per_task),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i != range.end(); ++i)
                        bytes[i * page] = 0;
                    });
  values.resize(count);
  return values;
}

/// The values of parts, one part after the other.
///   part_of   (i) returns a reference to part i, a vector
template <class PartOf>
auto joined(std::size_t count, const PartOf& part_of) {
  std::vector<std::size_t> first{0};
  for (std::size_t i = 0; i < count; ++i) first.push_back(first.back() + part_of(i).size());
  using Value = typename std::decay_t<decltype(part_of(0))>::value_type;
  std::vector<Value> all = touched_vector<Value>(first.back());
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    std::copy(part_of(i).begin(), part_of(i).end(), all.data() + first[i]);
  });
  return all;
}

/// The numbers below `count` for which is(number) holds, ascending.
template <class Is>
std::vector<std::uint32_t> numbers_where(std::size_t count, const Is& is) {
  constexpr std::size_t per_task = 4096;
  std::vector<std::vector<std::uint32_t>> found((count + per_task - 1) / per_task);
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t task) {
    const std::size_t end = std::min(count, (task + 1) * per_task);
    for (std::size_t i = task * per_task; i < end; ++i) {
      if (is(static_cast<std::uint32_t>(i))) found[task].push_back(static_cast<std::uint32_t>(i));
    }
  });
  return joined(
      found.size(), [&](std::size_t task) -> const auto& { return found[task]; });
}

/// Keeps what the process frees for what it allocates next: large arrays would go back to the
/// system, which clears every page that it gives, and on many cores that takes longer than a
/// frame's sums.
inline void keep_freed_memory() {
#if defined(__GLIBC__)
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

/// Returns to the system what threads have freed: glibc keeps it separately for each thread, where
/// large arrays cannot use it.
inline void return_freed_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace photile
