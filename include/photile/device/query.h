/* The arguments of the estimate kernels, as C++ and OpenCL C both see them. Scalar members and
   arrays of them only: a float3 is 16 bytes on the device. */
#ifndef PHOTILE_DEVICE_QUERY_H
#define PHOTILE_DEVICE_QUERY_H

/* A launch over hits on the maps of one page; hits on other pages are skipped. Kernels take it by
   value. */
typedef struct {
  unsigned int first_hit, hit_count; /* hits [first_hit, first_hit + hit_count) of the batch */
  unsigned int first_map, map_count; /* of the page */
  unsigned int record_stride;        /* from one plane of the page's photon records to the next */
  unsigned int k;                    /* at most this many neighbours, */
  float radius;                      /* none farther than this, metres */
  float least_radius;                /* to which smaller discs are enlarged, metres */
  float least_cosine;                /* of the angle between normals that agree */
} PhotileQuery;

typedef struct {
  float position[3]; /* metres */
  unsigned int map;  /* that the hit lies on */
} PhotileHit;

/* The surface at a hit, where normals are compared or discs are clipped. */
typedef struct {
  float normal[3];     /* of the hit's oriented face */
  float inwards[3];    /* from the hit to the centroid of its triangle */
  unsigned int region; /* as in photile/device/surface.h, like those below */
  unsigned int triangle;
  unsigned int component;
} PhotileHitSurface;

/* The reflection at a hit, where surfaces have a specular lobe. */
typedef struct {
  float outgoing[3]; /* towards the eye, unit */
  float normal[3];   /* that shades, unit */
  float diffuse[9];  /* photile_set_diffuse: three parts of three channels */
  float f0[3];
  float f90;
  float alpha;            /* of GGX */
  float smooth_normal[3]; /* and the most that a normal map multiplies by: photile_bump_weight */
  float most_bump;
} PhotileHitLobe;

#endif
