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
#include <unordered_map>
#include <utility>

#include "cache/charts.hpp"
#include "cache/shown_nodes.hpp"
#include "photile/limits.hpp"
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
constexpr double seconds_of_photons = 20e-6, seconds_of_rays = 10e-3;
/// Seconds of valuing positions after which it is checked whether the frame is to end.
constexpr double seconds_of_batch = 0.015;

/// Where ray `i` meets a pixel: the first in its middle, and any number of them evenly spread
/// (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018). The same in every
/// pixel and frame: nothing flickers.
glm::vec2 position_in_pixel(int i) {
  constexpr double plastic = 1.32471795724474602596;  // the root of x^3 = x + 1
  return glm::vec2(glm::fract(0.5 + glm::dvec2(i / plastic, i / (plastic * plastic))));
}

/// Light in space is gathered anew when the number of valued nodes has grown by this factor.
constexpr double more_nodes = 1.1;

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
    for (int i = 0; i < frame.samples_per_pixel; ++i) within_pixel.push_back(position_in_pixel(i));
  }

  std::size_t blocks() const {
    return static_cast<std::size_t>(blocks_across) *
           static_cast<std::size_t>((height + block_side - 1) / block_side);
  }

  /// Through these positions of the pixels from (x, y) on; those beyond the film lie in line with
  /// it.
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

