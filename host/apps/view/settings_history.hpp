// The earlier settings of the window, for Ctrl+Z and Ctrl+Y: one history of lamps, hour and
// luminaires.
#pragma once

#include <deque>
#include <utility>

#include "view/light_board.hpp"
#include "view/luminaire_session.hpp"

namespace photile::view {

/// A history of states that are copied whole: lamps' settings, and placed luminaires.
template <class State>
class History {
 public:
  /// Notes what one frame of the window did. A slider that is held makes one change of many frames.
  ///   before    the state at the start of the frame
  ///   changed   whether it is another one now
  ///   held      whether a control is still held
  void note(const State& before, bool changed, bool held) {
    if (changed && !within_change_) {
      constexpr std::size_t kept = 100;  // of hundreds of lamps, a few megabytes
      if (undone_to_.size() == kept) undone_to_.pop_front();
      undone_to_.push_back(before);
      redone_to_.clear();
    }
    within_change_ = held && (changed || within_change_);
  }

  /// Takes the last change back, or makes it again. Returns whether there was one.
  bool undo(State& state) { return exchange(state, undone_to_, redone_to_); }
  bool redo(State& state) { return exchange(state, redone_to_, undone_to_); }

 private:
  static bool exchange(State& state, std::deque<State>& from, std::deque<State>& to) {
    if (from.empty()) return false;
    to.push_back(std::exchange(state, std::move(from.back())));
    from.pop_back();
    return true;
  }

  std::deque<State> undone_to_, redone_to_;  ///< newest last
  bool within_change_ = false;
};

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
