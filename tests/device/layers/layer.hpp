// What an OpenCL layer needs: the loader calls clGetLayerInfo and clInitLayer of the library that
// OPENCL_LAYERS names and puts the layer's functions in front of the runtime's. A loader passes
// over a layer that it cannot load without a word: one that is loaded writes the file that
// PHOTILE_LAYER_MARK names, for tests that would otherwise run without it.
#pragma once

#define CL_TARGET_OPENCL_VERSION 120
#define CL_USE_DEPRECATED_OPENCL_1_2_APIS
#include <CL/cl_layer.h>

/// The functions below this layer. Valid after clInitLayer.
extern const cl_icd_dispatch* next;

/// Sets the entries that the layer replaces. Each layer defines it.
void replace_entries(cl_icd_dispatch& entries);
