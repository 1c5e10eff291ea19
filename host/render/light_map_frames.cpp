#include "render/light_map_frames.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <glm/gtc/constants.hpp>

#include "light_maps/charts.hpp"
#include "light_maps/tiles.hpp"
#include "trace/coherent_rays.hpp"
#include "trace/eye_path.hpp"
#include "trace/flush_denormals.hpp"

namespace photile {
namespace {

/// Pixels of a packet of rays and of a block, whose packets one task traces, on each side.
constexpr int packet_side = 4, block_side = 32;
static_assert(packet_side * packet_side == trace::coherent_rays);

}  // namespace

/// One frame.
struct LightMapFrames::View {
  glm::vec3 eye, forward, right, up;  ///< right and up reach the film's borders
  int width, height, blocks_across;
  FilmDirections film;
  PrimaryHitParameters parameters;
  std::span<glm::vec3> picture;

  View(const Camera& camera, int film_width, int film_height, std::span<glm::vec3> pixels)
      : eye(camera.position),
        forward(camera.forward),
        width(film_width),
        height(film_height),
        blocks_across((film_width + block_side - 1) / block_side),
        film(camera.directions(film_width, film_height)),
        picture(pixels) {
    const double half_height = std::tan(0.5 * camera.vertical_field_of_view);
    right = glm::vec3(half_height * film_width / film_height * camera.right);
    up = glm::vec3(half_height * camera.up);
    parameters.width = film_width;
    parameters.height = film_height;
    parameters.samples_per_pixel = 1;
  }

  std::size_t blocks() const {
    return static_cast<std::size_t>(blocks_across) *
           static_cast<std::size_t>((height + block_side - 1) / block_side);
  }

  /// Through the middles of the pixels from (x, y) on; those beyond the film lie in line with it.
  void directions(int x, int y, trace::CoherentDirections& directions) const {
    const float per_column = 2.0f / static_cast<float>(width);
    const float per_row = 2.0f / static_cast<float>(height);
    for (int i = 0; i < trace::coherent_rays; ++i) {
      const float sx = (static_cast<float>(x + i % packet_side) + 0.5f) * per_column - 1.0f;
      const float sy = 1.0f - (static_cast<float>(y + i / packet_side) + 0.5f) * per_row;
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
      distant_(trace::distant_lights(scene_)) {
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

std::size_t LightMapFrames::draw(const Camera& camera, int width, int height,
                                 std::span<const glm::vec3> powers, int rounds,
                                 std::span<glm::vec3> picture, const Progress& progress) {
  const View view(camera, width, height, picture);
  std::vector<std::size_t> blocks(view.blocks());
  for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i] = i;
  for (;; --rounds) {
    progress.throw_if_cancelled();
    mixed_.mix(maps_.values(), maps_.statistics().nodes, powers);
    tbb::enumerable_thread_specific<Missing> missing_of_threads;
    std::vector<std::uint8_t> lacks(blocks.size());
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
      const trace::FlushDenormals flush_denormals;
      Missing& missing = missing_of_threads.local();
      missing.any = false;
      draw_block(view, blocks[i], missing);
      lacks[i] = missing.any ? 1 : 0;
    });
    PrimaryHits hits;
    for (const Missing& missing : missing_of_threads) {
      hits.position.insert(hits.position.end(), missing.position.begin(), missing.position.end());
      hits.sided_triangle.insert(hits.sided_triangle.end(), missing.sided_triangle.begin(),
                                 missing.sided_triangle.end());
    }
    if (hits.size() == 0 || rounds == 0) return hits.size();
    maps_.fill(hits, source_, progress, 1);
    std::vector<std::size_t> again;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      if (lacks[i] != 0) again.push_back(blocks[i]);
    }
    blocks = std::move(again);
  }
}

void LightMapFrames::draw_block(const View& view, std::size_t block, Missing& missing) const {
  const int left = static_cast<int>(block) % view.blocks_across * block_side;
  const int top = static_cast<int>(block) / view.blocks_across * block_side;
  trace::CoherentDirections directions;
  trace::CoherentHits hits;
  for (int y = top; y < std::min(top + block_side, view.height); y += packet_side) {
    for (int x = left; x < std::min(left + block_side, view.width); x += packet_side) {
      view.directions(x, y, directions);
      trace::intersect(rays_, view.eye, directions, hits);
      for (int i = 0; i < trace::coherent_rays; ++i) {
        const int px = x + i % packet_side, py = y + i / packet_side;
        if (px >= view.width || py >= view.height) continue;
        const auto pixel = static_cast<std::uint32_t>(py * view.width + px);
        const glm::vec3 direction(directions.x[i], directions.y[i], directions.z[i]);
        view.picture[pixel] = hits.triangle[i] == none
                                  ? background(direction)
                                  : seen(view, pixel, direction, hits.triangle[i], hits.side[i],
                                         hits.u[i], hits.v[i], hits.distance[i], missing);
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
      irradiance(sided(triangle, side), view.eye + distance * direction, missing);
  if (surface.kind == Surface::plain) return surface.reflects * light;
  const trace::SurfacePoint point = trace::surface_point(scene_, {triangle, u, v}, side);
  const scene_io::Reflectance reflectance = trace::reflectance(scene_, point);
  glm::vec3 radiance = (reflectance.albedo + reflectance.f0) * glm::one_over_pi<float>() * light;
  if (surface.kind == Surface::lamp && trace::emits(scene_, point)) {
    const std::uint32_t lamp = scene_.triangle_light[triangle];
    radiance +=
        mixed_.powers()[layer_of_[lamp]] * emitted_[lamp] * trace::emission_texel(scene_, point);
  }
  return radiance;
}

glm::vec3 LightMapFrames::irradiance(std::uint32_t sided_triangle, const glm::vec3& position,
                                     Missing& missing) const {
  NodeBlend blend;
  if (maps_.tiles().find(surfaces_[triangle_of(sided_triangle)].chart[side_of(sided_triangle)],
                         position, blend)) {
    missing.any = true;
    missing.position.push_back(position);
    missing.sided_triangle.push_back(sided_triangle);
    if (blend.node[0] == none) return glm::vec3(0.0f);
  }
  const std::span<const glm::vec4> light = mixed_.light();
  const glm::vec4 sum =
      (blend.weight[0] * light[blend.node[0]] + blend.weight[1] * light[blend.node[1]]) +
      (blend.weight[2] * light[blend.node[2]] + blend.weight[3] * light[blend.node[3]]);
  return glm::vec3(sum);
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
                irradiance(hit.sided_triangle, hit.position, missing);
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

}  // namespace photile
