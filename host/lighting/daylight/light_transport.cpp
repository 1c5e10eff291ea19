#include "daylight/light_transport.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <memory>
#include <optional>

#include "daylight/surface_cells.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/ray_query.hpp"
#include "trace/scatter.hpp"

namespace photile::daylight {
namespace {

/// Directions of a lobe of which a ray takes one.
constexpr int lobe_candidates = 8;

/// A direction in proportion to what the lobe reflects from it: resampled among candidates (Talbot
/// 2005).
std::optional<glm::vec3> lobe_direction(const trace::OpaqueBsdf& lobe,
                                        const trace::RandomStream& random, int depth) {
  std::optional<glm::vec3> chosen;
  float sum = 0;
  for (int i = 0; i < lobe_candidates; ++i) {
    const trace::RandomBlock numbers = random.block(
        trace::Purpose::eye_scattering, static_cast<std::uint32_t>(depth * lobe_candidates + i));
    const auto candidate = lobe.sample(numbers);
    const float density = candidate ? lobe.density(*candidate) : 0.0f;
    if (!(density > 0.0f)) continue;
    const float reflects = trace::largest(lobe.reflected(*candidate)) / density;
    sum += reflects;
    if (numbers.uniform(trace::choice_word) * sum < reflects) chosen = candidate;
  }
  return chosen;
}

}  // namespace

SkyRays::SkyRays(const RayScene& rays, const weather::PatchFinder& patches,
                 const SkyRayParameters& parameters)
    : rays_(rays), patches_(patches), parameters_(parameters), portals_(rays.scene()) {}

void SkyRays::follow(trace::RayOrigin origin, glm::vec3 direction, glm::vec3 weight,
                     std::uint32_t batch, const trace::RandomStream& random,
                     VisibleByRays& seen) const {
  const Scene& scene = rays_.scene();
  double radiance_factor = 1;
  float distance = 0;
  bool straight = true;
  std::uint32_t cutouts = 0;
  for (int depth = 0; depth <= parameters_.max_specular_depth; ++depth) {
    const glm::vec3 from = origin.position;
    const auto met =
        trace::next_surface(rays_, origin, direction, random, trace::Purpose::eye_cutouts, cutouts);
    const auto factor = static_cast<float>(radiance_factor);
    if (!met) {
      seen.patches.push_back({patches_(direction), batch, straight, factor * weight});
      return;
    }
    const trace::SurfacePoint& point = *met;
    distance += glm::distance(from, point.position);
    const Material& material = trace::material_of(scene, point);
    if (material.interaction != Interaction::opaque) {
      const trace::RandomBlock numbers =
          random.block(trace::Purpose::eye_scattering, depth * lobe_candidates);
      const trace::Scattered scattered =
          trace::scatter_specular(scene, point, direction, numbers.uniform(trace::choice_word));
      straight = straight && scattered.direction == direction && material.thin;
      weight *= scattered.weight;
      radiance_factor *= scattered.radiance_factor;
      direction = scattered.direction;
    } else {
      const trace::OpaqueBsdf bsdf(scene, point, direction);
      const float share = bsdf.lobe_fraction();
      if (!(share > 0.0f) || !(random.block(trace::Purpose::eye_scattering, depth * lobe_candidates)
                                   .uniform(trace::choice_word) < share)) {
        const glm::vec3 reflects = factor * bsdf.base_reflectance() / (1.0f - share);
        weight *= reflects;
        if (weight != glm::vec3(0.0f)) {
          seen.surfaces.push_back({point, batch, distance, trace::largest(reflects),
                                   weight * glm::one_over_pi<float>()});
        }
        return;
      }
      trace::OpaqueBsdf lobe = bsdf;
      lobe.keep_lobe();
      const auto next = lobe_direction(lobe, random, depth);
      if (!next) return;
      weight *= bsdf.lobe_reflectance() / share;
      straight = false;
      direction = *next;
    }
    if (weight == glm::vec3(0.0f)) return;
    origin = point.origin_towards(direction);
  }
}

VisibleByRays SkyRays::from(std::span<const trace::Photometer> places, std::uint64_t number,
                            int rays) const {
  VisibleByRays seen;
  thread_local trace::PortalSizes portals;
  const float each = glm::pi<float>() / static_cast<float>(rays * parameters_.batches);
  for (int batch = 0; batch < parameters_.batches; ++batch) {
    const std::uint64_t seed =
        trace::seed_of_repeat(parameters_.seed, static_cast<std::uint32_t>(batch));
    const trace::RandomStream of_batch(seed, number << 16, 0);
    const trace::RandomBlock scrambles[2]{of_batch.block(trace::Purpose::sensor_direction, 0),
                                          of_batch.block(trace::Purpose::sensor_light, 0)};
    for (int ray = 0; ray < rays; ++ray) {
      const trace::RandomStream random(seed, number << 16 | static_cast<std::uint64_t>(ray), 0);
      const trace::RandomBlock own = random.block(trace::Purpose::sensor_direction, 1);
      const trace::Photometer& place =
          places[static_cast<std::size_t>(batch * rays + ray) % places.size()];
      portals_.measure(glm::dvec3(place.origin()), portals);
      // A single ray follows the cosine, so that its light is no more than the radiance there.
      const double looking = portals.sum > 0 ? (rays / 2) / static_cast<double>(rays) : 0;
      const bool looks = looking > 0 && ray % 2 == 1;
      const auto index = static_cast<std::uint32_t>(looking > 0 ? ray / 2 : ray);
      const glm::dvec2 spread = trace::sobol_point(index, scrambles[looks ? 1 : 0]);
      const glm::vec3 direction =
          looks ? glm::vec3(portals_.sample_direction(glm::dvec3(place.origin()), portals,
                                                      own.uniform_double(0), spread.x, spread.y))
                : place.sample(spread, own.uniform(0), own.uniform(1));
      const double density = place.density(direction);
      if (!(density > 0)) continue;
      double of_both = (1 - looking) * density;
      if (looking > 0) {
        of_both +=
            looking * portals_.density(glm::dvec3(place.origin()), glm::dvec3(direction), portals);
      }
      follow(place.origin(), direction, glm::vec3(each * static_cast<float>(density / of_both)),
             static_cast<std::uint32_t>(batch), random, seen);
    }
  }
  return seen;
}

namespace {

/// Rows whose rays are held at once.
constexpr std::size_t rows_at_once = 256;
/// The size of a cell over the median distance from a sensor to what its rays meet.
constexpr double cell_of_distance = 0.1;
constexpr int most_generations = 16;
/// The rays of the first generation from cells, about, however few sensors there are.
constexpr std::size_t least_rays = 65'536;
/// A cell has, for each batch, as many rays as end there, up to this part of a sensor's.
constexpr int rays_of_cell = 16;

/// What a row's rays saw, without the cells of surfaces.
TransportRow row_of(const VisibleByRays& seen, const TransportParameters& parameters) {
  TransportRow row;
  row.mean_sky.assign(static_cast<std::size_t>(parameters.sky.batches), glm::vec3(0.0f));
  for (const VisiblePatch& sky : seen.patches) {
    row.patches.push_back({sky.patch, sky.weight, sky.straight ? sky.weight : glm::vec3(0.0f)});
    row.mean_sky[sky.batch] +=
        sky.weight * static_cast<float>(parameters.mean_luminance[sky.patch]);
  }
  std::stable_sort(row.patches.begin(), row.patches.end(),
                   [](const auto& a, const auto& b) { return a.patch < b.patch; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < row.patches.size(); ++i) {
    if (kept > 0 && row.patches[kept - 1].patch == row.patches[i].patch) {
      row.patches[kept - 1].all += row.patches[i].all;
      row.patches[kept - 1].straight += row.patches[i].straight;
    } else {
      row.patches[kept++] = row.patches[i];
    }
  }
  row.patches.resize(kept);
  row.patches.shrink_to_fit();
  return row;
}

void join_cells(TransportRow& row) {
  std::stable_sort(row.cells.begin(), row.cells.end(), [](const auto& a, const auto& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.batch < b.batch;
  });
  std::size_t kept = 0;
  for (const TransportRow::OfCell& entry : row.cells) {
    TransportRow::OfCell* const last = kept > 0 ? &row.cells[kept - 1] : nullptr;
    if (last != nullptr && last->cell == entry.cell && last->batch == entry.batch) {
      last->weight += entry.weight;
    } else {
      row.cells[kept++] = entry;
    }
  }
  row.cells.resize(kept);
  row.cells.shrink_to_fit();
}

/// What a cell gets from cells is no more than surface reflects: few rays may by chance all go
/// where the weight of each is high.
void keep_energy(const VisibleByRays& seen, TransportRow& row) {
  float most = 0;
  for (const VisibleSurface& end : seen.surfaces) most = std::max(most, end.reflectance);
  glm::vec3 sum(0.0f);
  for (const TransportRow::OfCell& entry : row.cells) sum += entry.weight;
  const glm::vec3 kept = glm::min(glm::vec3(1.0f), most / glm::max(sum, glm::vec3(1e-30f)));
  for (TransportRow::OfCell& entry : row.cells) entry.weight *= kept;
}

bool is_coloured(const glm::vec3& weight) {
  const float most = std::max({weight.x, weight.y, weight.z});
  return most - std::min({weight.x, weight.y, weight.z}) > 1e-4f * most;
}

double median_distance(const std::vector<VisibleByRays>& seen) {
  std::vector<float> distances;
  for (const VisibleByRays& row : seen) {
    for (const VisibleSurface& end : row.surfaces) distances.push_back(end.distance);
  }
  if (distances.empty()) return 1;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return std::max(1e-3, double{*middle});
}

/// Traces generation after generation.
class Tracer {
 public:
  Tracer(const RayScene& rays, const weather::PatchFinder& patches,
         const TransportParameters& parameters, Progress& progress, LightTransport& transport)
      : rays_(rays),
        parameters_(parameters),
        progress_(progress),
        transport_(transport),
        sky_rays_(rays, patches, parameters.sky) {}

  void trace_sensors(std::span<const Sensor> sensors) {
    transport_.sensors.resize(sensors.size());
    const auto place = [&](std::size_t i) {
      return std::vector<trace::Photometer>{
          trace::Photometer(sensors[i], sensors[i].response.value_or(parameters_.response))};
    };
    const auto rays = [&](std::size_t) { return parameters_.rays; };
    trace_rows(transport_.sensors, 0, 0, place, rays);
  }

  void trace_cells() {
    if (!cells_) return;
    for (int generation = 0; generation < most_generations; ++generation) {
      const std::size_t first = transport_.cells.size();
      if (first == cells_->size()) return;
      transport_.cells.resize(cells_->size());
      const auto places = [&](std::size_t i) {
        std::vector<trace::Photometer> found;
        for (const trace::SurfacePoint& point : cells_->places(i)) found.emplace_back(point);
        return found;
      };
      const std::size_t batches = static_cast<std::size_t>(parameters_.sky.batches);
      const std::size_t from_sensors =
          transport_.sensors.size() * static_cast<std::size_t>(parameters_.rays) * batches;
      const std::size_t each = generation > 0 ? 1 : 1 + least_rays / from_sensors;
      const auto rays = [&, each](std::size_t i) {
        const auto most = static_cast<std::size_t>(std::max(2, parameters_.rays / rays_of_cell));
        const std::size_t requested = cells_->ends(i) * each / batches;
        return requested < 2 ? 1 : static_cast<int>(std::min(most, requested / 2 * 2));
      };
      trace_rows(transport_.cells, first, transport_.sensors.size(), places, rays);
    }
    transport_.cells.resize(cells_->size());  // those that nothing lights
    for (TransportRow& row : transport_.cells)
      row.mean_sky.resize(static_cast<std::size_t>(parameters_.sky.batches), glm::vec3(0.0f));
  }

 private:
  template <class Places, class Rays>
  void trace_rows(std::vector<TransportRow>& rows, std::size_t first, std::size_t first_number,
                  const Places& places, const Rays& rays) {
    std::vector<VisibleByRays> seen;
    for (std::size_t begin = first; begin < rows.size(); begin += rows_at_once) {
      progress_.throw_if_cancelled();
      const std::size_t count = std::min(rows_at_once, rows.size() - begin);
      seen.assign(count, {});
      tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        const trace::FlushDenormals flush_denormals;
        seen[i] = sky_rays_.from(places(begin + i), first_number + begin + i, rays(begin + i));
        rows[begin + i] = row_of(seen[i], parameters_);
      });
      if (!cells_) {
        const double distance = median_distance(seen);
        cells_ = std::make_unique<SurfaceCells>(rays_, cell_of_distance * distance, distance);
      }
      for (std::size_t i = 0; i < count; ++i) {
        for (const VisibleSurface& end : seen[i].surfaces) {
          rows[begin + i].cells.push_back(
              {cells_->cell_of(end.point, end.distance), end.batch, end.weight});
          transport_.coloured = transport_.coloured || is_coloured(end.weight);
        }
        for (const auto& patch : rows[begin + i].patches)
          transport_.coloured = transport_.coloured || is_coloured(patch.all);
      }
      tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        join_cells(rows[begin + i]);
        if (&rows == &transport_.cells) keep_energy(seen[i], rows[begin + i]);
      });
      if (first_number == 0) progress_.advance(count);
    }
  }

  const RayScene& rays_;
  const TransportParameters& parameters_;
  Progress& progress_;
  LightTransport& transport_;
  SkyRays sky_rays_;
  std::unique_ptr<SurfaceCells> cells_;
};

}  // namespace

LightTransport light_transport(const RayScene& rays, std::span<const Sensor> sensors,
                               const weather::PatchFinder& patches,
                               const TransportParameters& parameters, Progress& progress) {
  LightTransport transport;
  transport.patches = patches.patches() + 1;
  transport.batches = parameters.sky.batches;
  Tracer tracer(rays, patches, parameters, progress, transport);
  progress.begin("trace the sky", sensors.size(), "points");
  tracer.trace_sensors(sensors);
  tracer.trace_cells();
  progress.end();
  return transport;
}

}  // namespace photile::daylight
