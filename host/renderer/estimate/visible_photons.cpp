#include "estimate/visible_photons.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <optional>

#include "common/touched_memory.hpp"
#include "light/light_at_points.hpp"
#include "photile/communicator.hpp"
#include "photile/defaults.hpp"
#include "photile/limits.hpp"
#include "scene/scene_queries.hpp"
#include "trace/ray_query.hpp"
#include "trace/sampling.hpp"

namespace photile::estimate {
namespace {

/// Short lines around a hit, which find what stands beside it. A wall is missed where less than 1%
/// of the disc lies behind it.
constexpr int directions = 8;
/// Part of the height of lines of sight: roundings and what lies flat on a surface cover nothing.
constexpr float just_above = 0x1p-4f;
/// Photons of a light that are looked at first. Where more than one of them is seen, much of its
/// light is left.
constexpr int most_probes = 5, most_probes_seen = 1;
/// Photons of a face that are looked at for whether it lies in a cavity.
constexpr std::size_t most_cavity_probes = 16;
/// Places of the disc, each of the same area: the share that is seen is known to a tenth of the
/// disc.
constexpr int positions = 24;
/// The part of an estimate that must be left for it to stand.
constexpr float most_kept = 0.25f;
/// The same where photons lie behind the surface.
constexpr float most_kept_before = 0.9f;
/// Photons farther from the hit's plane do not count (docs/method/density.md).
constexpr float flat = 0.2f;
/// Of the angle between the normals of surfaces that share light.
constexpr float least_cosine = 0.5f;

}  // namespace

struct VisiblePhotons::Disc {
  trace::SurfaceLocation here;
  float squared_radius;                    ///< m2
  std::span<const std::uint32_t> photons;  ///< the neighbours
  float height;                            ///< of lines of sight above the surface, metres
};

/// The photons of a light in a disc, as far as they were tested.
struct VisiblePhotons::Layer {
  int photons = 0, passed = 0;  ///< how many there are, and are behind in the list
  int probes = 0, probes_seen = 0;
  bool behind = false;       ///< some lie behind the surface
  double all = 0, seen = 0;  ///< flux, weighted by the kernel

