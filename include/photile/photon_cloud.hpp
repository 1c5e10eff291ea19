// Points and photons of any origin, without a scene: the k nearest around points, and densities.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "photile/device.hpp"
#include "photile/estimator.hpp"
#include "photile/photon_maps.hpp"
#include "photile/progress.hpp"

namespace photile {

/// Photons in arrays that the caller owns. All arrays but the first are either empty or as long as
/// the first.
struct CloudPhotons {
  std::span<const glm::vec3> position;        ///< metres, up to limits::max_coordinate
  std::span<const glm::vec3> normal = {};     ///< unit, of the surface below; empty: none counts
  std::span<const glm::vec3> flux = {};       ///< linear RGB; empty: 1 each
  std::span<const std::uint16_t> light = {};  ///< numbers from 0; empty: all of one light
};

struct CloudParameters {
  double radius = 0;  ///< metres, > 0: no neighbour is farther
  /// Largest angle between the normals of a point and of its neighbours, in [0, 180].
  double angle_degrees = defaults::group_angle_degrees;
  float photons_per_cell = defaults::photons_per_cell;  ///< aimed at
};

/// The neighbours of points: row-major [point][k], nearest first, those at equal distances in the
/// order of their indices.
struct CloudNeighbours {
  int k = 0;
  std::vector<std::uint32_t> photons;   ///< indices; `none` beyond the last
  std::vector<float> squared_distance;  ///< square metres; infinity beyond the last
};

/// The arguments of `find_neighbours`. The arrays belong to the caller.
struct NeighbourSearch {
  std::span<const glm::vec3> points;   ///< metres, up to limits::max_coordinate; at least one
  std::span<const glm::vec3> queries;  ///< as the points
  int k = defaults::neighbours;  ///< 1 to limits::max_neighbours; may exceed the number of points
  /// Metres, > 0: no neighbour is farther. Infinity: all points count.
  double max_distance = std::numeric_limits<double>::infinity();
  /// Unit, as many as points and as queries: only points count whose normals differ from that of
  /// the query by at most the angle. Both empty: all count.
  std::span<const glm::vec3> normals = {}, query_normals = {};
  double angle_degrees = defaults::group_angle_degrees;
};

/// The k nearest points of each query. Exact: distances are those in double precision, rounded to
/// floats; of points whose distances agree to a few roundings of a float, any may be the last.
/// Maps are made with a radius that suits some of the queries; queries that find too few are
/// repeated with larger radii, until all points lie within them. A query that is much farther from
/// its nearest points than these are from each other takes as long as a search of all points.
/// Errors: InputError that names the first point or query that is NaN, infinite or too far, or
/// where there is no point; UsageError for k, distance or angle out of range; DeviceMemoryError;
/// Interrupted.
CloudNeighbours find_neighbours(Device& device, const NeighbourSearch& search,
                                Progress& progress = Progress::none());

struct CloudEstimateParameters {
  int neighbours = defaults::neighbours;           ///< k
  double radius = 0;                               ///< metres; 0 = the cloud's
  DensityKernel kernel = DensityKernel::constant;  ///< the weight of each photon
};

/// Photon maps over a cloud of photons on a device. Space is divided into cubes a few radii wide;
/// each cube near a photon has maps in the plane along which most of its photons lie (for photons
/// on a wall: that of the wall). Projection onto a plane lengthens no distance, so that a search
/// there finds every neighbour in space; photons spread through a volume are found as well, though
/// with more candidates to test. The device must outlive the cloud; one thread at a time may use
/// it.
class PhotonCloud {
 public:
  /// Copies what it needs. Errors: InputError that names the first photon that is NaN, infinite,
  /// too far or without a unit normal, or arrays of different lengths; UsageError for parameters
  /// out of range; DeviceMemoryError; Interrupted.
  PhotonCloud(Device& device, const CloudPhotons& photons, const CloudParameters& parameters,
              Progress& progress = Progress::none());
  ~PhotonCloud();
  PhotonCloud(PhotonCloud&&) noexcept;
  PhotonCloud& operator=(PhotonCloud&&) noexcept;

  std::size_t size() const;  ///< photons
  const PhotonMapStatistics& statistics() const;

  /// The k nearest photons of each point within `radius` (0 = the cloud's), whose normals agree
  /// where photons have any. Of photons at the same distance, to a few roundings of a float, any
  /// may be the last.
  ///   normals   unit, as many as points, if the photons have normals; else empty
  /// Errors: InputError for a point that is not finite or arrays of different lengths; UsageError
  /// for k or a radius out of range.
  CloudNeighbours nearest(std::span<const glm::vec3> points, std::span<const glm::vec3> normals,
                          int k, double radius = 0);

  /// Flux per area at each point: the flux of its neighbours over the area of the disc that they
  /// fill (Estimator, AreaMode::disc), per light. Errors: those of `nearest`.
  LightTable irradiance(std::span<const glm::vec3> points, std::span<const glm::vec3> normals,
                        const CloudEstimateParameters& parameters = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace photile
