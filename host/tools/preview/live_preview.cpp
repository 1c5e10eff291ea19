#include "tools/preview/live_preview.hpp"

#include <utility>
#include <vector>

#include "image/pixel_lights.hpp"
#include "photile/errors.hpp"

namespace photile::image {
namespace {

/// A failed preview is told and ends; the work goes on.
template <class Work>
void attempt(std::unique_ptr<TevConnection>& tev, Progress& progress, const Work& work) {
  try {
    work();
  } catch (const OutputError& error) {
    tev.reset();
    progress.note(std::string("warning: ") + error.what() + "; there is no preview");
  }
}

}  // namespace

LivePreview::LivePreview(const std::string& address, std::string name, LightMix mix,
                         Progress& progress)
    : name_(std::move(name)), mix_(std::move(mix)), progress_(progress) {
  attempt(tev_, progress_, [&] { tev_ = std::make_unique<TevConnection>(address); });
}

void LivePreview::rows(const LightLayers& layers, int first, int last, double share) {
  if (tev_) attempt(tev_, progress_, [&] { send_rows(layers, first, last, share); });
}

void LivePreview::picture(const LightLayers& layers, const LightMix& mix) {
  mix_ = mix;
  rows(layers, 0, layers.height, 1);
}

void LivePreview::picture(int width, int height, std::span<const glm::vec3> rgb) {
  if (!tev_) return;
  attempt(tev_, progress_, [&] {
    create(width, height);
    tev_->update(name_, 0, 0, width, height, rgb);
  });
}

/// Unless the picture there is of this size.
void LivePreview::create(int width, int height) {
  if (width == width_ && height == height_) return;
  tev_->create(name_, width, height);
  width_ = width;
  height_ = height;
}

void LivePreview::send_rows(const LightLayers& layers, int first, int last, double share) {
  create(layers.width, layers.height);
  const auto width = static_cast<std::size_t>(width_);
  const auto begin = static_cast<std::size_t>(first);
  std::vector<glm::vec3> rgb(width * static_cast<std::size_t>(last - first));
  for_each_pixel(rgb.size(), [&](std::size_t pixel) {
    for_each_light(layers, pixel % width, begin + pixel / width,
                   [&](std::size_t light, float, const glm::vec3& radiance) {
                     const MixedLight& mixed = mix_.lights[light];
                     if (mixed.power == 0) return;  // infinity times zero is not black
                     rgb[pixel] +=
                         radiance * glm::vec3(mixed.power / share * glm::dvec3(mixed.tint));
                   });
  });
  tev_->update(name_, 0, first, width_, last - first, rgb);
}

}  // namespace photile::image
