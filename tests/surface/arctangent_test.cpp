// The kernels' own arctangent against the host's in double precision.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "device/launch.hpp"
#include "device/program_source.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

constexpr const char* arctangent_source = R"(
#include "shared/arctangent.clh"
__kernel void angles(__global const float* y, __global const float* x, __global float* angle) {
  const size_t i = get_global_id(0);
  vstore8(arctangent8(vload8(i, y), vload8(i, x)), i, angle);
}
)";

}  // namespace

TEST_CASE("the kernels' arctangent is right to 3e-7 in every direction, and 0 at the origin") {
  std::vector<float> y{0.0f, 0.0f, 0.0f, 1.0f, -1.0f, 1e-30f, -1e-30f, 1e30f};
  std::vector<float> x{0.0f, 1.0f, -1.0f, 0.0f, 0.0f, -1.0f, -1.0f, 1e-30f};
  std::mt19937 random(3);
  std::uniform_real_distribution<float> direction(-1.0f, 1.0f), exponent(-30.0f, 30.0f);
  while (y.size() < 80'000) {
    const float scale = std::exp2(exponent(random));
    // Near the axes and the diagonals, too.
    const float narrow = std::exp2(-std::abs(exponent(random)));
    y.push_back(scale * narrow * direction(random));
    x.push_back(scale * direction(random));
  }
  device::register_kernel_source("test/angles.cl", arctangent_source);
  device::Context& context = device::context_of(test::device());
  const auto y_buffer = context.upload(std::span<const float>(y), "y");
  const auto x_buffer = context.upload(std::span<const float>(x), "x");
  const auto angle_buffer = context.allocate<float>(y.size(), "angles");
  device::Launch(context, context.kernel("test/angles.cl", "angles", {}))
      .set("y", y_buffer)
      .set("x", x_buffer)
      .set("angle", angle_buffer)
      .run_no_more(y.size() / 8, 1);
  std::vector<float> angle(y.size());
  context.read(angle_buffer, std::span(angle));
  CHECK(angle[0] == 0.0f);
  double worst = 0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    worst = std::max(worst, std::abs(angle[i] - std::atan2(double{y[i]}, double{x[i]})));
  }
  CHECK(worst < 3e-7);
}

}  // namespace photile::test
