#include "cache/light_map_frames.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <numeric>
#include <optional>
#include <tuple>

#include "cache/charts.hpp"
#include "cache/node_mix.hpp"
#include "photile/statistics.hpp"
#include "trace/coherent_rays.hpp"
#include "trace/eye_path.hpp"
#include "trace/ray_query.hpp"

namespace photile::cache {
namespace {

/// Pixels of a packet of rays and of a block, whose packets one task traces, on each side.
constexpr int packet_side = 4, block_side = 32;
static_assert(packet_side * packet_side == trace::coherent_rays);

/// Seconds of valuing a position, before they are known: by photons, and by rays at it and around
/// it.
constexpr double seconds_of_photons = 20e-6, seconds_of_rays = 2e-3;
/// Seconds of valuing positions until it is asked whether somebody waits for the frame.
constexpr double seconds_of_batch = 0.03;

/// Where ray `i` meets a pixel: the first in its middle, and any number of them evenly spread
/// (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018). The same in every
/// pixel and frame: nothing flickers.
glm::vec2 place_in_pixel(int i) {
  constexpr double plastic = 1.32471795724474602596;  // the root of x^3 = x + 1
  return glm::vec2(glm::fract(0.5 + glm::dvec2(i / plastic, i / (plastic * plastic))));
}

/// A mean of about a thousand nodes is grey enough.
glm::vec3 mean_of_some(std::span<const glm::vec4> light) {
  const std::size_t step = std::max<std::size_t>(1, light.size() / 1024);
  glm::vec4 sum(0.0f);
  float count = 0;
  for (std::size_t i = 0; i < light.size(); i += step, ++count) sum += light[i];
  return count > 0 ? glm::vec3(sum / count) : glm::vec3(0.0f);
}

}  // namespace

/// One frame.
struct LightMapFrames::View {
  glm::vec3 eye, forward, right, up;  ///< right and up reach the film's borders
  int width, height, blocks_across;
  FilmDirections film;
  PrimaryHitParameters parameters;
  std::vector<glm::vec2> within_pixel;  ///< of each sample, in [0, 1)^2
  std::span<glm::vec3> picture;
  const LightMapFrames* coarser;

  View(const Camera& camera, const Film& frame, std::span<glm::vec3> pixels,
       const LightMapFrames* coarser_frames)
      : eye(camera.position),
        forward(camera.forward),
        width(frame.width),
        height(frame.height),
        blocks_across((frame.width + block_side - 1) / block_side),
        film(camera.directions(frame.width, frame.height)),
        picture(pixels),
        coarser(coarser_frames) {
    const double half_height = std::tan(0.5 * camera.vertical_field_of_view);
    right = glm::vec3(half_height * width / height * camera.right);
    up = glm::vec3(half_height * camera.up);
    parameters.width = width;
    parameters.height = height;
    parameters.samples_per_pixel = 1;
    for (int i = 0; i < frame.samples_per_pixel; ++i) within_pixel.push_back(place_in_pixel(i));
  }

  std::size_t blocks() const {
    return static_cast<std::size_t>(blocks_across) *
           static_cast<std::size_t>((height + block_side - 1) / block_side);
  }

