// The one place where tinygltf is compiled; a system header, so its warnings stay its own.
// It takes the address of a picture's first byte before it is checked whether the buffer has one
// (keep_encoded): nothing is read there, but a library that asserts would end the program.
#undef _GLIBCXX_ASSERTIONS
#define TINYGLTF_IMPLEMENTATION
#include "gltf/tiny_gltf.hpp"
