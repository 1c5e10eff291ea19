// Large pages for the buffers of CPU devices.
#pragma once

#include <cstddef>

#include "device/opencl.hpp"

namespace photile::device {

/// Asks the operating system to back a new buffer of a CPU device with large pages: a query reads
/// short ranges all over a map, and with pages of 4 KiB waits for the translation of their
/// addresses. For large buffers, on Linux; a wish that may go unheard. Call it before the buffer is
/// first written.
void prefer_huge_pages(cl_command_queue queue, cl_mem memory, std::size_t bytes);

}  // namespace photile::device
