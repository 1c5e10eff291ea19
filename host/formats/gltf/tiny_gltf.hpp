// tinygltf as photile uses it: pictures stay encoded and external pictures unread, so that the path
// and size checks of SceneFolder and decode_texture are the only way in. Include this header, never
// <tiny_gltf.h>: the macros must be the same everywhere.
#pragma once

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>
