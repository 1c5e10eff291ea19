// The kernels' own logarithm against the host's in double precision.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "device/launch.hpp"
#include "device/program_source.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

constexpr const char* logarithm_source = R"(
#include "shared/logarithm.clh"
__kernel void logarithms(__global const float* x, __global float* logarithm) {
  const size_t i = get_global_id(0);
  vstore8(logarithm8(vload8(i, x)), i, logarithm);
}
)";

}  // namespace

TEST_CASE("the kernels' logarithm is right to 2e-7 of itself or of 1 for all normal floats") {
  std::vector<float> x{1.0f, 0.5f, 2.0f, 0.70710678f, 0.7071068f, 1.41421356f, 1.2e-38f, 3e38f};
  std::mt19937 random(3);
  std::uniform_real_distribution<float> exponent(-125.0f, 127.0f), near_one(-1e-2f, 1e-2f);
  while (x.size() < 80'000) {
    x.push_back(std::exp2(exponent(random)));
    x.push_back(1 + near_one(random));
  }
  device::register_kernel_source("test/logarithms.cl", logarithm_source);
  device::Context& context = device::context_of(test::device());
  const auto x_buffer = context.upload(std::span<const float>(x), "x");
  const auto buffer = context.allocate<float>(x.size(), "logarithms");
  device::Launch(context, context.kernel("test/logarithms.cl", "logarithms", {}))
      .set("x", x_buffer)
      .set("logarithm", buffer)
      .run_no_more(x.size() / 8, 1);
  std::vector<float> logarithm(x.size());
  context.read(buffer, std::span(logarithm));
  CHECK(logarithm[0] == 0.0f);
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double truth = std::log(double{x[i]});
    worst = std::max(worst, std::abs(logarithm[i] - truth) / std::max(1.0, std::abs(truth)));
  }
  CHECK(worst < 2e-7);
}

}  // namespace photile::test
