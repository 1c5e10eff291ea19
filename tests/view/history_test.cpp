// Changes of lamps, taken back and made again.
#include <catch2/catch.hpp>

#include "two_lights.hpp"
#include "view/light_board.hpp"
#include "view/settings_history.hpp"

namespace photile::test {
namespace {

struct Subject {
  view::LightBoard board{two_lights("ceiling", 100, "desk", 300)};
  view::History<view::LightBoard> history;

  void set(double power, bool held = false) {
    const view::LightBoard before = board;
    board.controls()[0].power = power;
    history.note(before, true, held);
  }
  double power() const { return board.controls()[0].power; }
};

}  // namespace

TEST_CASE("changes of lamps are taken back one by one, and made again") {
  Subject subject;
  CHECK_FALSE(subject.history.undo(subject.board));
  subject.set(50);
  subject.set(20);
  CHECK(subject.history.undo(subject.board));
  CHECK(subject.power() == 50);
  CHECK(subject.history.undo(subject.board));
  CHECK(subject.power() == 100);
  CHECK_FALSE(subject.history.undo(subject.board));
  CHECK(subject.history.redo(subject.board));
  CHECK(subject.power() == 50);
  CHECK(subject.history.redo(subject.board));
  CHECK(subject.power() == 20);
  CHECK_FALSE(subject.history.redo(subject.board));
}

TEST_CASE("a slider that is held makes one change, and a new change ends what could be redone") {
  Subject subject;
  for (const double power : {90, 80, 70}) subject.set(power, true);
  subject.history.note(subject.board, false, true);
  subject.set(60, true);
  subject.history.note(subject.board, false, false);
  subject.set(10);
  CHECK(subject.history.undo(subject.board));
  CHECK(subject.power() == 60);
  CHECK(subject.history.undo(subject.board));
  CHECK(subject.power() == 100);
  subject.set(5);
  CHECK_FALSE(subject.history.redo(subject.board));
}

}  // namespace photile::test
