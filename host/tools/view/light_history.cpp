#include "tools/view/light_history.hpp"

#include <utility>

namespace photile::view {
namespace {

bool exchange(LightBoard& board, std::deque<LightBoard>& from, std::deque<LightBoard>& to) {
  if (from.empty()) return false;
  to.push_back(std::exchange(board, std::move(from.back())));
  from.pop_back();
  return true;
}

}  // namespace

void LightHistory::note(const LightBoard& before, bool changed, bool held) {
  if (changed && !within_change_) {
    constexpr std::size_t kept = 100;  // of hundreds of lamps, a few megabytes
    if (undone_to_.size() == kept) undone_to_.pop_front();
    undone_to_.push_back(before);
    redone_to_.clear();
  }
  within_change_ = held && (changed || within_change_);
}

bool LightHistory::undo(LightBoard& board) { return exchange(board, undone_to_, redone_to_); }

bool LightHistory::redo(LightBoard& board) { return exchange(board, redone_to_, undone_to_); }

}  // namespace photile::view
