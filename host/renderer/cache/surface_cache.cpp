#include "cache/surface_cache.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cache/charts.hpp"
#include "cache/gathered_nodes.hpp"
#include "cache/node_mix.hpp"
#include "common/touched_memory.hpp"
#include "estimate/map_order.hpp"
#include "light/light_at_points.hpp"
#include "light/row_sum.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/statistics.hpp"
#include "trace/ray_query.hpp"
#include "trace/surface.hpp"

namespace photile::cache {

namespace {

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t rows_per_task = 1024;

constexpr int coarsest_level = 1;

const Material& material_of(const Scene& scene, std::uint32_t oriented_face) {
  return scene.materials[scene.triangle_material[triangle_of(oriented_face)]];
}

/// What the nodes around a point say of a light.
struct ByNormal {
  glm::vec3 irradiance{0.0f};
  glm::vec4 by_normal{0.0f};
};

/// Adds up the rows of points, one after another.
class PointSums {
 public:
  PointSums(const Scene& scene, const SceneNeeds& needs, LightTable& rows)
      : scene_(scene),
        rows_(rows),
        has_radiance_(needs.tells_radiance()),
        sums_(needs.light_count),
        layers_(needs.smooth_shading ? needs.light_count : 0) {}

  /// Light, or errors, that were found at the point itself.
  void add_found(const PrimaryHits& points, std::size_t point, const LightTable& found,
                 std::size_t row) {
    found.for_each(row, [&](std::size_t layer, std::size_t entry) {
      sums_.of(layer).add(found.irradiance[entry],
                          light::reflected_radiance(points, point, found, entry));
    });
  }

  /// Light, or errors, of the nodes around the point. Irradiance is that of the surface. Where
  /// nodes tell light by the normal, what is reflected goes by the shading normal, or by that of a
  /// normal map, in the colour of the irradiance.
  void add_between(const PrimaryHits& points, std::size_t point, const BilinearWeights& nodes,
                   const LightTable& of) {
    const glm::vec3 reflects = points.diffuse_albedo[point] * glm::one_over_pi<float>();
    const auto for_each = [&](const auto& visit) {
      for (std::size_t i = 0; i < nodes.node.size(); ++i) {
        const float weight = nodes.weight[i];
        if (weight == 0.0f) continue;
        of.for_each(nodes.node[i],
                    [&](std::size_t layer, std::size_t entry) { visit(layer, entry, weight); });
      }
    };
    if (of.by_normal.empty()) {
      for_each([&](std::size_t layer, std::size_t entry, float weight) {
        const glm::vec3 light = weight * of.irradiance[entry];
        sums_.of(layer).add(light, reflects * light);
      });
      return;
    }
    for_each([&](std::size_t layer, std::size_t entry, float weight) {
      ByNormal& light = layers_.of(layer);
      light.irradiance += weight * of.irradiance[entry];
      light.by_normal += weight * of.by_normal[entry];
    });
    const glm::vec3 normal =
        material_of(scene_, points.oriented_face[point]).normal_texture != none
            ? points.lobe[point].normal
            : trace::shading_normal(scene_, points.oriented_face[point], points.position[point]);
    layers_.take_lit([&](std::size_t layer, const ByNormal& light) {
      if (light.irradiance == glm::vec3(0.0f)) return;
      sums_.of(layer).add(light.irradiance,
                          reflects * turned(light.irradiance, light.by_normal, normal));
    });
  }

  void end_point() { light::end_row(sums_, rows_, has_radiance_); }

 private:
  const Scene& scene_;
  LightTable& rows_;
  bool has_radiance_;
  light::RowSum<light::Reflection> sums_;
  light::RowSum<ByNormal> layers_;
};

}  // namespace

double ErrorSum::mean() const { return weight > 0 ? std::sqrt(squares / weight) : 0.0; }

SurfaceCache::SurfaceCache(const RayScene& rays, const LightMapParameters& parameters,
                           light::LightAtPoints& elsewhere, NodeSource& source, LightMaps* ends)
    : scene_(rays.scene()),
      needs_(rays.needs()),
      neighbours_(parameters.neighbours),
      elsewhere_(elsewhere),
      maps_(rays, parameters, source),
      ends_(ends) {}

/// What answers for each of the points.
struct SurfaceCache::Reading {
  const PrimaryHits& points;
  std::vector<std::uint32_t> alone;   ///< points that have estimates of their own
  std::vector<std::uint32_t> fine;    ///< that lie between nodes
  std::vector<std::uint32_t> coarse;  ///< that nodes where rays end answer, or the coarsest ones
  std::vector<BilinearWeights> fine_nodes, coarse_nodes;  ///< around each of them

