// Which rectangles light from beyond a scene comes in by.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "photile/load_scene.hpp"
#include "photile/scene.hpp"

namespace photile::trace {

/// Finds openings and panes of the rooms in which the points, or else the cameras, are: paths from
/// there leave by them, and where they cross the planes of the scene's surfaces, those of a window
/// lie closest together. Empty where all of them are outside, or where light comes in nearly
/// everywhere. Depends on the scene and the points alone.
///   points   in the scene; at most `most_search_points` of them are taken, evenly
std::vector<Portal> find_portals(const Scene& scene, std::span<const glm::dvec3> points = {});
inline constexpr std::size_t most_search_points = 8;

/// The rectangles around what is made of materials whose names match one of the globs, facing away
/// from the sky. Errors: UsageError where a glob matches no material that is there, or where there
/// are more than limits::max_portals.
std::vector<Portal> portals_of_materials(const Scene& scene, std::span<const std::string> globs);

/// The portals that SceneLoadOptions::portals requests. Errors: those above; UsageError where
/// "auto" or "off" stand beside others.
std::vector<Portal> portals_asked_for(const Scene& scene, std::span<const std::string> asked,
                                      std::span<const glm::dvec3> points = {});

}  // namespace photile::trace
