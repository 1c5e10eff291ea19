// Makes chosen OpenCL calls fail.
//
//   OPENCL_LAYERS=<build>/tests/device/layers/libphotile_failing_layer.so
//   PHOTILE_FAIL_CALL=clCreateBuffer   which function (the list is at the end of this file)
//   PHOTILE_FAIL_AT=3                  its n-th call fails, counted from 1; 0 = none
//   PHOTILE_FAIL_STATUS=-4             with this status code
//   PHOTILE_FAIL_ON=1                  and so do all later ones ("device lost")
//   PHOTILE_FAIL_ABOVE=4096            instead, clCreateBuffer fails for more bytes than this
//   PHOTILE_FAIL_BY=new                it asks for more memory than there is, in the thread that
//                                      calls
//   PHOTILE_FAIL_BY=thread             the same in a thread of its own, as runtimes have them
//   PHOTILE_FAIL_BY=abort              it ends the process
//   PHOTILE_FAIL_BY=minute             it takes a minute and a second
//   PHOTILE_FAIL_COUNT_FILE=path       at exit the number of calls is written there
//
// A sweep first counts (PHOTILE_FAIL_AT=0), then lets each call fail in turn: the program must end
// with one message and exit code 4, or with the right result; never by a signal, never hanging.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string_view>
#include <thread>

#include "layer.hpp"

namespace {

const char* text_variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}
long number_variable(const char* name) { return std::strtol(text_variable(name), nullptr, 10); }

std::atomic<long> calls{0};

void write_count() {
  std::FILE* const file = std::fopen(text_variable("PHOTILE_FAIL_COUNT_FILE"), "w");
  if (file == nullptr) return;
  std::fprintf(file, "%ld\n", calls.load());
  std::fclose(file);
}

/// As the compiler of a runtime does; where PHOTILE_FAIL_BY asks for it.
void fail_as_asked() {
  const std::string_view by = text_variable("PHOTILE_FAIL_BY");
  const auto ask = [] { ::operator delete(::operator new(PTRDIFF_MAX)); };
  if (by == "new") ask();
  if (by == "thread") std::thread(ask).join();
  if (by == "abort") std::abort();
  if (by == "minute") std::this_thread::sleep_for(std::chrono::seconds(61));
}

/// The status with which this call of the chosen function must fail, or CL_SUCCESS.
cl_int failure() {
  static const long at = number_variable("PHOTILE_FAIL_AT");
  static const bool on = number_variable("PHOTILE_FAIL_ON") != 0;
  static const auto status = static_cast<cl_int>(number_variable("PHOTILE_FAIL_STATUS"));
  const long call = ++calls;
  if (call == at) fail_as_asked();
  return at != 0 && (call == at || (on && call > at)) ? status : CL_SUCCESS;
}

/// Stands in front of the dispatch entry `entry`. Functions that return a status return the
/// failure; those that return an object return null and give the failure through their last
/// argument.
template <auto entry, class Function>
struct Failing;

template <auto entry, class... Arguments>
struct Failing<entry, cl_int(Arguments...)> {
  static cl_int CL_API_CALL call(Arguments... arguments) {
    if (const cl_int status = failure(); status != CL_SUCCESS) return status;
    return (next->*entry)(arguments...);
  }
};

template <auto entry, class Object, class... Arguments>
struct Failing<entry, Object*(Arguments...)> {
  static Object* CL_API_CALL call(Arguments... arguments) {
    if (const cl_int status = failure(); status != CL_SUCCESS) {
      report(status, arguments...);
      return nullptr;
    }
    return (next->*entry)(arguments...);
  }
  static void report(cl_int status, cl_int* out) {
    if (out != nullptr) *out = status;
  }
  template <class First, class... Rest>
  static void report(cl_int status, First, Rest... rest) {
    report(status, rest...);
  }
};

/// Fails for large buffers.
CL_API_ENTRY cl_mem CL_API_CALL create_small_buffer(cl_context context, cl_mem_flags flags,
                                                    size_t bytes, void* host, cl_int* status) {
  static const auto most = static_cast<size_t>(number_variable("PHOTILE_FAIL_ABOVE"));
  if (bytes > most) {
    if (status != nullptr) *status = CL_MEM_OBJECT_ALLOCATION_FAILURE;
    return nullptr;
  }
  return next->clCreateBuffer(context, flags, bytes, host, status);
}

template <class Function>
struct Pointee;
template <class Function>
struct Pointee<Function*> {
  using type = Function;
};

template <auto entry>
void replace(cl_icd_dispatch& entries) {
  using Pointer = std::remove_reference_t<decltype(entries.*entry)>;
  entries.*entry = &Failing<entry, typename Pointee<Pointer>::type>::call;
}

}  // namespace

void replace_entries(cl_icd_dispatch& entries) {
  const char* const chosen = text_variable("PHOTILE_FAIL_CALL");
#define PHOTILE_FAILABLE(name) \
  if (std::strcmp(chosen, #name) == 0) replace<&cl_icd_dispatch::name>(entries);
  PHOTILE_FAILABLE(clCreateContext)
  PHOTILE_FAILABLE(clCreateCommandQueue)
  PHOTILE_FAILABLE(clCreateBuffer)
  PHOTILE_FAILABLE(clCreateProgramWithSource)
  PHOTILE_FAILABLE(clCreateProgramWithBinary)
  PHOTILE_FAILABLE(clBuildProgram)
  PHOTILE_FAILABLE(clCreateKernel)
  PHOTILE_FAILABLE(clSetKernelArg)
  PHOTILE_FAILABLE(clEnqueueNDRangeKernel)
  PHOTILE_FAILABLE(clEnqueueReadBuffer)
  PHOTILE_FAILABLE(clEnqueueWriteBuffer)
  PHOTILE_FAILABLE(clEnqueueFillBuffer)
  PHOTILE_FAILABLE(clWaitForEvents)
  PHOTILE_FAILABLE(clFinish)
#undef PHOTILE_FAILABLE
  if (*text_variable("PHOTILE_FAIL_ABOVE") != '\0') entries.clCreateBuffer = create_small_buffer;
  std::atexit(write_count);
}