  /// Through these places of the pixels from (x, y) on; those beyond the film lie in line with it.
  void directions(int x, int y, const glm::vec2& within,
                  trace::CoherentDirections& directions) const {
    const float per_column = 2.0f / static_cast<float>(width);
    const float per_row = 2.0f / static_cast<float>(height);
    for (int i = 0; i < trace::coherent_rays; ++i) {
      const float sx = (static_cast<float>(x + i % packet_side) + within.x) * per_column - 1.0f;
      const float sy = 1.0f - (static_cast<float>(y + i / packet_side) + within.y) * per_row;
      const glm::vec3 d = forward + sx * right + sy * up;
      const float scale = 1.0f / std::sqrt(glm::dot(d, d));
      directions.x[i] = scale * d.x;
      directions.y[i] = scale * d.y;
      directions.z[i] = scale * d.z;
    }
  }
};

LightMapFrames::LightMapFrames(const RayScene& rays, LightMaps& maps, NodeSource& source)
    : rays_(rays),
      scene_(rays.scene()),
      maps_(maps),
      source_(source),
      surfaces_(scene_.triangle_count()),
      layer_of_(light_groups_of(scene_).group_of),
      emitted_(emitted_radiance_at_unit_power(scene_)),
      distant_(scene_),
      seconds_per_place_(source.surroundings().rounds > 0 ? seconds_of_rays : seconds_of_photons) {
  const std::span<const std::uint32_t> chart_of = maps.charts().chart_of();
  for (std::uint32_t t = 0; t < surfaces_.size(); ++t) {
    const Material& material = scene_.materials[scene_.triangle_material[t]];
    Surface& surface = surfaces_[t];
    surface.chart[0] = chart_of[sided(t, 0)];
    surface.chart[1] = chart_of[sided(t, 1)];
    surface.reflects = (material.diffuse + material.specular) * glm::one_over_pi<float>();
    const bool opaque = material.interaction == Interaction::opaque;
    surface.kind = !opaque || material.has_holes()    ? Surface::followed
                   : scene_.triangle_light[t] != none ? Surface::lamp
                   : material.textured()              ? Surface::textured
                                                      : Surface::plain;
  }
}

DrawnFrame LightMapFrames::draw(const Camera& camera, const Film& film,
                                std::span<const glm::vec3> powers, const FrameFilling& filling,
                                std::span<glm::vec3> picture, const Progress& progress,
                                LightMapFrames* coarser) {
  const View view(camera, film, picture, coarser);
  begin_frame();
  if (coarser) coarser->begin_frame();
  DrawnFrame drawn;
  std::vector<std::size_t> blocks(view.blocks());
  std::iota(blocks.begin(), blocks.end(), std::size_t{0});
  std::optional<Stopwatch> watch;
  std::uint64_t places = 0;
  for (;;) {
    progress.throw_if_cancelled();
    mix(powers);
    if (coarser) coarser->mix(powers);
    const Missing missing = draw_blocks(view, blocks);
    const std::vector<MissingPlace>& last = coarser ? missing.coarser : missing.places;
    const bool was_grey = drawn.empty > 0;
    drawn.lacking = missing.places.size() + missing.coarser.size();
    drawn.empty = static_cast<std::size_t>(
        std::count_if(last.begin(), last.end(), [](const auto& place) { return place.empty; }));
    places = std::max(places, missing.read);  // the first round draws all
    drawn.lacking_share =
        places > 0 ? static_cast<double>(missing.lacking) / static_cast<double>(places) : 0.0;
    drawn.fill_seconds = watch ? watch->seconds() : 0;
    const bool ends = was_grey && drawn.empty == 0 && std::isfinite(filling.seconds);
    if (drawn.lacking == 0 || ends || !(filling.left(drawn.fill_seconds) > 0)) return drawn;
    if (!watch) watch.emplace();
    if (missing.coarser.empty()) {
      fill(missing.places, filling, drawn.fill_seconds, progress);
    } else {
      coarser->fill(missing.coarser, filling, drawn.fill_seconds, progress);
    }
  }
}

void LightMapFrames::begin_frame() {
  if (bound_ == 0) return;
  ++frame_;
  forget_unseen();
}

void LightMapFrames::mix(std::span<const glm::vec3> powers) {
  mixed_.mix(maps_.values(), maps_.statistics().nodes, powers);
  if (bound_ > 0) seen_.resize(maps_.statistics().nodes, 0);
  ambient_ = mean_of_some(mixed_.light());
}

/// Before a frame: the latest is the one before.
void LightMapFrames::forget_unseen() {
  const LightMapStatistics statistics = maps_.statistics();
  const std::uint64_t own = statistics.value_bytes + statistics.index_bytes;
  if (own + source_.bytes() <= bound_ || statistics.nodes == 0) return;
  source_.forget();
  if (own <= bound_ / 2) return;
  seen_.resize(statistics.nodes, 0);
  // The oldest frame whose cells stay: so many nodes take half of the memory.
  const auto bytes = static_cast<double>(own);
  const auto staying = static_cast<std::size_t>(static_cast<double>(bound_) / 2 / bytes *
                                                static_cast<double>(statistics.nodes));
  std::vector<std::uint32_t> newest_first = seen_;
  const auto place = newest_first.begin() +
                     static_cast<std::ptrdiff_t>(std::min(staying, newest_first.size() - 1));
  std::nth_element(newest_first.begin(), place, newest_first.end(), std::greater<>());
  const std::uint32_t oldest = std::min(*place + 1, frame_ - 1);
  std::vector<std::uint8_t> keep(seen_.size());
  for (std::size_t node = 0; node < keep.size(); ++node) keep[node] = seen_[node] >= oldest ? 1 : 0;
  // A view that takes more than there is keeps what it has; a few nodes are not worth the work.
  const auto stay = std::count(keep.begin(), keep.end(), std::uint8_t{1});
  if (static_cast<std::size_t>(stay) > keep.size() - keep.size() / 4) return;
  const std::vector<std::uint32_t> former = maps_.forget(keep);
  mixed_.keep(former);
  for (std::size_t i = 0; i < former.size(); ++i) seen_[i] = seen_[former[i]];
  seen_.resize(former.size());
}

/// Draws blocks; leaves those that lack nodes. Returns a place of each cell that is missing, those
/// without any level first, then the nearest to the eye.
LightMapFrames::Missing LightMapFrames::draw_blocks(const View& view,
                                                    std::vector<std::size_t>& blocks) const {
  tbb::enumerable_thread_specific<Missing> missing_of_threads;
  std::vector<std::uint8_t> lacks(blocks.size());
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
    const trace::FlushDenormals flush_denormals;
    Missing& missing = missing_of_threads.local();
    missing.any = false;
    draw_block(view, blocks[i], missing);
    lacks[i] = missing.any ? 1 : 0;
  });
  Missing all;
  for (const Missing& missing : missing_of_threads) {
    all.lacking += missing.lacking;
    all.read += missing.read;
    all.places.insert(all.places.end(), missing.places.begin(), missing.places.end());
    all.coarser.insert(all.coarser.end(), missing.coarser.begin(), missing.coarser.end());
  }
  for (std::vector<MissingPlace>* places : {&all.places, &all.coarser}) {
    std::sort(places->begin(), places->end(), [](const auto& a, const auto& b) {
      return std::tie(a.cell, a.distance) < std::tie(b.cell, b.distance);
    });
    const auto same_cell = [](const auto& a, const auto& b) { return a.cell == b.cell; };
    places->erase(std::unique(places->begin(), places->end(), same_cell), places->end());
    std::sort(places->begin(), places->end(), [](const auto& a, const auto& b) {
      return std::tuple(!a.empty, a.distance, a.cell) < std::tuple(!b.empty, b.distance, b.cell);
    });
  }
  std::size_t left = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (lacks[i] != 0) blocks[left++] = blocks[i];
  }
  blocks.resize(left);
  return all;
}

