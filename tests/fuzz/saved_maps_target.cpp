// Saved maps. Their digests would refuse nearly all that a fuzzer changes, so that the target puts
// them right: what is behind them is read as if a program had written it.
#include <array>
#include <cstring>
#include <vector>

#include "cache/light_maps.hpp"
#include "common/content_hash.hpp"
#include "fuzz_files.hpp"
#include "saved_maps/saved_maps.hpp"
#include "scene/scene_queries.hpp"

namespace photile::test {
namespace {

/// The head as docs/reference/saved-maps.md has it: 104 bytes.
struct Head {
  std::array<char, 8> magic;
  std::uint32_t version, byte_order;
  ContentHash::Digest scene;
  std::array<std::uint32_t, 2> whole;
  std::uint64_t photon_bytes;
  ContentHash::Digest photons;
  std::uint64_t light_map_bytes;
  ContentHash::Digest light_maps, head;
};
static_assert(sizeof(Head) == 104);

const saved_maps::Settings words{"words", ""};

const Scene& floor_scene() {
  static const Scene scene = lit_floor();
  return scene;
}

ContentHash::Digest digest_of(Bytes bytes) {
  ContentHash hash;
  hash.add_bytes(bytes.data(), bytes.size());
  return hash.digest();
}

/// The file with the digests of what it holds, and with lengths that fit.
std::vector<unsigned char> sealed(Bytes bytes) {
  std::vector<unsigned char> file(bytes.begin(), bytes.end());
  if (file.size() < sizeof(Head)) return file;
  Head head;
  std::memcpy(&head, file.data(), sizeof head);
  const std::uint64_t body = file.size() - sizeof head;
  head.photon_bytes = std::min(head.photon_bytes, body);
  head.light_map_bytes = body - head.photon_bytes;
  ContentHash scene;
  scene::add_scene(floor_scene(), scene);
  head.scene = scene.digest();
  const Bytes parts = Bytes(file).subspan(sizeof head);
  head.photons = digest_of(parts.first(head.photon_bytes));
  head.light_maps = digest_of(parts.subspan(head.photon_bytes));
  std::memcpy(file.data(), &head, sizeof head);
  head.head = digest_of(Bytes(file).first(sizeof head - sizeof head.head));
  std::memcpy(file.data(), &head, sizeof head);
  return file;
}

/// Takes light maps in, as a render does, and looks something up in them.
void use_light_maps(LightMapContents contents) {
  cache::LightMapParameters parameters;
  parameters.spacing = 0.25;
  parameters.levels = 3;
  parameters.powers = {1.0};
  struct : cache::NodeSource {  // what is taken in needs no source
    cache::NodeValues value(const cache::NodeBatch&, const Progress&) override { return {}; }
  } no_source;
  static const RayScene rays(floor_scene());
  cache::LightMaps maps(rays, parameters, no_source);
  maps.restore(std::move(contents));
  for (const float x : {0.0f, 0.3f, 1.0f}) {
    cache::BilinearWeights blend{};
    if (!maps.find(0, {x, 0.5f * x, 0}, blend)) continue;
    for (const std::uint32_t node : blend.node) {
      require(node < maps.values().irradiance.size(), "a node that is not there");
    }
    require(maps.relative_error(blend) >= 0, "an error that is no number");
  }
  const std::vector<std::uint8_t> all(maps.statistics().nodes, 1);
  maps.forget(all);
}

}  // namespace

bool fuzz_saved_maps(Bytes bytes) {
  const auto file = file_of("room.maps", sealed(bytes));
  return accepts([&] {
    TracedPhotons photons = saved_maps::load(file, floor_scene(), words);
    require(photons.photons.first_of.size() == 2 * floor_scene().triangle_count() + 1,
            "rows that lack");
    // What was read can be written, and read again.
    const auto again = file.parent_path() / "again.maps";
    saved_maps::save(again, floor_scene(), words, photons);
    if (photons.light_maps) saved_maps::add_light_maps(again, *photons.light_maps);
    const TracedPhotons same = saved_maps::load(again, floor_scene(), words);
    require(same.photons.size() == photons.photons.size() && same.radius == photons.radius,
            "saved again they are others");
    if (photons.light_maps) use_light_maps(std::move(*photons.light_maps));
  });
}

}  // namespace photile::test
