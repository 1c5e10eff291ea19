// Materials of an MTL library, as its statements say them (Alias|Wavefront, "MTL material format"
// 4.2, and the PBR extension of Exocortex).
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "reading/import_context.hpp"

namespace photile::obj {

/// Values that a material does not state are empty: no number is invented, and none is kept from
/// the material before.
struct MtlMaterial {
  std::string name;
  /// Linear Rec.709; Tf is the tint of what passes.
  std::optional<glm::dvec3> Kd, Ks, Ke, Tf;
  std::optional<double> Ns, Ni, d, Pr, Pm;  ///< d also from Tr, which is its complement
  int illum = 0;
  std::string map_Kd, map_Ke, map_d, norm;  ///< "" = none
  double norm_scale = 1;                    ///< -bm of norm
};

/// Reads a library. Keywords are those of the format in any case. What is ignored is named in a
/// warning. Errors: InputError with the library, the line, what was found and the remedy, where a
/// number that decides on light is none, or is out of its range.
///   library   as messages name it
std::vector<MtlMaterial> read_mtl(const std::string& library, std::string text,
                                  reading::ImportContext& context);

}  // namespace photile::obj
