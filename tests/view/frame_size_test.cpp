// How large frames are while the viewer moves.
#include <catch2/catch.hpp>

#include "view/frame_worker.hpp"

namespace photile::test {

using photile::view::FrameSize;

TEST_CASE("the first frame is whole, since nothing is known of its cost") {
  CHECK(FrameSize(30).fit(640, 480) == std::pair(640, 480));
}

TEST_CASE("frames shrink in both directions to what their time allows") {
  FrameSize size(10);           // 0.1 s a frame
  size.record(640 * 480, 0.4);  // four times as long
  CHECK(size.fit(640, 480) == std::pair(320, 240));
}

TEST_CASE("frames are never larger than the page, nor smaller than an eighth of it") {
  FrameSize fast(30), slow(30);
  fast.record(640 * 480, 1e-4);
  slow.record(640 * 480, 1e4);
  CHECK(fast.fit(640, 480) == std::pair(640, 480));
  CHECK(slow.fit(640, 480) == std::pair(80, 60));
  CHECK(slow.fit(3, 2) == std::pair(1, 1));
}

TEST_CASE("a cost that changes is followed within ten frames") {
  FrameSize size(10);
  size.record(640 * 480, 10);
  for (int i = 0; i < 10; ++i) size.record(640 * 480, 0.025);
  // 0.7^10 of the first is left: 0.307 s a whole frame, so 0.57 of each side.
  CHECK(size.fit(640, 480).first == Approx(640 * std::sqrt(0.1 / (0.7 * 0 + 10 * std::pow(0.7, 10) +
                                                                  0.025 * (1 - std::pow(0.7, 10)))))
                                        .margin(1));
}

}  // namespace photile::test
