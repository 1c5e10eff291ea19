// Settings made from others: more or less of all work, and those of a first picture.
#pragma once

#include <algorithm>
#include <bit>

#include "photile/renderer.hpp"

namespace photile {

/// The settings that the quality `final` has more of than `good` (photons, samples of a pixel, rays
/// of nodes) times `factor`, each within its range.
RenderParameters with_work(RenderParameters parameters, double factor);
/// Whether all of these settings may be multiplied by `factor`.
bool allows_work(const RenderParameters& parameters, int factor);

/// Whether light maps are to grow in rounds (docs/light-maps.md): their nodes gather, and there are
/// several passes, each a part of the work.
bool grows(const RenderParameters& asked);
/// The settings of this many parts together, which `grows` where there are several.
RenderParameters of_parts(const RenderParameters& part, int parts);
/// The settings of one of its parts, which has a ray, a photon and a sample at least. `all.passes`
/// is at least 1.
RenderParameters part_of(const RenderParameters& all);
/// The parts with which rounds end: 1, 2, 3, 4, 6, 8, 12, 16 and so on.
constexpr int parts_after(int parts) {
  const int power = static_cast<int>(std::bit_floor(static_cast<unsigned>(parts)));
  return parts == power ? parts + std::max(1, parts / 2) : 2 * power;
}
/// Calls grow(parts) for each round after the first, with the parts that it adds, until there are
/// `all`.
template <class Grow>
void for_later_rounds(int all, const Grow& grow) {
  for (int parts = 1; parts < all;) {
    const int next = std::min(parts_after(parts), all);
    grow(next - parts);
    parts = next;
  }
}
/// The factor on the photons of a part when there are this many parts of rays and samples: photons
/// err less than rays, and nodes need to lie closer together only when the error of rays is small.
constexpr int photons_of_parts(int parts) {
  int photons = 1;
  while (parts / 16 >= photons) photons *= 4;
  return photons;
}

/// The settings of the first picture in a sequence that ends with these parameters:
/// defaults::view_first_photons paths. Nodes that gather lie half a metre apart, and closer where
/// their light differs; otherwise estimates value the coarsest nodes alone, and direct light is
/// among them, whatever finds it later.
RenderParameters first_picture_parameters(const RenderParameters& asked);

}  // namespace photile
