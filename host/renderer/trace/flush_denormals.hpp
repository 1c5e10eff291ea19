// Embree asks for denormal numbers to be flushed to zero in every thread that traces rays.
#pragma once

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace photile::trace {

/// Flushes denormal results and operands to zero while it lives; restores the thread's mode after.
class FlushDenormals {
 public:
#if defined(__SSE__)
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); }
  ~FlushDenormals() { _mm_setcsr(saved_); }
#else
  FlushDenormals() = default;
#endif
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
#if defined(__SSE__)
  unsigned saved_;
#endif
};

}  // namespace photile::trace
