#include "loading/material_changes.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <string>

#include "photile/errors.hpp"
#include "scene/material_reflectance.hpp"

namespace photile::loading {
namespace {

std::string material_names(const Scene& scene) {
  constexpr std::size_t most = 20;
  std::string names;
  for (std::size_t i = 0; i < scene.materials.size() && i < most; ++i) {
    names += (i == 0 ? "'" : ", '") + scene.materials[i].name + "'";
  }
  return names + (scene.materials.size() > most ? " ..." : "");
}

void apply(Scene& scene, const ReflectanceChange& change) {
  bool found = false;
  for (Material& material : scene.materials) {
    if (::fnmatch(change.glob.c_str(), material.name.c_str(), 0) != 0) continue;
    found = true;
    if (scene::set_reflectance(scene, material, change.share)) continue;
    throw UsageError(fmt::format(
        "reflectance of '{}': {:g} cannot be had by making its colour brighter or darker: it is "
        "glass, its gloss reflects more alone (--set lambertian=on removes that) or a channel "
        "exceeds 1",
        material.name, change.share));
  }
  if (!found) {
    throw UsageError(fmt::format("reflectance of '{}': there is no such material; there are {}",
                                 change.glob, material_names(scene)));
  }
}

}  // namespace

void apply_reflectances(Scene& scene, std::span<const ReflectanceChange> changes) {
  for (const ReflectanceChange& change : changes) apply(scene, change);
}

}  // namespace photile::loading
