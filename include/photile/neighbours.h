/* The k nearest points of each query, on an OpenCL device: what programs in C call. It is
   find_neighbours of photon_cloud.hpp, without normals. No exception leaves a function. */
#ifndef PHOTILE_NEIGHBOURS_H
#define PHOTILE_NEIGHBOURS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum photile_status {
  PHOTILE_OK = 0,
  PHOTILE_BAD_INPUT = 1,     /* an argument, a point or a query cannot be used */
  PHOTILE_DEVICE_ERROR = 2,  /* no such device, or a call of OpenCL failed */
  PHOTILE_OUT_OF_MEMORY = 3, /* of the host or of the device */
  PHOTILE_INTERNAL_ERROR = 4
} photile_status;

/* An open device with its compiled kernels. One thread at a time may use it. */
typedef struct photile_device photile_device;

/* What failed last in the calling thread, in one line; "" where nothing has. Valid until the next
   call in that thread. */
const char* photile_last_error(void);

/* Opens a device. `selector` is as for --device of the command: "" or NULL takes the best, else
   "gpu", "cpu", "platform:device" or a part of a name. */
photile_status photile_open_device(const char* selector, photile_device** device);

/* NULL is allowed. */
void photile_close_device(photile_device* device);

/* The k nearest of `point_count` points around each of `query_count` queries, nearest first.
   Coordinates are x, y, z of one point after another, up to 1e12, in the unit of the distances.
     point_count    at least 1
     k              1 to 1,000,000; it may exceed point_count
     max_distance   above 0; INFINITY: all points count
     indices        query_count * k; point_count beyond the last neighbour
     distances      query_count * k, or NULL; INFINITY beyond the last neighbour
   Exact up to the rounding of floats: where distances agree to a few roundings, any of the points
   may be the last. The contents of the arrays are undefined unless the status is PHOTILE_OK. */
photile_status photile_find_neighbours(photile_device* device, const float* points,
                                       size_t point_count, const float* queries, size_t query_count,
                                       int k, float max_distance, uint32_t* indices,
                                       float* distances);

#ifdef __cplusplus
}
#endif

#endif
