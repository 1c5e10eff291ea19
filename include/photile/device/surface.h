/* The surface around a hit, as C++ and OpenCL C both see it: a tree over pieces of surface, eight
   wide in nodes and leaves alike, so that one vector operation tests all eight. Scalar members
   only. */
#ifndef PHOTILE_DEVICE_SURFACE_H
#define PHOTILE_DEVICE_SURFACE_H

#include "photile/device/constants.h"

#define PHOTILE_SURFACE_LEAF 0x80000000u /* in `child`: the index of a leaf follows */
#define PHOTILE_SURFACE_NONE 0xFFFFFFFFu /* in `child`: there is none; its box is empty */

/* Boxes of eight children, metres. */
typedef struct {
  float lower_x[PHOTILE_SURFACE_WIDTH], lower_y[PHOTILE_SURFACE_WIDTH],
      lower_z[PHOTILE_SURFACE_WIDTH];
  float upper_x[PHOTILE_SURFACE_WIDTH], upper_y[PHOTILE_SURFACE_WIDTH],
      upper_z[PHOTILE_SURFACE_WIDTH];
  unsigned int child[PHOTILE_SURFACE_WIDTH];
} PhotileSurfaceNode;

#define PHOTILE_PIECE_BORDER 0x80000000u /* in `triangle`: the piece is a border edge */
#define PHOTILE_COMPONENT_UNLIT \
  0x80000000u /* in `front_component`, `back_component`: without photons */
#define PHOTILE_NO_COMPONENT \
  0xFFFFFFFFu /* in `front_component`, `back_component`: none, and unlit */
#define PHOTILE_UNLIT_REGION 0x7FFFFFFEu /* component of a hit that lies in an unlit region */
#define PHOTILE_NO_REGION 0xFFFFFFFFu    /* in `region`: none whose border is known */

/* Eight pieces. A triangle has its corners a, b, c. A border edge runs from a to b; c is the unit
   vector in the plane of its region, perpendicular to the edge, that points into the region. Lanes
   without a piece are border edges of PHOTILE_NO_REGION. */
typedef struct {
  float a_x[PHOTILE_SURFACE_WIDTH], a_y[PHOTILE_SURFACE_WIDTH], a_z[PHOTILE_SURFACE_WIDTH];
  float b_x[PHOTILE_SURFACE_WIDTH], b_y[PHOTILE_SURFACE_WIDTH], b_z[PHOTILE_SURFACE_WIDTH];
  float c_x[PHOTILE_SURFACE_WIDTH], c_y[PHOTILE_SURFACE_WIDTH], c_z[PHOTILE_SURFACE_WIDTH];
  float normal_x[PHOTILE_SURFACE_WIDTH], normal_y[PHOTILE_SURFACE_WIDTH],
      normal_z[PHOTILE_SURFACE_WIDTH];          /* of the triangle's side 0, unit */
  unsigned int region[PHOTILE_SURFACE_WIDTH];   /* of the triangle, or that the edge bounds */
  unsigned int triangle[PHOTILE_SURFACE_WIDTH]; /* of the scene */
  unsigned int front_component[PHOTILE_SURFACE_WIDTH]; /* of the triangle's side 0 */
  unsigned int back_component[PHOTILE_SURFACE_WIDTH];  /* of its side 1 */
  float front_open_fraction[PHOTILE_SURFACE_WIDTH]; /* that counts of its area: 1, or less where */
  float back_open_fraction[PHOTILE_SURFACE_WIDTH];  /* most of it lies under other surface; -1 of */
                                                    /* unlit regions, which have the component of */
                                                    /* the triangle that they lie on */
} PhotileSurfaceLeaf;

#endif
