#include "view/picture_area.hpp"

#include "view/photon_map.hpp"

namespace photile::view {

PictureArea PictureArea::now() {
  const ImGuiViewport* const viewport = ImGui::GetMainViewport();
  return {viewport->WorkPos, viewport->WorkSize};
}

glm::dvec2 PictureArea::shares(const ImVec2& point) const {
  return {static_cast<double>((point.x - corner.x) / size.x),
          static_cast<double>((point.y - corner.y) / size.y)};
}

glm::dvec3 PictureArea::direction(const Camera& camera, const ImVec2& point) const {
  return camera.direction(static_cast<double>(point.x - corner.x),
                          static_cast<double>(point.y - corner.y), static_cast<int>(size.x),
                          static_cast<int>(size.y));
}

std::optional<ImVec2> PictureArea::shown(const Camera& camera, const glm::dvec3& position) const {
  const auto pixel = project(camera, position, static_cast<int>(size.x), static_cast<int>(size.y));
  if (!pixel) return std::nullopt;
  return ImVec2(corner.x + static_cast<float>(pixel->x), corner.y + static_cast<float>(pixel->y));
}

}  // namespace photile::view