  /// Per point: its slot among those that are alone, the fine and the coarse ones, in this order.
  std::vector<std::uint32_t> slots() const {
    std::vector<std::uint32_t> slot(points.size());
    std::uint32_t next = 0;
    for (const auto* part : {&alone, &fine, &coarse}) {
      for (const std::uint32_t point : *part) slot[point] = next++;
    }
    return slot;
  }
};

LightTable SurfaceCache::at(const PrimaryHits& points, const Progress& progress) {
  return light_of(read(points, progress), progress);
}

LightAndErrors SurfaceCache::with_errors(const PrimaryHits& points, const GatheredNodes& nodes,
                                         const Progress& progress) {
  const Reading reading = read(points, progress);
  LightTable light = light_of(reading, progress);
  const auto relative = static_cast<float>(photon_noise().noise);
  const auto by_photons = [&](std::span<const std::uint32_t> part) {
    LightTable errors = light.gathered(part);
    for (glm::vec3& value : errors.irradiance) value *= relative;
    for (glm::vec3& value : errors.radiance) value *= relative;
    return errors;
  };
  LightTable errors = rows(reading, by_photons(reading.alone), nodes.errors(maps_.values()),
                           by_photons(reading.coarse), Coarse::found);
  return {std::move(light), std::move(errors)};
}

LightTable SurfaceCache::light_of(const Reading& reading, const Progress& progress) {
  hits_alone_ += reading.alone.size();
  const LightTable found =
      reading.alone.empty() && !maps_.processes()
          ? LightTable{}
          : elsewhere_.at(estimate::reordered(reading.points, reading.alone), progress);
  const LightTable& of_coarse = ends_ ? ends_->values() : maps_.values();
  return rows(reading, found, maps_.values(), of_coarse, Coarse::between_nodes);
}

/// Rows of all points, in their order. Work is shared by TBB.
///   of_alone    rows of the points that are alone
///   of_nodes    rows of the nodes
///   of_coarse   of the nodes of the coarse points, or of these points themselves
LightTable SurfaceCache::rows(const Reading& reading, const LightTable& of_alone,
                              const LightTable& of_nodes, const LightTable& of_coarse,
                              Coarse coarse_rows) const {
  const std::vector<std::uint32_t> slots = reading.slots();
  const auto write = [&](std::size_t first, std::size_t last, LightTable& table) {
    const auto& [points, alone, fine, coarse, fine_nodes, coarse_nodes] = reading;
    PointSums sums(scene_, needs_, table);
    for (std::size_t point = first; point < last; ++point) {
      std::size_t i = slots[point];
      if (i < alone.size()) {
        sums.add_found(points, point, of_alone, i);
      } else if ((i -= alone.size()) < fine.size()) {
        sums.add_between(points, point, fine_nodes[i], of_nodes);
      } else if (i -= fine.size(); coarse_rows == Coarse::found) {
        sums.add_found(points, point, of_coarse, i);
      } else {
        sums.add_between(points, point, coarse_nodes[i], of_coarse);
      }
      sums.end_point();
    }
  };
  return light::rows_by_tasks(slots.size(), rows_per_task, LightTable(needs_), write);
}

/// Values what the points read, and finds it.
SurfaceCache::Reading SurfaceCache::read(const PrimaryHits& points, const Progress& progress) {
  Reading reading{points, {}, {}, {}, {}, {}};
  auto& [_, alone, fine, coarse, fine_nodes, coarse_nodes] = reading;
  const auto that_are = [&](bool served, bool is_coarse) {
    return numbers_where(points.size(), [&](std::uint32_t point) {
      const bool coarse_one = !points.coarse.empty() && points.coarse[point] != 0;
      return serves(points, point) == served && (!served || coarse_one == is_coarse);
    });
  };
  alone = that_are(false, false);
  fine = that_are(true, false);
  coarse = that_are(true, true);
  const auto around = [&](std::span<const std::uint32_t> part, LightMaps& maps, int levels) {
    if (part.size() == points.size()) return maps.around(points, progress, levels);
    if (part.empty() && !maps.processes()) return LightMaps::Around{};
    return maps.around(estimate::reordered(points, part), progress, levels);
  };
  const Stopwatch stopwatch;
  LightMaps::Around of_fine = around(fine, maps_, LightMaps::all_levels);
  fine_nodes = std::move(of_fine.nodes);
  coarse_nodes = ends_ ? around(coarse, *ends_, LightMaps::all_levels).nodes
                       : around(coarse, maps_, coarsest_level).nodes;
  fill_time_ += stopwatch.taken();
  if (!ends_) count_errors(points, coarse, coarse_nodes);
  // Where photons fill nodes they would say no more at a point which no node sees, and may have
  // to be traced first.
  if (ends_) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < fine.size(); ++i) {
      if (of_fine.seen[i] == 0) {
        alone.push_back(fine[i]);
        continue;
      }
      fine[kept] = fine[i];
      fine_nodes[kept++] = fine_nodes[i];
    }
    fine.resize(kept);
    fine_nodes.resize(kept);
    std::sort(alone.begin(), alone.end());
  }
  count_errors(points, fine, fine_nodes);
  return reading;
}

void SurfaceCache::count_errors(const PrimaryHits& points, std::span<const std::uint32_t> part,
                                std::span<const BilinearWeights> nodes) {
  std::vector<double> errors(nodes.size());
  tbb::parallel_for(std::size_t{0}, nodes.size(),
                    [&](std::size_t i) { errors[i] = maps_.relative_error(nodes[i]); });
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double weight = points.fraction.empty() ? 1.0 : double{points.fraction[part[i]]};
    errors_read_.squares += weight * errors[i] * errors[i];
    errors_read_.weight += weight;
  }
}

PhotonNoise SurfaceCache::photon_noise() const {
  return {(ends_ ? *ends_ : maps_).charts().spacing(), 1 / std::sqrt(neighbours_)};
}

bool SurfaceCache::serves(const PrimaryHits& hits, std::size_t hit) const {
  const bool has_lobe = !hits.lobe.empty() && hits.lobe[hit].f90 > 0.0f;
  const bool mapped = material_of(scene_, hits.oriented_face[hit]).normal_texture != none;
  return !has_lobe && (!mapped || ends_ != nullptr);
}

}  // namespace photile::cache
