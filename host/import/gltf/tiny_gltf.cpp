// The one place where tinygltf is compiled; a system header, so its warnings stay its own.
#define TINYGLTF_IMPLEMENTATION
#include "import/gltf/tiny_gltf.hpp"
