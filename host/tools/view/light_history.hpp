// What was set on the lamps before, for Ctrl+Z and Ctrl+Y.
#pragma once

#include <deque>

#include "tools/view/light_board.hpp"

namespace photile::view {

class LightHistory {
 public:
  /// Notes what one frame of the window did. A slider that is held makes one change of many frames.
  ///   before    the board at the start of the frame
  ///   changed   whether it is another one now
  ///   held      whether a control is still held
  void note(const LightBoard& before, bool changed, bool held);

  /// Takes the last change back, or makes it again. Returns whether there was one.
  bool undo(LightBoard& board);
  bool redo(LightBoard& board);

 private:
  std::deque<LightBoard> undone_to_, redone_to_;  ///< newest last
  bool within_change_ = false;
};

}  // namespace photile::view
