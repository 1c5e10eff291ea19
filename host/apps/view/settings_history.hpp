// The earlier settings of the window, for Ctrl+Z and Ctrl+Y: one history of lamps, hour and
// luminaires.
#pragma once

#include "view/history.hpp"
#include "view/light_board.hpp"
#include "view/luminaire_session.hpp"

namespace photile::view {

class SettingsHistory {
 public:
  /// References are kept.
  ///   luminaires   that are edited; null = none
  SettingsHistory(LightBoard& lights, LuminaireSession* luminaires)
      : lights_(lights), luminaires_(luminaires), before_(now()) {}

  /// Around all that a frame of the window may set.
  void begin_frame() { before_ = now(); }
  ///   held   whether a control is still held
  void end_frame(bool lights_changed, bool held);

  /// Takes the last change back, or makes it again. Returns whether there was one.
  bool undo();
  bool redo();

 private:
  struct Settings {
    LightBoard lights;
    loading::LuminaireList luminaires;
  };
  Settings now() const;
  void restore(const Settings& settings);

  LightBoard& lights_;
  LuminaireSession* luminaires_;
  Settings before_;
  History<Settings> history_;
};

}  // namespace photile::view