/// Values the next level of places, in their order, as long as there is time: of one at least, and
/// of grey ones alone where there are some.
///   spent   seconds
void LightMapFrames::fill(std::span<const MissingPlace> places, const FrameFilling& filling,
                          double spent, const Progress& progress) {
  const auto grey = std::partition_point(places.begin(), places.end(),
                                         [](const MissingPlace& place) { return place.empty; });
  if (grey != places.begin()) places = {places.begin(), grey};
  const Stopwatch stopwatch;
  std::size_t first = 0;
  double left = filling.left(spent);
  do {
    // So many as the time is enough for: a batch too many is a frame too late.
    const double seconds = std::min(left, seconds_of_batch);
    const std::size_t count =
        std::isinf(left)
            ? places.size()
            : std::clamp<std::size_t>(static_cast<std::size_t>(seconds / seconds_per_place_), 1,
                                      places.size() - first);
    PrimaryHits hits;
    for (const MissingPlace& place : places.subspan(first, count)) {
      hits.position.push_back(place.position);
      hits.sided_triangle.push_back(place.sided_triangle);
    }
    const Stopwatch of_batch;
    maps_.fill(hits, source_, progress, 1);
    const double latest = of_batch.seconds() / static_cast<double>(count);
    seconds_per_place_ += 0.5 * (latest - seconds_per_place_);
    first += count;
    left = filling.left(spent + stopwatch.seconds());
  } while (first < places.size() && left > 0);
}

