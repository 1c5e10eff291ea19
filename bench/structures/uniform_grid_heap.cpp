// The library's cells, searched by a list of the nearest: kernels/structures/uniform_grid_heap.cl.
#include "structures/structure.hpp"

namespace photile::structures {
namespace {

Index build_cells(const PhotonLists& lists) {
  return {.record_photon = lists.context.upload(std::span(lists.in_cells), "photon references"),
          .cell_start = lists.context.upload(std::span(lists.cell_start), "cells")};
}

const Registration uniform_grid_heap({.name = "uniform-grid-heap", .build = build_cells});

}  // namespace
}  // namespace photile::structures
