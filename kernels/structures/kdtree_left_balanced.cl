// Nearest photons in a left-balanced kd-tree without pointers and without a stack: Wald, "A
// Stack-Free Traversal Algorithm for Left-Balanced k-d Trees" (2022). Node i is record i, its
// children are 2 i + 1 and 2 i + 2. The node that a search came from decides what it does next:
// from the parent, it takes the node's photon and goes to the side of the hit; from that child to
// the other, if that may hold a photon within the cut; from there back.
//
// Axes are those of the widest extent, as in all kd-trees here, and not cyclic: photons lie on
// surfaces, where one axis of three separates none.

#include "structures/search.clh"

// Words hold the axes of records, two bits each: record i's at 2 (i % 16) of word i / 16.
static void find_nearest(Search* search, const Structure* in, uint photons, NearestList* list) {
  const uint record_count = in->record_count;
  const uint outside = 0xFFFFFFFFu;  // the parent of the root
  uint node = 0, from = outside;
  while (node != outside) {
    const uint parent = node == 0 ? outside : (node - 1) / 2;
    if (node >= record_count) {  // the side of the hit may be empty where the other is not
      from = node;
      node = parent;
      continue;
    }
    const uint child = 2 * node + 1;
    const bool from_parent = from == parent;
    const float dx = search->position[node] - search->hit.x;
    const float dy = search->position[search->stride + node] - search->hit.y;
    const float dz = search->position[2 * search->stride + node] - search->hit.z;
    if (from_parent) {
      ++search->nodes;
      ++search->photons;
      const float squared_distance = (dx * dx + dy * dy) + dz * dz;
      if (squared_distance <= cut_of(list)) offer_record(search, squared_distance, node, list);
    }
    const uint axis = (in->nodes[node / 16] >> (2 * (node % 16))) & 3u;
    const float to_plane = axis == 0 ? dx : axis == 1 ? dy : dz;
    const uint nearer = child + (to_plane < 0.0f ? 1u : 0u);
    const uint farther = child + (to_plane < 0.0f ? 0u : 1u);
    uint next = parent;
    if (from_parent) {
      if (child < record_count) next = nearer;
    } else if (from == nearer && farther < record_count && to_plane * to_plane <= cut_of(list)) {
      next = farther;
    }
    from = node;
    node = next;
  }
}

#include "structures/kernels.clh"