void LightMapFrames::draw_block(const View& view, std::size_t block, Missing& missing) const {
  const int left = static_cast<int>(block) % view.blocks_across * block_side;
  const int top = static_cast<int>(block) / view.blocks_across * block_side;
  trace::CoherentDirections directions;
  trace::CoherentHits hits;
  const auto samples = static_cast<float>(view.within_pixel.size());
  for (int y = top; y < std::min(top + block_side, view.height); y += packet_side) {
    for (int x = left; x < std::min(left + block_side, view.width); x += packet_side) {
      std::array<glm::vec3, trace::coherent_rays> sum{};
      for (const glm::vec2& within : view.within_pixel) {
        view.directions(x, y, within, directions);
        trace::intersect(rays_, view.eye, directions, hits);
        for (int i = 0; i < trace::coherent_rays; ++i) {
          const int px = x + i % packet_side, py = y + i / packet_side;
          if (px >= view.width || py >= view.height) continue;
          const glm::vec3 direction(directions.x[i], directions.y[i], directions.z[i]);
          sum[i] += hits.triangle[i] == none
                        ? background(direction)
                        : seen(view, static_cast<std::uint32_t>(py * view.width + px), direction,
                               hits.triangle[i], hits.side[i], hits.u[i], hits.v[i],
                               hits.distance[i], missing);
        }
      }
      for (int i = 0; i < trace::coherent_rays; ++i) {
        const int px = x + i % packet_side, py = y + i / packet_side;
        if (px >= view.width || py >= view.height) continue;
        view.picture[static_cast<std::size_t>(py * view.width + px)] = sum[i] / samples;
      }
    }
  }
}

glm::vec3 LightMapFrames::seen(const View& view, std::uint32_t pixel, const glm::vec3& direction,
                               std::uint32_t triangle, std::uint32_t side, float u, float v,
                               float distance, Missing& missing) const {
  const Surface& surface = surfaces_[triangle];
  if (surface.kind == Surface::followed) return followed(view, pixel, direction, missing);
  const glm::vec3 light =
      irradiance(view, sided(triangle, side), view.eye + distance * direction, missing);
  if (surface.kind == Surface::plain) return surface.reflects * light;
  trace::SurfacePoint point;  // its place in textures: all that is asked of it
  point.where = {triangle, u, v};
  point.side = side;
  const scene::Reflectance reflectance = trace::reflectance(scene_, point);
  glm::vec3 radiance = (reflectance.albedo + reflectance.f0) * glm::one_over_pi<float>() * light;
  if (surface.kind == Surface::lamp && trace::emits(scene_, point)) {
    const std::uint32_t lamp = scene_.triangle_light[triangle];
    const bool even = scene_.lights[lamp].distribution == none;
    if (!even) point = trace::surface_point(scene_, point.where, side);
    radiance += mixed_.powers()[layer_of_[lamp]] * emitted_[lamp] *
                trace::emission_towards(scene_, point, -direction);
  }
  return radiance;
}

