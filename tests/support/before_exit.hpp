// What a test executable does when all tests have run.
#pragma once

namespace photile::test {

/// Called before the objects of the main thread are destroyed, which a runtime of OpenCL may still
/// use when static objects are.
inline void (*before_exit)() = nullptr;

}  // namespace photile::test