LightMapFrames::LightMapFrames(const RayScene& rays, LightMaps& maps)
    : rays_(rays),
      scene_(rays.scene()),
      maps_(maps),
      surfaces_(scene_.triangle_count()),
      layer_of_(light_groups_of(scene_).group_of),
      emitted_(emitted_radiance_at_unit_power(scene_)),
      distant_(scene_),
      is_shown_(maps.charts().size(), 0),
      waits_(maps.charts().size(), 0),
      seconds_per_sample_(maps.source().surroundings().rounds > 0 ? seconds_of_rays
                                                                  : seconds_of_photons) {
  const std::span<const std::uint32_t> chart_of = maps.charts().chart_of();
  for (std::uint32_t t = 0; t < surfaces_.size(); ++t) {
    const Material& material = scene_.materials[scene_.triangle_material[t]];
    Surface& surface = surfaces_[t];
    surface.chart[0] = chart_of[oriented(t, 0)];
    surface.chart[1] = chart_of[oriented(t, 1)];
    surface.reflects = (material.diffuse + material.specular) * glm::one_over_pi<float>();
    const bool opaque = material.interaction == Interaction::opaque;
    surface.kind = !opaque || material.has_cutouts()  ? Surface::followed
                   : scene_.triangle_light[t] != none ? Surface::light
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
  std::vector<std::size_t> all_blocks(view.blocks());
  std::iota(all_blocks.begin(), all_blocks.end(), std::size_t{0});
  std::vector<std::size_t> blocks = all_blocks;
  std::uint64_t samples = 0;
  double left = filling.seconds;
  for (;;) {
    progress.throw_if_cancelled();
    const Stopwatch of_drawing;
    mix(powers, filling.soft);
    if (coarser) coarser->mix(powers, true);
    const Missing missing = draw_blocks(view, blocks, filling);
    drawn.draw_seconds += of_drawing.seconds();
    if (filling.has_ended()) return drawn;
    samples = std::max(samples, missing.read);  // the first round draws all
    const bool more = show_complete(missing.samples);
    if ((coarser && coarser->show_complete(missing.coarser)) || more) continue;
    const bool changed = soften(missing.samples);
    if ((coarser && coarser->soften(missing.coarser)) || changed) {
      blocks = all_blocks;
      continue;
    }

    const std::vector<MissingSample>& last = coarser ? missing.coarser : missing.samples;
    drawn.lacking = missing.samples.size() + missing.coarser.size();
    drawn.empty = static_cast<std::size_t>(
        std::count_if(last.begin(), last.end(), [](const auto& sample) { return sample.empty; }));
    drawn.lacking_fraction =
        samples > 0 ? static_cast<double>(missing.lacking) / static_cast<double>(samples) : 0.0;
    if (drawn.lacking == 0) return drawn;
    if (!(left > 0)) {
      if (!filling.show) return drawn;
      left = filling.show(drawn);
      drawn.draw_seconds = 0;
    }
    const Stopwatch of_filling;
    if (missing.coarser.empty()) {
      fill(missing.samples, left, filling, progress);
    } else {
      coarser->fill(missing.coarser, left, filling, progress);
    }
    left -= of_filling.seconds();
    drawn.fill_seconds += of_filling.seconds();
  }
}

void LightMapFrames::begin_frame() {
  if (bound_ == 0) return;
  ++frame_;
  forget_unseen();
}

void LightMapFrames::mix(std::span<const glm::vec3> powers, bool soft) {
  const std::size_t nodes = maps_.statistics().nodes;
  const std::span<const glm::vec3> former = nodes_.held().powers();
  const bool relit = !std::equal(powers.begin(), powers.end(), former.begin(), former.end());
  nodes_.mix(maps_, powers, lacking_, soft);
  if (bound_ > 0) seen_.resize(nodes, 0);
  const auto known = static_cast<double>(ambient_nodes_), now = static_cast<double>(nodes);
  if (!relit && now >= known && now <= more_nodes * known) return;
  ambient_.gather(maps_, scene_, nodes_.held().light());
  ambient_nodes_ = nodes;
}

/// Before a frame: the latest is the one before.
void LightMapFrames::forget_unseen() {
  const LightMapStatistics statistics = maps_.statistics();
  const std::uint64_t own = maps_.bytes();
  if (own + maps_.source().bytes() <= bound_ || statistics.nodes == 0) return;
  maps_.source().forget();
  if (own <= bound_ / 2) return;
  seen_.resize(statistics.nodes, 0);
  // The oldest frame whose cells stay: the nodes that are kept take half of the memory.
  const auto bytes = static_cast<double>(own);
  const auto staying = static_cast<std::size_t>(static_cast<double>(bound_) / 2 / bytes *
                                                static_cast<double>(statistics.nodes));
  std::vector<std::uint32_t> newest_first = seen_;
  const auto nth = newest_first.begin() +
                   static_cast<std::ptrdiff_t>(std::min(staying, newest_first.size() - 1));
  std::nth_element(newest_first.begin(), nth, newest_first.end(), std::greater<>());
  const std::uint32_t oldest = std::min(*nth + 1, frame_ - 1);
  std::vector<std::uint8_t> keep(seen_.size());
  for (std::size_t node = 0; node < keep.size(); ++node) keep[node] = seen_[node] >= oldest ? 1 : 0;
  // A view that needs more memory than allowed keeps its nodes; a few nodes are not worth the work.
  const auto stay = std::count(keep.begin(), keep.end(), std::uint8_t{1});
  if (static_cast<std::size_t>(stay) > keep.size() - keep.size() / 4) return;
  const std::vector<std::uint32_t> former = maps_.forget(keep);
  nodes_.keep(former);
  lacking_.clear();  // tiles have other numbers now
  for (std::size_t i = 0; i < former.size(); ++i) seen_[i] = seen_[former[i]];
  seen_.resize(former.size());
}

/// Draws blocks; leaves those that lack nodes. Returns samples of the cells that are missing, those
/// without any level first, then chart by chart: that which changes most of the picture comes
/// first, for a chart that is refined in part has steps between its cells.
LightMapFrames::Missing LightMapFrames::draw_blocks(const View& view,
                                                    std::vector<std::size_t>& blocks,
                                                    const FrameFilling& filling) const {
  tbb::enumerable_thread_specific<Missing> missing_of_threads;
  std::vector<std::uint8_t> lacks(blocks.size());
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
    if (filling.has_ended()) return;
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
    all.samples.insert(all.samples.end(), missing.samples.begin(), missing.samples.end());
    all.coarser.insert(all.coarser.end(), missing.coarser.begin(), missing.coarser.end());
  }
  for (std::vector<MissingSample>* samples : {&all.samples, &all.coarser}) put_in_order(*samples);
  std::size_t left = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (lacks[i] != 0) blocks[left++] = blocks[i];
  }
  blocks.resize(left);
  return all;
}

