/* The nearest of a million points, from C. */
#include <math.h>
#include <photile/neighbours.h>
#include <stdio.h>
#include <stdlib.h>

int main(int count, char** arguments) {
  enum { points = 1000000, queries = 3, k = 4 };
  const float asked[3 * queries] = {0, 0, 0, 0.5f, 0.5f, 0.5f, 1, 1, 2};
  float* const coordinates = malloc(3 * points * sizeof(float));
  uint32_t indices[queries * k];
  float distances[queries * k];
  photile_device* device = NULL;
  if (coordinates == NULL) return 1;
  for (int i = 0; i < 3 * points; ++i) coordinates[i] = (float)rand() / (float)RAND_MAX;

  photile_status status = photile_open_device(count > 1 ? arguments[1] : "", &device);
  if (status == PHOTILE_OK) {
    status = photile_find_neighbours(device, coordinates, points, asked, queries, k, INFINITY,
                                     indices, distances);
  }
  if (status != PHOTILE_OK) {
    fprintf(stderr, "%s\n", photile_last_error());
  } else {
    for (int i = 0; i < queries * k; ++i) {
      printf("query %d: point %u, %.4f away\n", i / k, (unsigned)indices[i], distances[i]);
    }
  }
  photile_close_device(device);
  free(coordinates);
  return status == PHOTILE_OK ? 0 : 1;
}
