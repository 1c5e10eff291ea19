// Stored photons: a structure of arrays, ready for the device.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "photile/communicator.hpp"

namespace photile {

/// What stages ask of all photons together, where several processes hold them.
struct PhotonsOfAll {
  Communicator* processes = nullptr;  ///< that hold them
  std::uint64_t count = 0;
  std::vector<std::uint32_t> landed;  ///< per sided triangle: photons there
  /// Positions of as many as groups::max_subsample, spread evenly, or of all where they are fewer.
  std::vector<glm::vec3> spread;
  /// Every n-th, by which groups::PhotonSample judges patches, and their sided triangles.
  std::vector<glm::vec3> sample;
  std::vector<std::uint32_t> sample_triangle;
  /// Per sided triangle: 1 where its photons are all here, and no other process answers for them.
  /// Empty before photons are where their maps are.
  std::vector<std::uint8_t> own;
};

/// Photons in the order of their sided triangles (stable: within one in the order light, path,
/// bounce). Which arrays are filled depends on SceneNeeds.
struct Photons {
  std::vector<glm::vec3> position;  ///< metres, on the triangle
  /// Flux of the photon where the lights of its layer together emit 1 lm or 1 W, linear RGB. Summed
  /// over the photons that a layer's lights emitted, before the first hit, the luminance is 1.
  std::vector<glm::vec3> flux;
  std::vector<glm::vec3> incoming;   ///< unit, towards where it came from; empty unless glossy
  std::vector<std::uint16_t> light;  ///< layer, into LightGroups::groups; empty for one alone
  std::vector<std::uint32_t> sided_triangle;

  /// Photons of sided triangle s are [first_of[s], first_of[s + 1]). Size 2 * triangles + 1.
  std::vector<std::uint32_t> first_of;
  std::vector<std::uint64_t> emitted_per_light;  ///< paths started

  /// Of all photons, where these are the part that one process holds; null: these are all.
  std::shared_ptr<const PhotonsOfAll> of_all;

  std::size_t size() const { return position.size(); }
  /// Of all processes.
  std::uint64_t total() const { return of_all ? of_all->count : size(); }
  std::uint64_t bytes() const;
};

/// Photons in any order (`first_of` ignored) brought into the order of their sided triangles by a
/// stable counting sort; fills `first_of`.
Photons sort_by_sided_triangle(Photons photons, std::size_t sided_triangle_count);

/// The photons of several runs of paths as if one process had traced them: those of each sided
/// triangle in the order of the runs. All arrays that one run has, all have.
///   runs   in the order light, path; consumed, so that only one array exists twice
Photons merge_runs(std::vector<Photons> runs);

}  // namespace photile
