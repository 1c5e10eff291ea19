#include "layer.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

const cl_icd_dispatch* next = nullptr;

extern "C" {

CL_API_ENTRY cl_int CL_API_CALL clGetLayerInfo(cl_layer_info name, size_t bytes, void* value,
                                               size_t* bytes_needed) {
  const cl_layer_api_version version = CL_LAYER_API_VERSION_100;
  const char layer_name[] = "photile test layer";
  const void* const answer = name == CL_LAYER_API_VERSION ? static_cast<const void*>(&version)
                             : name == CL_LAYER_NAME      ? static_cast<const void*>(layer_name)
                                                          : nullptr;
  const size_t size = name == CL_LAYER_API_VERSION ? sizeof version : sizeof layer_name;
  if (answer == nullptr || (value != nullptr && bytes < size)) return CL_INVALID_VALUE;
  if (value != nullptr) std::memcpy(value, answer, size);
  if (bytes_needed != nullptr) *bytes_needed = size;
  return CL_SUCCESS;
}

CL_API_ENTRY cl_int CL_API_CALL clInitLayer(cl_uint record_count, const cl_icd_dispatch* below,
                                            cl_uint* own_record_count,
                                            const cl_icd_dispatch** own_records) {
  static cl_icd_dispatch entries;
  const cl_uint count = sizeof entries / sizeof entries.clGetPlatformIDs;
  if (record_count < count || below == nullptr || own_records == nullptr) return CL_INVALID_VALUE;
  next = below;
  entries = *below;
  replace_entries(entries);
  *own_record_count = count;
  *own_records = &entries;
  if (const char* const mark = std::getenv("PHOTILE_LAYER_MARK")) {
    if (std::FILE* const file = std::fopen(mark, "w")) std::fclose(file);
  }
  return CL_SUCCESS;
}
}
