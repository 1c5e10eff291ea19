/* The arguments of the build kernels, as C++ and OpenCL C both see them. */
#ifndef PHOTILE_DEVICE_BUILD_H
#define PHOTILE_DEVICE_BUILD_H

/* A page of photons. Kernels take it by value, like the next structure. */
typedef struct {
  unsigned int photon_count;
  unsigned int first_photon; /* index of the page's first photon among all photons */
  unsigned int first_list;   /* number of the page's first list of candidate maps among all */
  float squared_reach;       /* square of the radius, grown by the rounding of positions */
} PhotilePhotonPage;

/* Maps [first_map, last_map). */
typedef struct {
  unsigned int first_map, last_map;
} PhotileMapRange;

#endif
