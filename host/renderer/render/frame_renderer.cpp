#include "render/frame_renderer.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/gtc/constants.hpp>
#include <numeric>
#include <optional>

#include "photile/statistics.hpp"
#include "trace/coherent_rays.hpp"
#include "trace/eye_path.hpp"
#include "trace/ray_query.hpp"

namespace photile {
namespace {

/// Pixels of a packet of rays and of a block, whose packets one task traces, on each side.
constexpr int packet_side = 4, block_side = 32;
static_assert(packet_side * packet_side == trace::coherent_rays);

/// Where ray `i` meets a pixel: the first in its middle, and any number of them evenly spread
/// (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018). The same in every
/// pixel and frame: nothing flickers.
glm::vec2 position_in_pixel(int i) {
  constexpr double plastic = 1.32471795724474602596;  // the root of x^3 = x + 1
  return glm::vec2(glm::fract(0.5 + glm::dvec2(i / plastic, i / (plastic * plastic))));
}

}  // namespace

/// One picture of a frame, and what it draws from.
class FrameRenderer::Picture {
 public:
  /// References are kept.
  ///   views   whose light is shown: that of the first which has light at a point
  Picture(const FrameRenderer& renderer, const Camera& camera, const Film& film,
          std::span<const glm::vec3> powers, std::span<cache::FrameView* const> views,
          std::span<glm::vec3> pixels)
      : renderer_(renderer),
        scene_(renderer.rays_.scene()),
        powers_(powers),
        views_(views),
        pixels_(pixels),
        width_(film.width),
        height_(film.height),
        blocks_across_((film.width + block_side - 1) / block_side),
        eye_(camera.position),
        forward_(camera.forward),
        film_(camera.directions(film.width, film.height)) {
    const double half_height = std::tan(0.5 * camera.vertical_field_of_view);
    right_ = glm::vec3(half_height * width_ / height_ * camera.right);
    up_ = glm::vec3(half_height * camera.up);
    parameters_.width = width_;
    parameters_.height = height_;
    parameters_.samples_per_pixel = 1;
    for (int i = 0; i < film.samples_per_pixel; ++i) within_pixel_.push_back(position_in_pixel(i));
  }

  std::vector<std::size_t> all_blocks() const {
    std::vector<std::size_t> blocks(
        static_cast<std::size_t>(blocks_across_) *
        static_cast<std::size_t>((height_ + block_side - 1) / block_side));
    std::iota(blocks.begin(), blocks.end(), std::size_t{0});
    return blocks;
  }

