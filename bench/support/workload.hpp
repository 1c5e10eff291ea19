// What the benches search: scenes with photons and the points where density is requested.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"

namespace photile::bench {

struct Workload {
  std::string name;
  std::shared_ptr<const Scene> scene;
  PrimaryHits hits;
  /// Stored photons, as many as asked for: exactly on the plane, about so many where they are
  /// traced.
  std::function<Photons(std::uint64_t)> photons;
};

/// A square metre of two triangles with one light. Photons are uniform, each of its own flux;
/// `queries` uniform hits in the order of PrimaryHits.
Workload plane_workload(std::size_t queries);

/// Traced photons and the primary hits of the scene's first camera, one sample a pixel.
Workload interior_workload(const std::string& name, Scene scene, int width, int height);

enum class Surfaces {
  diffuse,        ///< every opaque surface: the rivals do not evaluate lobes
  as_in_the_file  ///< some are glossy
};
Scene living_room(Surfaces surfaces = Surfaces::diffuse);  ///< scenes/living-room

/// Takes the specular lobe from every opaque surface.
void make_diffuse(Scene& scene);

/// The maps that the renderer builds unless told otherwise, and those of the paper.
struct NamedMapMode {
  const char* name;  ///< of the setting maps
  MapMode mode;
};
inline constexpr NamedMapMode product_maps{"auto", MapMode::automatic};
inline constexpr NamedMapMode paper_maps{"triangle", MapMode::triangle};

/// The groups of the product's maps.
NeighbourGroups default_groups(const Scene& scene, const Photons& photons, double radius);

/// Hits in the order in which the renderer traces them for maps of these groups.
PrimaryHits in_map_order(const PrimaryHits& hits, const NeighbourGroups& groups);

/// About `count` stored photons: from as many paths as a probe says leave so many.
Photons traced_photons(const RayScene& rays, std::uint64_t count);

/// An interior of the shared scenes (PHOTILE_SHARED_SCENES, else ../shared/scenes beside the
/// repository), "classroom" or "kitchen", diffuse; nothing where that folder is missing.
std::optional<Scene> shared_interior(const std::string& name);
std::optional<Scene> classroom();

/// Diffuse, half of the light reflected.
Material white_material();

/// A point light of 1000 lm.
Light lamp_at(const glm::vec3& position);

/// A hall of 4 m x 4 m x 3 m with gently waved walls, 10 `cells`^2 triangles, white, lit by a point
/// light in its middle, seen from a corner. `cells`: a multiple of 4.
Scene waved_hall(std::uint32_t cells);

}  // namespace photile::bench