/// Leaves one sample of each cell without a coarser level.
void LightMapFrames::put_in_order(std::vector<MissingSample>& samples) {
  std::unordered_map<std::uint32_t, std::array<double, 2>> gain_of_chart;
  for (const MissingSample& sample : samples)
    gain_of_chart[sample.chart][sample.empty] += sample.gain;
  for (MissingSample& sample : samples) sample.gain = gain_of_chart[sample.chart][sample.empty];
  std::sort(samples.begin(), samples.end(), [](const auto& a, const auto& b) {
    return std::tie(b.empty, b.gain, a.chart, a.cell) < std::tie(a.empty, a.gain, b.chart, b.cell);
  });
  const auto is_repeated = [](const MissingSample& a, const MissingSample& b) {
    return a.empty && a.cell == b.cell;
  };
  samples.erase(std::unique(samples.begin(), samples.end(), is_repeated), samples.end());
}

/// Shows the nodes of charts that were seen and have all of them. Returns whether there were any.
bool LightMapFrames::show_complete(std::span<const MissingSample> missing) {
  for (const MissingSample& sample : missing) {
    if (sample.empty) waits_[sample.chart] = 0;
  }
  bool any = false;
  for (std::size_t chart = 0; chart < waits_.size(); ++chart) {
    if (std::exchange(waits_[chart], 0) == 0) continue;
    is_shown_[chart] = 1;
    any = true;
  }
  return any;
}

/// Softens what is shown around cells that lack their nodes. Returns whether there were none in the
/// picture before, or are none any more: then it is to be drawn again.
bool LightMapFrames::soften(std::span<const MissingSample> missing) {
  const bool any_before = !lacking_.empty();
  lacking_.clear();
  for (const MissingSample& sample : missing) {
    if (sample.cell.has_tile && (lacking_.empty() || lacking_.back() != sample.cell)) {
      lacking_.push_back(sample.cell);
    }
  }
  return lacking_.empty() == any_before;
}

/// Values nodes of samples in their order, as long as there is time, of one at least: the coarsest
/// alone where there are samples without any, else all finer ones.
void LightMapFrames::fill(std::span<const MissingSample> samples, double seconds,
                          const FrameFilling& filling, const Progress& progress) {
  const bool empty = samples.front().empty;
  if (empty) {
    samples = {samples.begin(),
               std::partition_point(samples.begin(), samples.end(),
                                    [](const MissingSample& sample) { return sample.empty; })};
  }
  const Stopwatch stopwatch;
  std::size_t first = 0;
  double left = seconds;
  do {
    // As many as the time allows: one batch too many makes the frame late.
    const double of_batch = std::min(left, seconds_of_batch);
    const std::size_t count =
        std::isinf(left)
            ? samples.size()
            : std::clamp<std::size_t>(static_cast<std::size_t>(of_batch / seconds_per_sample_), 1,
                                      samples.size() - first);
    PrimaryHits hits;
    for (const MissingSample& sample : samples.subspan(first, count)) {
      hits.position.push_back(sample.position);
      hits.oriented_face.push_back(sample.oriented_face);
    }
    const Stopwatch batch_watch;
    maps_.fill(hits, progress, empty ? 1 : limits::max_light_map_levels);
    const double latest = batch_watch.seconds() / static_cast<double>(count);
    seconds_per_sample_ += 0.5 * (latest - seconds_per_sample_);
    first += count;
    left = filling.has_ended() ? 0 : seconds - stopwatch.seconds();
  } while (first < samples.size() && left > 0);
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
      ++missing.packet;
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
      irradiance(view, oriented(triangle, side), view.eye + distance * direction, missing);
  if (surface.kind == Surface::plain) return surface.reflects * light;
  trace::SurfacePoint point;  // its position in textures: no other attribute is read
  point.where = {triangle, u, v};
  point.side = side;
  const scene::Reflectance reflectance = trace::reflectance(scene_, point);
  glm::vec3 radiance = (reflectance.albedo + reflectance.f0) * glm::one_over_pi<float>() * light;
  if (surface.kind == Surface::light && trace::emits(scene_, point)) {
    const std::uint32_t light = scene_.triangle_light[triangle];
    const bool even = scene_.lights[light].distribution == none;
    if (!even) point = trace::surface_point(scene_, point.where, side);
    radiance += nodes_.held().powers()[layer_of_[light]] * emitted_[light] *
                trace::emission_towards(scene_, point, -direction);
  }
  return radiance;
}