  bool doubtful() const { return probes > 0 && (behind || probes_seen <= most_probes_seen); }
  /// Where the visible part of the light is at most this fraction, it replaces the light.
  double kept() const { return behind ? most_kept_before : most_kept; }
};

VisiblePhotons::VisiblePhotons(const RayScene& rays, const Photons& photons, DensityKernel kernel,
                               double radius)
    : rays_(rays),
      rounding_(static_cast<float>(trace::ray_offset_per_coordinate) *
                scene::largest_coordinate(rays.scene())),
      kernel_(kernel),
      position_(photons.position),
      oriented_face_(photons.oriented_face),
      light_(photons.light) {
  flux_.resize(photons.size());
  tbb::parallel_for(std::size_t{0}, flux_.size(), [&](std::size_t i) {
    flux_[i] = static_cast<float>(luminance(glm::dvec3(photons.flux[i])));
  });
  find_cavities(radius, photons.of_all.get());
}

std::vector<std::uint32_t> VisiblePhotons::beside_something(const PrimaryHits& hits,
                                                            const LightTable& estimates,
                                                            double radius) const {
  const Scene& scene = rays_.scene();
  const auto reach = static_cast<float>(radius);
  std::vector<std::uint8_t> chosen(hits.size(), 0);
  tbb::parallel_for(std::size_t{0}, chosen.size(), [&](std::size_t hit) {
    bool lit = false;
    estimates.for_each(hit, [&](std::size_t, std::size_t i) {
      lit = lit || estimates.irradiance[i] != glm::vec3(0.0f);
    });
    if (!lit) return;
    const trace::FlushDenormals flush_denormals;
    const trace::SurfaceLocation here =
        trace::location_on(scene, hits.oriented_face[hit], hits.position[hit]);
    const trace::Frame frame(here.normal);
    const glm::vec3 origin =
        here.position + 0.5f * defaults::photon_ray_offset * reach * here.normal;
    for (int i = 0; i < directions && !chosen[hit]; ++i) {
      const float angle = glm::two_pi<float>() * static_cast<float>(i) / directions;
      const glm::vec3 way = frame.to_world({std::cos(angle), std::sin(angle), 0.0f});
      chosen[hit] = trace::occluded(rays_, origin, origin + reach * way);
    }
    if (chosen[hit]) return;
    // A cavity behind the surface.
    const float below = just_above * defaults::photon_ray_offset * reach;
    chosen[hit] = trace::occluded(rays_, here.position - below * here.normal,
                                  here.position - flat * reach * here.normal);
    if (!chosen[hit]) chosen[hit] = is_before_cavity(here, reach);
  });
  return numbers_where(chosen.size(), [&](std::uint32_t hit) { return chosen[hit] != 0; });
}

/// Processes judge the faces all of whose photons they have, and tell each other: what a face hides
/// must not depend on which of its photons are here.
void VisiblePhotons::find_cavities(double radius, const PhotonsOfAll* of_all) {
  const auto depth = static_cast<float>(flat * radius);
  std::vector<std::size_t> first;  // photons of a face
  for (std::size_t i = 0; i < oriented_face_.size(); ++i) {
    if (i == 0 || oriented_face_[i] != oriented_face_[i - 1]) first.push_back(i);
  }
  first.push_back(oriented_face_.size());
  std::vector<std::uint8_t> covers(first.size() - 1, 0);
  tbb::parallel_for(std::size_t{0}, covers.size(), [&](std::size_t face) {
    if (of_all && of_all->own[oriented_face_[first[face]]] == 0) return;
    const trace::FlushDenormals flush_denormals;
    const std::size_t count = first[face + 1] - first[face];
    const std::size_t step = (count + most_cavity_probes - 1) / most_cavity_probes;
    for (std::size_t i = first[face]; i < first[face + 1] && !covers[face]; i += step) {
      covers[face] = covered(location_of(static_cast<std::uint32_t>(i)), rounding_, depth);
    }
  });
  for (std::size_t face = 0; face < covers.size(); ++face) {
    if (covers[face] != 0) cavity_faces_.push_back(oriented_face_[first[face]]);
  }
  if (of_all) {
    cavity_faces_ = of_all->processes->gather_values<std::uint32_t>(cavity_faces_);
    // Leaves of the tree, which are visited whole, depend on the order.
    std::sort(cavity_faces_.begin(), cavity_faces_.end());
  }
  std::vector<geometry::Box> boxes;
  for (const std::uint32_t face : cavity_faces_) {
    boxes.push_back(geometry::triangle_box(rays_.scene(), triangle_of(face)));
  }
  cavities_ = geometry::BoxTree(boxes);
}

bool VisiblePhotons::is_before_cavity(const trace::SurfaceLocation& here, float radius) const {
  const Scene& scene = rays_.scene();
  geometry::Box box;
  box.extend(here.position);
  bool found = false;
  cavities_.visit_within(box, geometry::squared_reach(radius), [&](std::uint32_t i) {
    const glm::vec3 normal(face_normal(scene, cavity_faces_[i]));
    if (glm::dot(normal, here.normal) < least_cosine) return false;
    for (const glm::vec3& corner : scene.corners(triangle_of(cavity_faces_[i]))) {
      found = found || glm::dot(here.position - corner, here.normal) > rounding_;
    }
    return found;
  });
  return found;
}

double VisiblePhotons::weight(double relative_squared) const {
  return kernel_weight(kernel_, relative_squared);
}

trace::SurfaceLocation VisiblePhotons::location_of(std::uint32_t photon) const {
  return trace::location_on(rays_.scene(), oriented_face_[photon], position_[photon]);
}

bool VisiblePhotons::sees(const trace::SurfaceLocation& here, const trace::SurfaceLocation& there,
                          float height) const {
  const float off_plane = std::abs(glm::dot(there.position - here.position, here.normal));
  // In a cavity of the wall, say.
  if (off_plane > just_above * height && covered(there, just_above * height, height + off_plane)) {
    return false;
  }
  if (is_behind(here, there)) return false;
  // Nodes may lie close to the foot of a wall: the line ends short of them.
  return trace::see_each_other(rays_, there, here, {height, defaults::visibility_left_out});
}

bool VisiblePhotons::covered(const trace::SurfaceLocation& point, float from, float to) const {
  return trace::occluded(rays_, point.position + from * point.normal,
                         point.position + to * point.normal);
}

bool VisiblePhotons::is_behind(const trace::SurfaceLocation& here,
                               const trace::SurfaceLocation& photon) const {
  const float below = glm::dot(here.position - photon.position, here.normal);
  return below > rounding_ && covered(photon, rounding_, below + 2 * rounding_);
}

std::optional<trace::SurfaceLocation> VisiblePhotons::surface_at(
    const trace::SurfaceLocation& point, float within) const {
  const glm::vec3 above = point.position + within * point.normal;
  const auto met = trace::intersect(rays_, above, -point.normal);
  if (!met) return std::nullopt;
  const trace::SurfacePoint surface = trace::surface_hit(rays_.scene(), *met, -point.normal);
  if (glm::dot(surface.normal, point.normal) < least_cosine ||
      glm::dot(above - surface.position, point.normal) > 2 * within) {
    return std::nullopt;
  }
  return trace::SurfaceLocation{surface.position, surface.normal};
}

double VisiblePhotons::visible_area(const Disc& disc) const {
  const trace::SurfaceLocation& here = disc.here;
  const float radius = std::sqrt(disc.squared_radius);
  const trace::Frame frame(here.normal);
  double seen = 0;
  for (int i = 0; i < positions; ++i) {
    // Vogel's spiral: the golden angle from one position to the next.
    const float squared = (static_cast<float>(i) + 0.5f) / positions;
    const float angle = 2.39996323f * static_cast<float>(i);
    const glm::vec3 beside =
        std::sqrt(squared) * radius * frame.to_world({std::cos(angle), std::sin(angle), 0.0f});
    const auto there = surface_at({here.position + beside, here.normal}, flat * radius);
    if (!there) continue;
    if (sees(here, *there, disc.height)) seen += weight(squared);
  }
  return seen / positions * glm::pi<double>() * static_cast<double>(radius) * radius;
}

bool VisiblePhotons::probe(const Disc& disc, std::vector<Layer>& layers) const {
  for (const std::uint32_t photon : disc.photons) ++layers[layer_of(photon)].photons;
  for (const std::uint32_t photon : disc.photons) {
    Layer& layer = layers[layer_of(photon)];
    const int before = layer.passed++;
    // Evenly over the list.
    const bool is_next = before >= layer.probes * layer.photons / most_probes;
    if (!is_next || layer.probes_seen > most_probes_seen) continue;
    ++layer.probes;
    if (sees(disc.here, location_of(photon), disc.height)) ++layer.probes_seen;
  }
  for (const std::uint32_t photon : disc.photons) {
    Layer& layer = layers[layer_of(photon)];
    layer.behind = layer.behind || is_behind(disc.here, location_of(photon));
  }
  return std::any_of(disc.photons.begin(), disc.photons.end(),
                     [&](std::uint32_t photon) { return layers[layer_of(photon)].doubtful(); });
}

void VisiblePhotons::sum_seen(const Disc& disc, bool full, std::vector<Layer>& layers) const {
  for (const std::uint32_t photon : disc.photons) {
    Layer& layer = layers[layer_of(photon)];
    if (!layer.doubtful()) continue;
    const glm::vec3 way = position_[photon] - disc.here.position;
    const float squared = glm::dot(way, way) / disc.squared_radius;
    // The k-th tells the radius, and is not counted.
    if (full && squared >= 1) continue;
    const float height = glm::dot(way, disc.here.normal);
    if (height * height > flat * flat * disc.squared_radius) continue;
    const double counted = weight(static_cast<double>(squared)) * flux_[photon];
    layer.all += counted;
    if (sees(disc.here, location_of(photon), disc.height)) layer.seen += counted;
  }
}

void VisiblePhotons::leave_out_hidden(const PrimaryHits& hits,
                                      std::span<const std::uint32_t> chosen,
                                      const NeighbourLists& near, LightTable& estimates) const {
  const std::size_t lights = rays_.needs().light_count;
  const auto k = static_cast<std::size_t>(near.k);
  tbb::parallel_for(std::size_t{0}, chosen.size(), [&](std::size_t row) {
    const trace::FlushDenormals flush_denormals;
    const std::uint32_t hit = chosen[row];
    const std::span<const std::uint32_t> list = std::span(near.photons).subspan(row * k, k);
    Disc disc{
        .here = trace::location_on(rays_.scene(), hits.oriented_face[hit], hits.position[hit]),
        .squared_radius = near.squared_radius[row],
        .photons = list.first(
            static_cast<std::size_t>(std::find(list.begin(), list.end(), none) - list.begin())),
        .height = defaults::photon_ray_offset * std::sqrt(near.squared_radius[row])};
    if (!(disc.squared_radius > 0)) return;
    // High enough for cracks along walls not to count, unless the hit lies in a slit.
    if (covered(disc.here, just_above * disc.height, disc.height)) disc.height *= 0.25f;
    thread_local std::vector<Layer> layers;
    layers.resize(lights);
    for (const std::uint32_t photon : disc.photons) layers[layer_of(photon)] = {};
    if (!probe(disc, layers)) return;
    sum_seen(disc, list.size() == disc.photons.size(), layers);
    std::optional<double> area;  // for all layers
    estimates.for_each(hit, [&](std::size_t index, std::size_t i) {
      const Layer& layer = layers[index];
      const bool lit = estimates.irradiance[i] != glm::vec3(0.0f);
      if (!lit || !layer.doubtful() || !(layer.seen < layer.kept() * layer.all)) return;
      if (!area) area = visible_area(disc);
      const double all = luminance(glm::dvec3(estimates.irradiance[i]));
      const double seen = layer.seen / *area;
      if (!(*area > 0) || !(seen < (layer.behind ? 1.0 : most_kept) * all)) return;
      const auto scale = static_cast<float>(seen / all);
      estimates.irradiance[i] *= scale;
      if (!estimates.radiance.empty()) estimates.radiance[i] *= scale;
    });
  });
}

}  // namespace photile::estimate
