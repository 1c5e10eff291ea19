// Changes that are taken back and made again.
#pragma once

#include <deque>
#include <utility>

namespace photile::view {

/// A history of states that are copied whole.
template <class State>
class History {
 public:
  /// Notes a change. What is held, as while it is dragged, makes one change of many.
  ///   before    the state before it
  ///   changed   whether it is another one now
  ///   held      whether it is still held
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

}  // namespace photile::view
