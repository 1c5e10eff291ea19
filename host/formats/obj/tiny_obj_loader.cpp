// The one place where tinyobjloader is compiled; a system header, so its warnings stay its own.
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>