  /// What pixels read of light maps.
  struct Reads {
    std::uint64_t samples = 0, lacking = 0, unlit = 0;
    bool unfinished = false;  ///< whether they are to be drawn again
  };
  /// Draws blocks; leaves those that are to be drawn again.
  Reads draw(std::vector<std::size_t>& blocks, const FrameFilling& filling) const {
    std::vector<Reads> reads(blocks.size());
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
      if (filling.has_ended()) return;
      const trace::FlushDenormals flush_denormals;
      reads[i] = draw_block(static_cast<int>(blocks[i]));
    });
    Reads all;
    std::size_t left = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      all.samples += reads[i].samples;
      all.lacking += reads[i].lacking;
      all.unlit += reads[i].unlit;
      if (reads[i].unfinished) blocks[left++] = blocks[i];
    }
    blocks.resize(left);
    return all;
  }

 private:
  /// Of one ray: the direction, and the pixel and its packet of rays.
  struct Sample {
    glm::vec3 direction;
    std::uint32_t pixel, packet;
  };

  Reads draw_block(int block) const {
    Reads reads;
    const int left = block % blocks_across_ * block_side;
    const int top = block / blocks_across_ * block_side;
    trace::CoherentDirections directions;
    trace::CoherentHits hits;
    for (int y = top; y < std::min(top + block_side, height_); y += packet_side) {
      for (int x = left; x < std::min(left + block_side, width_); x += packet_side) {
        const auto packet = static_cast<std::uint32_t>(y * width_ + x);
        std::array<glm::vec3, trace::coherent_rays> sum{};
        const auto for_pixels = [&](const auto& visit) {
          for (int i = 0; i < trace::coherent_rays; ++i) {
            const int px = x + i % packet_side, py = y + i / packet_side;
            if (px < width_ && py < height_) visit(i, static_cast<std::uint32_t>(py * width_ + px));
          }
        };
        for (const glm::vec2& within : within_pixel_) {
          set_directions(x, y, within, directions);
          trace::intersect(renderer_.rays_, eye_, directions, hits);
          for_pixels([&](int i, std::uint32_t pixel) {
            const glm::vec3 direction(directions.x[i], directions.y[i], directions.z[i]);
            sum[i] += hits.triangle[i] == none
                          ? background(direction)
                          : visible({direction, pixel, packet}, hits, i, reads);
          });
        }
        const auto samples = static_cast<float>(within_pixel_.size());
        for_pixels([&](int i, std::uint32_t pixel) { pixels_[pixel] = sum[i] / samples; });
      }
    }
    return reads;
  }

  /// Through these positions of the pixels from (x, y) on; those beyond the film lie in line with
  /// it.
  void set_directions(int x, int y, const glm::vec2& within,
                      trace::CoherentDirections& directions) const {
    const float per_column = 2.0f / static_cast<float>(width_);
    const float per_row = 2.0f / static_cast<float>(height_);
    for (int i = 0; i < trace::coherent_rays; ++i) {
      const float sx = (static_cast<float>(x + i % packet_side) + within.x) * per_column - 1.0f;
      const float sy = 1.0f - (static_cast<float>(y + i / packet_side) + within.y) * per_row;
      const glm::vec3 d = forward_ + sx * right_ + sy * up_;
      const float scale = 1.0f / std::sqrt(glm::dot(d, d));
      directions.x[i] = scale * d.x;
      directions.y[i] = scale * d.y;
      directions.z[i] = scale * d.z;
    }
  }

  glm::vec3 visible(const Sample& sample, const trace::CoherentHits& hits, int i,
                    Reads& reads) const {
    const std::uint32_t triangle = hits.triangle[i], side = hits.side[i];
    const Surface& surface = renderer_.surfaces_[triangle];
    if (surface.kind == Surface::followed) return followed(sample, reads);
    const glm::vec3 light = irradiance(oriented(triangle, side),
                                       eye_ + hits.distance[i] * sample.direction, sample, reads);
    if (surface.kind == Surface::plain) return surface.reflects * light;
    trace::SurfacePoint point;  // its position in textures: no other attribute is read
    point.where = {triangle, hits.u[i], hits.v[i]};
    point.side = side;
    const scene::Reflectance reflectance = trace::reflectance(scene_, point);
    glm::vec3 radiance = (reflectance.albedo + reflectance.f0) * glm::one_over_pi<float>() * light;
    if (surface.kind == Surface::light && trace::emits(scene_, point)) {
      const std::uint32_t light = scene_.triangle_light[triangle];
      const bool even = scene_.lights[light].distribution == none;
      if (!even) point = trace::surface_point(scene_, point.where, side);
      radiance += power_of(light) * renderer_.emitted_[light] *
                  trace::emission_towards(scene_, point, -sample.direction);
    }
    return radiance;
  }

  glm::vec3 irradiance(std::uint32_t oriented_face, const glm::vec3& position, const Sample& sample,
                       Reads& reads) const {
    bool lacks = false;
    std::optional<glm::vec3> light;
    for (const cache::FrameView* view : views_) {
      light = view->irradiance(oriented_face, position, sample.packet, lacks, reads.unfinished);
      if (light) break;
      reads.unfinished = true;
    }
    reads.unfinished |= lacks;
    reads.lacking += lacks ? 1 : 0;
    reads.unlit += light ? 0 : 1;
    ++reads.samples;
    return light ? *light : views_.back()->ambient(oriented_face, position);
  }

  /// A ray that goes on: traced anew, with all that it meets.
  glm::vec3 followed(const Sample& sample, Reads& reads) const {
    const trace::EyeSetup setup{.rays = &impl_of(renderer_.rays_),
                                .film = &film_,
                                .eye = eye_,
                                .parameters = &parameters_,
                                .emitted_radiance = &renderer_.emitted_,
                                .distant = &renderer_.distant_,
                                .direct = nullptr};
    trace::EyeRecord record;
    const trace::RandomStream random(parameters_.seed, sample.pixel, 0);
    trace::follow_eye_ray(setup, {eye_, sample.direction, glm::vec3(1.0f), sample.pixel}, random,
                          record);
    glm::vec3 radiance(0.0f);
    for (std::size_t i = 0; i < record.hits.size(); ++i) {
      const trace::EyeHit& hit = record.hits[i];
      const glm::vec3 lobe =
          record.glossy.empty() ? glm::vec3(0.0f) : record.glossy[i].lobe.specular;
      radiance += hit.throughput * (hit.diffuse_albedo + lobe) * glm::one_over_pi<float>() *
                  irradiance(hit.oriented_face, hit.position, sample, reads);
    }
    for (const VisibleEmission& light : record.emission) {
      radiance += power_of(light.light) * light.radiance;
    }
    return radiance;
  }

  glm::vec3 background(const glm::vec3& direction) const {
    glm::vec3 sum(0.0f);
    renderer_.distant_.for_each_shining(
        direction, [&](const trace::DistantLight& light, const glm::vec3& radiance) {
          sum += power_of(light.light()) * radiance;
        });
    return sum;
  }

  const glm::vec3& power_of(std::uint32_t light) const {
    return powers_[renderer_.layer_of_[light]];
  }

  const FrameRenderer& renderer_;
  const Scene& scene_;
  std::span<const glm::vec3> powers_;
  std::span<cache::FrameView* const> views_;
  std::span<glm::vec3> pixels_;
  int width_, height_, blocks_across_;
  glm::vec3 eye_, forward_, right_, up_;  ///< right and up reach the film's borders
  FilmDirections film_;
  PrimaryHitParameters parameters_;
  std::vector<glm::vec2> within_pixel_;  ///< of each sample, in [0, 1)^2
};

