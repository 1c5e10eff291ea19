#include "device/transfers.hpp"

#include <algorithm>
#include <cstring>

namespace photile::device {

Transfers::Transfers(cl_context context, cl_device_id device) {
  cl_int status = CL_SUCCESS;
  queue_ = QueueHandle(clCreateCommandQueue(context, device, 0, &status));
  check(status, "clCreateCommandQueue", "transfers");
  pinned_ = MemoryHandle(clCreateBuffer(context, CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR,
                                        2 * half_bytes, nullptr, &status));
  check(status, "clCreateBuffer", "pinned memory for transfers");
  mapped_ = clEnqueueMapBuffer(queue_.get(), pinned_.get(), CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0,
                               2 * half_bytes, 0, nullptr, nullptr, &status);
  check(status, "clEnqueueMapBuffer", "pinned memory for transfers");
  halves_[0].memory = static_cast<unsigned char*>(mapped_);
  halves_[1].memory = halves_[0].memory + half_bytes;
}

Transfers::~Transfers() {
  if (mapped_ == nullptr) return;
  clEnqueueUnmapMemObject(queue_.get(), pinned_.get(), mapped_, 0, nullptr, nullptr);
  clFinish(queue_.get());
}

cl_int Transfers::wait(Half& half) {
  if (!half.copied) return CL_SUCCESS;
  const cl_event event = half.copied.get();
  const cl_int status = clWaitForEvents(1, &event);
  half.copied = {};
  return status;
}

template <class Enqueue>
cl_int Transfers::start(Half& half, cl_event after, const Enqueue& enqueue) {
  cl_event event = nullptr;
  const cl_int status =
      enqueue(after != nullptr ? 1u : 0u, after != nullptr ? &after : nullptr, &event);
  if (status != CL_SUCCESS) return status;
  half.copied = EventHandle(event);
  return clFlush(queue_.get());
}

cl_int Transfers::write(cl_mem to, const void* data, std::size_t bytes) {
  const auto* const from = static_cast<const unsigned char*>(data);
  cl_int status = CL_SUCCESS;
  std::size_t turn = 0;
  for (std::size_t at = 0; at < bytes && status == CL_SUCCESS; at += half_bytes, turn = 1 - turn) {
    Half& half = halves_[turn];
    status = wait(half);
    if (status != CL_SUCCESS) break;
    const std::size_t part = std::min(half_bytes, bytes - at);
    std::memcpy(half.memory, from + at, part);
    status = start(half, nullptr, [&](cl_uint count, const cl_event* list, cl_event* event) {
      return clEnqueueWriteBuffer(queue_.get(), to, CL_FALSE, at, part, half.memory, count, list,
                                  event);
    });
  }
  for (Half& half : halves_) {
    const cl_int ended = wait(half);
    if (status == CL_SUCCESS) status = ended;
  }
  return status;
}

cl_int Transfers::read(cl_event after, cl_mem from, void* data, std::size_t bytes) {
  auto* const to = static_cast<unsigned char*>(data);
  const auto part_at = [&](std::size_t at) { return std::min(half_bytes, bytes - at); };
  cl_int status = CL_SUCCESS;
  std::size_t turn = 0;
  // The part before is copied by the host while the device copies this one.
  for (std::size_t at = 0; at < bytes + half_bytes; at += half_bytes, turn = 1 - turn) {
    if (at < bytes && status == CL_SUCCESS) {
      Half& half = halves_[turn];
      status = start(half, after, [&](cl_uint count, const cl_event* list, cl_event* event) {
        return clEnqueueReadBuffer(queue_.get(), from, CL_FALSE, at, part_at(at), half.memory,
                                   count, list, event);
      });
    }
    if (at == 0) continue;
    Half& before = halves_[1 - turn];
    const cl_int ended = wait(before);
    if (status == CL_SUCCESS) status = ended;
    if (status != CL_SUCCESS) break;
    std::memcpy(to + at - half_bytes, before.memory, part_at(at - half_bytes));
  }
  for (Half& half : halves_) wait(half);  // after a failure
  return status;
}

}  // namespace photile::device