glm::vec3 LightMapFrames::irradiance(const View& view, std::uint32_t sided_triangle,
                                     const glm::vec3& position, Missing& missing) const {
  bool lacks = false;
  std::optional<glm::vec3> light =
      known_irradiance(view, sided_triangle, position, missing.places, lacks);
  if (!light && view.coarser) {
    light = view.coarser->known_irradiance(view, sided_triangle, position, missing.coarser, lacks);
  }
  missing.any |= lacks;
  missing.lacking += lacks ? 1 : 0;
  ++missing.read;
  return light.value_or(view.coarser ? view.coarser->ambient_ : ambient_);
}

/// None where no level is valued.
std::optional<glm::vec3> LightMapFrames::known_irradiance(const View& view,
                                                          std::uint32_t sided_triangle,
                                                          const glm::vec3& position,
                                                          std::vector<MissingPlace>& missing,
                                                          bool& lacks) const {
  NodeBlend blend{};
  if (const auto cell = maps_.tiles().find(
          surfaces_[triangle_of(sided_triangle)].chart[side_of(sided_triangle)], position, blend)) {
    const bool empty = blend.node[0] == none;
    lacks = true;
    if (missing.empty() || missing.back().cell != *cell) {
      missing.push_back(
          {*cell, empty, glm::distance(view.eye, position), position, sided_triangle});
    }
    if (empty) return std::nullopt;
  }
  if (bound_ > 0) {
    const std::atomic_ref<std::uint32_t> seen(seen_[blend.node[0]]);
    if (seen.load(std::memory_order_relaxed) != frame_) {
      seen.store(frame_, std::memory_order_relaxed);
    }
  }
  const std::span<const glm::vec4> light = mixed_.light();
  const auto blended = [&](std::span<const glm::vec4> of) {
    return (blend.weight[0] * of[blend.node[0]] + blend.weight[1] * of[blend.node[1]]) +
           (blend.weight[2] * of[blend.node[2]] + blend.weight[3] * of[blend.node[3]]);
  };
  const glm::vec3 sum(blended(light));
  if (mixed_.by_normal().empty()) return sum;
  return turned(sum, blended(mixed_.by_normal()),
                trace::shading_normal(scene_, sided_triangle, position));
}

/// A ray that goes on: traced anew, with all that it meets.
glm::vec3 LightMapFrames::followed(const View& view, std::uint32_t pixel,
                                   const glm::vec3& direction, Missing& missing) const {
  const trace::EyeSetup setup{.rays = &impl_of(rays_),
                              .film = &view.film,
                              .eye = view.eye,
                              .parameters = &view.parameters,
                              .emitted_radiance = &emitted_,
                              .distant = &distant_,
                              .direct = nullptr};
  trace::EyeRecord record;
  const trace::RandomStream random(view.parameters.seed, pixel, 0);
  trace::follow_eye_ray(setup, {view.eye, direction, glm::vec3(1.0f), pixel}, random, record);
  glm::vec3 radiance(0.0f);
  for (std::size_t i = 0; i < record.hits.size(); ++i) {
    const trace::EyeHit& hit = record.hits[i];
    const glm::vec3 lobe = record.glossy.empty() ? glm::vec3(0.0f) : record.glossy[i].lobe.specular;
    radiance += hit.throughput * (hit.diffuse_albedo + lobe) * glm::one_over_pi<float>() *
                irradiance(view, hit.sided_triangle, hit.position, missing);
  }
  for (const SeenEmission& lamp : record.emission) {
    radiance += mixed_.powers()[layer_of_[lamp.light]] * lamp.radiance;
  }
  return radiance;
}

glm::vec3 LightMapFrames::background(const glm::vec3& direction) const {
  glm::vec3 radiance(0.0f);
  for (const trace::DistantLight& light : distant_) {
    radiance += mixed_.powers()[layer_of_[light.light()]] * light.radiance(direction);
  }
  return radiance;
}

}  // namespace photile::cache
