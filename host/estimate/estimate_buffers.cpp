#include "estimate/estimate_buffers.hpp"

#include "estimate/light_sums.hpp"
#include "maps/map_store.hpp"
#include "maps/prefix_sum.hpp"

namespace photile::estimate {
namespace {

/// What the buffer holds, 3 floats an element.
std::vector<glm::vec3> read_vectors(device::Context& context, const device::Buffer<float>& buffer) {
  std::vector<glm::vec3> values(buffer.size() / 3);
  if (!values.empty()) context.read(buffer, std::span(&values[0].x, buffer.size()));
  return values;
}

}  // namespace

EstimateBytes estimate_bytes_per_hit(const SceneNeeds& needs, std::uint32_t neighbours) {
  const std::uint64_t estimates = estimates_per_hit(needs, neighbours);
  const std::uint64_t largest = estimates * 3 * sizeof(float);
  std::uint64_t together = needs.glossy ? 2 * largest : largest;
  if (needs.many_lights()) together += estimates * sizeof(std::uint16_t) + sizeof(std::uint32_t);
  return {largest, together};
}

EstimateBuffers::EstimateBuffers(device::Context& context, const SceneNeeds& needs,
                                 std::uint32_t neighbours, std::uint32_t hits)
    : context_(context), needs_(needs), hits_(hits), slots_(estimates_per_hit(needs, neighbours)) {
  const std::size_t estimates = std::size_t{hits} * slots_;
  irradiance = context.allocate<float>(3 * estimates, "irradiance estimates");
  radiance = context.allocate<float>(needs.glossy ? 3 * estimates : 0, "radiance estimates");
  if (needs.many_lights()) {
    slot_light = context.allocate<std::uint16_t>(estimates, "lights of estimates");
    slots_taken = context.allocate<std::uint32_t>(std::size_t{hits} + 1, "lights per hit");
    context.fill(slots_taken, 0u);
  } else {
    context.fill(irradiance, 0.0f);
    context.fill(radiance, 0.0f);
  }
}

Estimates EstimateBuffers::read() {
  if (needs_.many_lights()) return read_slots();
  Estimates estimates;
  estimates.irradiance = read_vectors(context_, irradiance);
  estimates.radiance = read_vectors(context_, radiance);
  return estimates;
}

/// Takes the empty slots out on the device: it is fast there, and less is read.
Estimates EstimateBuffers::read_slots() {
  device::Defines defines;
  defines.set("LIGHT_SLOTS", static_cast<long long>(slots_));
  if (needs_.glossy) defines.set("GLOSSY");
  const device::KernelSet kernels(context_, "estimate/pack_estimates.cl", std::move(defines));
  auto first = context_.allocate<std::uint32_t>(std::size_t{hits_} + 1, "first estimates of hits");
  maps::exclusive_prefix_sum(kernels, slots_taken, first);
  std::vector<std::uint32_t> offsets(std::size_t{hits_} + 1);
  context_.read(first, std::span(offsets));

  const std::size_t total = offsets.back();
  auto light = context_.allocate<std::uint16_t>(total, "lights of estimates");
  auto packed_irradiance = context_.allocate<float>(3 * total, "irradiance estimates");
  auto packed_radiance =
      context_.allocate<float>(needs_.glossy ? 3 * total : 0, "radiance estimates");
  const auto launch = [&](const auto&... glossy) {
    kernels.run("pack_estimates", hits_, maps::work_group_size, hits_, first, slot_light,
                irradiance, light, packed_irradiance, glossy...);
  };
  if (needs_.glossy) {
    launch(radiance, packed_radiance);
  } else {
    launch();
  }

  Estimates estimates;
  estimates.first.assign(offsets.begin(), offsets.end());
  estimates.light.resize(total);
  if (total > 0) context_.read(light, std::span(estimates.light));
  estimates.irradiance = read_vectors(context_, packed_irradiance);
  estimates.radiance = read_vectors(context_, packed_radiance);
  return estimates;
}

}  // namespace photile::estimate
