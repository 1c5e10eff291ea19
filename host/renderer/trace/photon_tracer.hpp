// A photon's path from its light to its end, and the photons of many paths sorted by oriented
// face.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "photile/photons.hpp"
#include "trace/light_emitter.hpp"
#include "trace/ray_scene.hpp"

namespace photile::trace {

/// Photons of one light in the order path, bounce. Arrays as in Photons.
struct PhotonRun {
  std::vector<glm::vec3> position;
  std::vector<glm::vec3> flux;
  std::vector<glm::vec3> incoming;  ///< empty unless `keep_incoming`
  std::vector<std::uint32_t> oriented_face;

  std::size_t size() const { return position.size(); }
};

/// The result of a run of paths of one light.
struct PathRecord {
  PhotonRun photons;
  double escaped = 0;   ///< luminance that left the scene
  double absorbed = 0;  ///< luminance absorbed by surfaces, or ended by the bound on path length
};

/// What all paths of one light have in common.
struct PathSetup {
  const RayScene::Impl* rays;
  const PhotonTracerParameters* parameters;
  const LightEmitter* emitter;
  std::uint32_t light;
  std::uint64_t paths;  ///< that share the light's flux 1
  bool keep_incoming;
  /// The targets of paths of caustics alone; null: all light.
  const Targets* caustics;
  RandomBlock scramble;  ///< of the points by which paths are aimed
  bool stores_hot_spots = true;
};

/// Traces path number `path` and appends the photons that it stores to `record`: photons of all
/// light, or those that came by mirrors and glass alone. Emitted luminance equals absorbed plus
/// escaped, path by path: flux that roulette adds to a survivor counts as negative absorption.
void trace_photon_path(const PathSetup& setup, std::uint64_t path, PathRecord& record);

/// trace_photons, without photons that come directly from a light to its hot spot (hot_spots.hpp):
/// no density of photons can resolve that light, which shadow rays find.
PhotonTracerResult trace_photons_beside_hot_spots(const RayScene& scene,
                                                  const PhotonTracerParameters& parameters,
                                                  Progress& progress = Progress::none());

/// Photons of lights of one layer.
struct LayerRun {
  PhotonRun* photons;
  std::uint16_t layer;
};

/// Photons in the order of their oriented faces, those of one triangle in the order of the runs.
/// The runs are emptied on the way, one array after the other: besides them only the result exists.
///   tell_layers   fill Photons::light
Photons sorted_photons(std::span<const LayerRun> runs, bool tell_layers,
                       std::size_t oriented_face_count);

}  // namespace photile::trace
