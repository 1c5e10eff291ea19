#include "view/settings_history.hpp"

namespace photile::view {

SettingsHistory::Settings SettingsHistory::now() const {
  return {lights_, luminaires_ ? luminaires_->editor().list() : loading::LuminaireList()};
}

void SettingsHistory::end_frame(bool lights_changed, bool held) {
  bool placed = false;
  if (luminaires_) {
    placed = !(luminaires_->editor().list() == before_.luminaires);
    held |= luminaires_->tool().dragging();
    if (placed) luminaires_->load_again();
    if (!held) luminaires_->released();
  }
  history_.note(before_, lights_changed || placed, held);
}

void SettingsHistory::restore(const Settings& settings) {
  lights_.take_settings(settings.lights);
  if (!luminaires_ || luminaires_->editor().list() == settings.luminaires) return;
  luminaires_->editor().restore(settings.luminaires);
  luminaires_->load_again();
}

bool SettingsHistory::undo() {
  Settings settings = now();
  const bool done = history_.undo(settings);
  if (done) restore(settings);
  return done;
}

bool SettingsHistory::redo() {
  Settings settings = now();
  const bool done = history_.redo(settings);
  if (done) restore(settings);
  return done;
}

}  // namespace photile::view
