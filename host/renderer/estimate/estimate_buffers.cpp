#include "estimate/estimate_buffers.hpp"

#include <algorithm>
#include <bit>

#include "maps/build_steps.hpp"
#include "maps/map_store.hpp"

namespace photile::estimate {

LightSums::LightSums(const SceneNeeds& needs, std::uint32_t neighbours)
    : lights(needs.light_count),
      many_lights(needs.many_lights()),
      glossy(needs.glossy),
      per_hit(many_lights ? std::min(neighbours, lights) : lights),
      table(many_lights ? std::bit_ceil(std::min(2 * per_hit, lights)) : 0) {}

void LightSums::set_defines(device::Defines& defines) const {
  if (many_lights) {
    defines.set("LIGHT_SLOTS", static_cast<long long>(per_hit));
    defines.set("LIGHT_TABLE", static_cast<long long>(table));
  } else if (lights > 1) {
    defines.set("LIGHT_COUNT", static_cast<long long>(lights));
  }
}

std::size_t LightSums::table_bytes() const { return table * sizeof(std::uint16_t); }

std::size_t LightSums::private_bytes() const {
  if (many_lights) return table_bytes();
  return std::size_t{lights} * 3 * sizeof(float) * (glossy ? 2 : 1);
}

EstimateBytes LightSums::bytes_per_hit() const {
  const std::uint64_t largest = std::uint64_t{per_hit} * 3 * sizeof(float);
  std::uint64_t together = glossy ? 2 * largest : largest;
  if (many_lights) together += per_hit * sizeof(std::uint16_t) + sizeof(std::uint32_t);
  return {largest, together};
}

namespace {

std::span<float> floats_of(std::span<glm::vec3> values) {
  return values.empty() ? std::span<float>() : std::span(&values.front().x, 3 * values.size());
}

}  // namespace

EstimateBuffers::EstimateBuffers(device::Context& context, const LightSums& sums,
                                 LightTable& result, std::size_t first, std::uint32_t hits)
    : context_(context), sums_(sums), result_(result), first_(first), hits_(hits) {
  if (!sums.many_lights) {
    irradiance = context.share_output(part(result.irradiance), "irradiance estimates");
    radiance = context.share_output(part(result.radiance), "radiance estimates");
    return;
  }
  const std::size_t estimates = std::size_t{hits} * sums.per_hit;
  irradiance = context.allocate<float>(3 * estimates, "irradiance estimates");
  radiance = context.allocate<float>(sums.glossy ? 3 * estimates : 0, "radiance estimates");
  slot_light = context.allocate<std::uint16_t>(estimates, "lights of estimates");
  slots_taken = context.allocate<std::uint32_t>(std::size_t{hits} + 1, "lights per hit");
  context.fill(slots_taken, 0u);
}

std::span<float> EstimateBuffers::part(std::vector<glm::vec3>& column) const {
  if (column.empty()) return {};
  return floats_of(
      std::span(column).subspan(first_ * sums_.per_hit, std::size_t{hits_} * sums_.per_hit));
}

void EstimateBuffers::read() {
  if (sums_.many_lights) {
    result_.append(read_slots());
  } else {
    context_.read(irradiance, part(result_.irradiance));
    context_.read(radiance, part(result_.radiance));
  }
}

/// Takes the empty slots out on the device: it is fast there, and less is read.
LightTable EstimateBuffers::read_slots() {
  device::Defines defines = maps::group_defines(context_.info());
  sums_.set_defines(defines);
  if (sums_.glossy) defines.set("GLOSSY");
  const device::KernelSet kernels(context_, "estimate/pack_estimates.cl", std::move(defines));
  auto first = context_.allocate<std::uint32_t>(std::size_t{hits_} + 1, "first estimates of hits");
  maps::exclusive_prefix_sum(kernels, slots_taken, first);
  std::vector<std::uint32_t> offsets(std::size_t{hits_} + 1);
  context_.read(first, std::span(offsets));

  const std::size_t total = offsets.back();
  LightTable estimates(sums_.lights, true);
  estimates.first.assign(offsets.begin(), offsets.end());
  estimates.light.resize(total);
  estimates.irradiance.resize(total);
  estimates.radiance.resize(sums_.glossy ? total : 0);
  const auto light = context_.share_output(std::span(estimates.light), "lights of estimates");
  const auto packed_irradiance =
      context_.share_output(floats_of(estimates.irradiance), "irradiance estimates");
  const auto packed_radiance =
      context_.share_output(floats_of(estimates.radiance), "radiance estimates");
  device::Launch launch = kernels.launch("pack_estimates");
  launch.set("hit_count", hits_)
      .set("first", first)
      .set("slot_light", slot_light)
      .set("slot_irradiance", irradiance)
      .set("slot_radiance", radiance)
      .set("light", light)
      .set("irradiance", packed_irradiance)
      .set("radiance", packed_radiance);
  launch.run(hits_, maps::work_group_size);

  context_.read(light, std::span(estimates.light));
  context_.read(packed_irradiance, floats_of(estimates.irradiance));
  context_.read(packed_radiance, floats_of(estimates.radiance));
  return estimates;
}

}  // namespace photile::estimate
