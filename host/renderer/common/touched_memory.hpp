// Large vectors whose memory all cores touch first, and memory that is given back.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>
#include <vector>

#if defined(__GLIBC__)  // which the headers above define
#include <malloc.h>
#endif

namespace photile {

/// A vector of zeros. The system clears memory page by page as it is touched first, which takes
/// several times as long as writing to it: that is shared among all cores.
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

/// Gives back to the system what threads have freed: glibc keeps it for each thread apart, where
/// large arrays have no use for it.
inline void return_freed_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace photile
