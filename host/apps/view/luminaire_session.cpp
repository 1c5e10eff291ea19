#include "view/luminaire_session.hpp"

#include <fmt/format.h>

#include <utility>

#include "photile/errors.hpp"

namespace photile::view {

void LuminaireSession::released() {
  if (std::exchange(load_, false)) loader_.load(editor_.list().text());
}

std::shared_ptr<const Scene> LuminaireSession::take_scene(std::string& message) {
  if (const std::exception_ptr error = loader_.take_error()) {
    try {
      std::rethrow_exception(error);
    } catch (const std::exception& told) {
      message = told.what();
    }
  }
  const auto loaded = loader_.take();
  if (!loaded) return nullptr;
  editor_.loaded(loaded->luminaires, loaded->scene->luminaires);
  return {loaded->scene, &loaded->scene->scene};
}

bool LuminaireSession::save(std::string& message) {
  const std::string name = editor_.file().filename().string();
  try {
    editor_.save();
    message = fmt::format("{} is saved", name);
    return true;
  } catch (const Error& error) {
    message = error.what();
    return false;
  }
}

bool LuminaireSession::click(const Camera& camera, const glm::dvec3& direction,
                             const std::optional<PhotonInspector::Place>& surface,
                             std::string& message) {
  try {
    return tool_.click(camera, direction, surface);
  } catch (const Error& error) {
    message = error.what();
    return true;
  }
}

bool LuminaireSession::may_close() {
  closing_ = editor_.unsaved() && !discarded_;
  return !closing_;
}

bool LuminaireSession::close_as(Closing closing, std::string& message) {
  if (closing == Closing::undecided) return false;
  closing_ = false;
  discarded_ = closing == Closing::discard;
  return discarded_ || (closing == Closing::save && save(message));
}

void LuminaireSession::tell_unsaved(Progress& notes) const {
  if (!editor_.unsaved() || discarded_) return;
  notes.note(fmt::format("{}: changes of luminaires are not saved", editor_.file().string()));
}

}  // namespace photile::view