glm::vec3 LightMapFrames::irradiance(const View& view, std::uint32_t oriented_face,
                                     const glm::vec3& position, Missing& missing) const {
  bool lacks = false;
  std::optional<glm::vec3> light =
      known_irradiance(oriented_face, position, missing, missing.samples, lacks);
  const bool is_own = light.has_value();
  if (!light && view.coarser) {
    light =
        view.coarser->known_irradiance(oriented_face, position, missing, missing.coarser, lacks);
  }
  missing.any |= lacks || !is_own;
  missing.lacking += lacks ? 1 : 0;
  ++missing.read;
  if (light) return *light;
  return (view.coarser ? view.coarser->ambient_ : ambient_)
      .irradiance(position, glm::vec3(face_normal(scene_, oriented_face)));
}

/// None where no level is valued, and while a chart lacks some of what is seen of it: light of two
/// kinds on one surface would show where they meet.
std::optional<glm::vec3> LightMapFrames::known_irradiance(std::uint32_t oriented_face,
                                                          const glm::vec3& position,
                                                          Missing& missing,
                                                          std::vector<MissingSample>& samples,
                                                          bool& lacks) const {
  BilinearWeights bilinear{};
  const std::uint32_t chart = surfaces_[triangle_of(oriented_face)].chart[side_of(oriented_face)];
  if (const auto cell = maps_.tiles().find(chart, position, bilinear)) {
    const bool empty = bilinear.node[0] == none;
    lacks = true;
    if (samples.empty() || samples.back().cell != *cell ||
        samples.back().packet != missing.packet) {
      samples.push_back({*cell, empty, chart, missing.packet, 0, position, oriented_face});
    }
    samples.back().gain += empty ? 1 : difference(bilinear);
    if (empty) return std::nullopt;
  }
  if (is_shown_[chart] == 0) {
    std::atomic_ref<std::uint8_t>(waits_[chart]).store(1, std::memory_order_relaxed);
    return std::nullopt;
  }
  if (bound_ > 0) {
    const std::atomic_ref<std::uint32_t> seen(seen_[bilinear.node[0]]);
    if (seen.load(std::memory_order_relaxed) != frame_) {
      seen.store(frame_, std::memory_order_relaxed);
    }
  }
  missing.any |= nodes_.lacks_beside(bilinear);
  bilinear = nodes_.weighted(bilinear);
  const auto interpolated = [&](std::span<const glm::vec4> of) {
    return (bilinear.weight[0] * of[bilinear.node[0]] + bilinear.weight[1] * of[bilinear.node[1]]) +
           (bilinear.weight[2] * of[bilinear.node[2]] + bilinear.weight[3] * of[bilinear.node[3]]);
  };
  const glm::vec3 sum(interpolated(nodes_.light()));
  if (nodes_.by_normal().empty()) return sum;
  return turned(sum, interpolated(nodes_.by_normal()),
                trace::shading_normal(scene_, oriented_face, position));
}

/// Of the luminance of the nodes.
double LightMapFrames::difference(const BilinearWeights& bilinear) const {
  const auto light = [&](std::size_t corner) {
    return luminance(glm::dvec3(nodes_.held().light()[bilinear.node[corner]]));
  };
  const auto [least, most] = std::minmax({light(0), light(1), light(2), light(3)});
  return most - least;
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
                irradiance(view, hit.oriented_face, hit.position, missing);
  }
  for (const VisibleEmission& light : record.emission) {
    radiance += nodes_.held().powers()[layer_of_[light.light]] * light.radiance;
  }
  return radiance;
}

glm::vec3 LightMapFrames::background(const glm::vec3& direction) const {
  glm::vec3 radiance(0.0f);
  for (const trace::DistantLight& light : distant_) {
    radiance += nodes_.held().powers()[layer_of_[light.light()]] * light.radiance(direction);
  }
  return radiance;
}

}  // namespace photile::cache