FrameRenderer::FrameRenderer(const RayScene& rays, cache::LightMaps& maps)
    : rays_(rays),
      surfaces_(rays.scene().triangle_count()),
      layer_of_(light_groups_of(rays.scene()).group_of),
      emitted_(emitted_radiance_at_unit_power(rays.scene())),
      distant_(rays.scene()),
      view_(rays.scene(), maps) {
  const Scene& scene = rays.scene();
  for (std::uint32_t t = 0; t < surfaces_.size(); ++t) {
    const Material& material = scene.materials[scene.triangle_material[t]];
    const bool opaque = material.interaction == Interaction::opaque;
    surfaces_[t] = {(material.diffuse + material.specular) * glm::one_over_pi<float>(),
                    !opaque || material.has_cutouts() ? Surface::followed
                    : scene.triangle_light[t] != none ? Surface::light
                    : material.textured()             ? Surface::textured
                                                      : Surface::plain};
  }
}

DrawnFrame FrameRenderer::draw(const Camera& camera, const Film& film,
                               std::span<const glm::vec3> powers, const FrameFilling& filling,
                               std::span<glm::vec3> picture, const Progress& progress,
                               cache::FrameView* coarser) {
  std::vector<cache::FrameView*> views{&view_};
  if (coarser) views.push_back(coarser);
  const auto any = [&](bool (cache::FrameView::*changes)()) {
    return std::count_if(views.begin(), views.end(), std::mem_fn(changes)) > 0;
  };
  const Picture pictured(*this, camera, film, powers, views, picture);
  std::vector<std::size_t> blocks = pictured.all_blocks();
  for (cache::FrameView* view : views) view->begin_frame();
  DrawnFrame drawn;
  std::uint64_t samples = 0;
  double left = filling.seconds;
  for (;;) {
    progress.throw_if_cancelled();
    const Stopwatch of_drawing;
    for (cache::FrameView* view : views) view->mix(powers, filling.soft || view == coarser);
    const Picture::Reads reads = pictured.draw(blocks, filling);
    for (cache::FrameView* view : views) view->end_picture();
    drawn.draw_seconds += of_drawing.seconds();
    if (filling.has_ended()) return drawn;
    samples = std::max(samples, reads.samples);  // the first round draws all
    if (any(&cache::FrameView::show_complete)) continue;
    if (any(&cache::FrameView::soften)) {
      blocks = pictured.all_blocks();
      continue;
    }

    drawn.lacking = 0;
    for (const cache::FrameView* view : views) drawn.lacking += view->lacking();
    drawn.empty = views.back()->empty();
    const auto all = static_cast<double>(std::max<std::uint64_t>(1, samples));
    drawn.lacking_fraction = static_cast<double>(reads.lacking) / all;
    drawn.unlit_fraction = static_cast<double>(reads.unlit) / all;
    if (drawn.lacking == 0) return drawn;
    if (!(left > 0)) {
      if (!filling.show) return drawn;
      left = filling.show(drawn);
      drawn.draw_seconds = 0;
    }
    const Stopwatch of_filling;
    (coarser && coarser->lacking() > 0 ? *coarser : view_).fill(left, filling, progress);
    left -= of_filling.seconds();
    drawn.fill_seconds += of_filling.seconds();
  }
}

std::vector<std::uint8_t> FrameRenderer::light_at(const PrimaryHits& points, bool soft,
                                                  const TakeLight& take,
                                                  cache::FrameView* coarser) {
  std::vector<cache::FrameView*> views{&view_};
  if (coarser) views.push_back(coarser);
  std::vector<cache::BilinearWeights> around(points.size());
  std::vector<std::uint8_t> view_of(points.size()), is_final(points.size());
  std::vector<glm::vec3> light(points.size());
  const auto for_each_point = [&](const auto& visit) {
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
      const trace::FlushDenormals flush_denormals;
      visit(i, points.oriented_face[i], points.position[i]);
    });
  };
  const std::size_t layers = light_groups_of(rays_.scene()).groups.size();
  for (std::size_t layer = 0; layer < layers; ++layer) {
    std::vector<glm::vec3> powers(layers, glm::vec3(0.0f));
    powers[layer] = glm::vec3(1.0f);
    for (cache::FrameView* view : views) view->mix(powers, soft || view == coarser);
    if (layer == 0) {  // how much nodes count does not depend on the layer
      for_each_point([&](std::size_t i, std::uint32_t face, const glm::vec3& position) {
        bool all = false;
        while (view_of[i] < views.size() &&
               !views[view_of[i]]->find(face, position, around[i], all)) {
          ++view_of[i];
        }
        is_final[i] = all ? 1 : 0;
      });
    }
    for_each_point([&](std::size_t i, std::uint32_t face, const glm::vec3& position) {
      light[i] = view_of[i] < views.size() ? views[view_of[i]]->between(around[i], face, position)
                                           : views.back()->ambient(face, position);
    });
    take(layer, light);
  }
  return is_final;
}

}  // namespace photile
