#include "device/huge_pages.hpp"

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <cstdint>

namespace photile::device {

#if defined(__linux__) && defined(MADV_HUGEPAGE)

namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20;
constexpr std::size_t least_bytes = 4 * huge_page;

}  // namespace

void prefer_huge_pages(cl_command_queue queue, cl_mem memory, std::size_t bytes) {
  if (bytes < least_bytes) return;
  // On a CPU a mapped buffer is the buffer itself; where it is a copy, the advice is merely
  // useless.
  void* const mapped = clEnqueueMapBuffer(queue, memory, CL_TRUE, CL_MAP_WRITE_INVALIDATE_REGION, 0,
                                          bytes, 0, nullptr, nullptr, nullptr);
  if (mapped == nullptr) return;
  const auto begin = reinterpret_cast<std::uintptr_t>(mapped);
  const std::uintptr_t first = (begin + huge_page - 1) / huge_page * huge_page;
  const std::uintptr_t last = (begin + bytes) / huge_page * huge_page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
  clEnqueueUnmapMemObject(queue, memory, mapped, 0, nullptr, nullptr);
}

#else

void prefer_huge_pages(cl_command_queue, cl_mem, std::size_t) {}

#endif

}  // namespace photile::device
