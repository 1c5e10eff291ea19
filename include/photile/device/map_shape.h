/* The surface of a pair of photon maps, as C++ and OpenCL C both see it: one triangle or a
   patch of them, both sides. Scalar members only: a float3 is 16 bytes on the device. */
#ifndef PHOTILE_DEVICE_MAP_SHAPE_H
#define PHOTILE_DEVICE_MAP_SHAPE_H

#define PHOTILE_NO_TRIANGLE 0xFFFFFFFFu

/* An oriented box around the triangles. A point p has the coordinates
     u = (p - origin) . u_axis,  v = (p - origin) . v_axis,  h = (p - origin) . axis      (metres)
   and the box spans [0, width_u] x [0, width_v] x [0, height]. */
typedef struct {
  float origin_x, origin_y, origin_z;
  float u_axis_x, u_axis_y, u_axis_z;
  float v_axis_x, v_axis_y, v_axis_z;
  float axis_x, axis_y, axis_z;
  float width_u, width_v, height;
  float area;      /* of the triangles, one side, square metres */
  float perimeter; /* of the triangle, or of the box's rectangle, metres */
  /* A photon agrees with every member if the cosine of the angle between its normal and the axis of
     its side is at least this; above 1 where no photon is certain to. */
  float certain_cosine;
  /* The axis-aligned box: photons that are entered must be near both boxes, so that the lists of
     candidates, which this one makes, decide nothing. */
  float low_x, low_y, low_z, high_x, high_y, high_z;
  unsigned int triangle; /* index of its corners where photons are compared with a single triangle,
                            else PHOTILE_NO_TRIANGLE */
} PhotileMapShape;

#endif
