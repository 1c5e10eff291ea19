// A picture in the making, shown in a running tev.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>

#include "photile/light_mix.hpp"
#include "photile/progress.hpp"
#include "tools/preview/tev_connection.hpp"

namespace photile::image {

/// Sends finished rows. Where tev is missing, or gone, it says so once and sends nothing more: what
/// is rendered does not depend on it.
class LivePreview {
 public:
  /// Errors: UsageError for a malformed address.
  LivePreview(const std::string& address, std::string name, LightMix mix, Progress& progress);

  /// Whether there is a tev to send to.
  bool connected() const { return tev_ != nullptr; }

  /// Rows [first, last), of whose light `share` is there.
  void rows(const LightLayers& layers, int first, int last, double share);

  /// A whole picture with another mix.
  void picture(const LightLayers& layers, const LightMix& mix);

  /// A whole picture of mixed lights: linear RGB radiance, row 0 at the top.
  void picture(int width, int height, std::span<const glm::vec3> rgb);

 private:
  void send_rows(const LightLayers& layers, int first, int last, double share);
  void create(int width, int height);

  const std::string name_;
  LightMix mix_;
  Progress& progress_;
  std::unique_ptr<TevConnection> tev_;  ///< null where there is none
  int width_ = 0, height_ = 0;          ///< of the picture there
};

}  // namespace photile::image
