// The rectangles through which light from beyond a scene enters.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "photile/load_scene.hpp"
#include "photile/scene.hpp"

namespace photile::trace {

/// Finds openings and panes of the rooms in which the points, or else the cameras, are: paths from
/// there leave through them, and their crossings of the planes of the scene's surfaces are densest
/// at windows. Empty where all of them are outside, or where light enters nearly everywhere.
/// Depends on the scene and the points alone.
///   points   in the scene; at most `most_search_points` of them are used, evenly
std::vector<Portal> find_portals(const Scene& scene, std::span<const glm::dvec3> points = {});
inline constexpr std::size_t most_search_points = 8;

/// The rectangles around what is made of materials whose names match one of the globs, facing away
/// from the sky. Errors: UsageError where a glob matches no material of the scene, or where there
/// are more than limits::max_portals.
std::vector<Portal> portals_of_materials(const Scene& scene, std::span<const std::string> globs);

/// The portals that SceneLoadOptions::portals requests. Errors: those above; UsageError where
/// "auto" or "off" is combined with others.
std::vector<Portal> portals_asked_for(const Scene& scene, std::span<const std::string> asked,
                                      std::span<const glm::dvec3> points = {});

}  // namespace photile::trace
