// Holds no code: the test executables reuse its precompiled headers (tests/CMakeLists.txt).
