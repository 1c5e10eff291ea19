// The kernels' own arctangent and logarithm against the host's in double precision.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "device/launch.hpp"
#include "device/program_source.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

/// The values of a call, of eight at a time, at x[i] and y[i].
std::vector<float> values_of(const std::string& name, const std::string& call,
                             const std::vector<float>& x, const std::vector<float>& y) {
  const std::string file = "test/" + name + ".cl";
  device::register_kernel_source(
      file, "#include \"shared/" + name +
                ".clh\"\n__kernel void values(__global const float* x, __global const float* y,\n"
                "__global float* value) { const size_t i = get_global_id(0); vstore8(" +
                call + ", i, value); }\n");
  device::Context& context = device::context_of(device());
  const auto x_buffer = context.upload(std::span<const float>(x), "x");
  const auto y_buffer = context.upload(std::span<const float>(y), "y");
  const auto value_buffer = context.allocate<float>(x.size(), "values");
  device::Launch(context, context.kernel(file, "values", {}))
      .set("x", x_buffer)
      .set("y", y_buffer)
      .set("value", value_buffer)
      .run_no_more(x.size() / 8, 1);
  std::vector<float> values(x.size());
  context.read(value_buffer, std::span(values));
  return values;
}

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
  const std::vector<float> angle =
      values_of("arctangent", "arctangent8(vload8(i, y), vload8(i, x))", x, y);
  CHECK(angle[0] == 0.0f);
  double worst = 0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    worst = std::max(worst, std::abs(angle[i] - std::atan2(double{y[i]}, double{x[i]})));
  }
  CHECK(worst < 3e-7);
}

TEST_CASE("the kernels' logarithm is right to 2e-7 of itself or of 1 for all normal floats") {
  std::vector<float> x{1.0f, 0.5f, 2.0f, 0.70710678f, 0.7071068f, 1.41421356f, 1.2e-38f, 3e38f};
  std::mt19937 random(3);
  std::uniform_real_distribution<float> exponent(-125.0f, 127.0f), near_one(-1e-2f, 1e-2f);
  while (x.size() < 80'000) {
    x.push_back(std::exp2(exponent(random)));
    x.push_back(1 + near_one(random));
  }
  const std::vector<float> logarithm = values_of("logarithm", "logarithm8(vload8(i, x))", x, x);
  CHECK(logarithm[0] == 0.0f);
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double truth = std::log(double{x[i]});
    worst = std::max(worst, std::abs(logarithm[i] - truth) / std::max(1.0, std::abs(truth)));
  }
  CHECK(worst < 2e-7);
}

}  // namespace photile::test
