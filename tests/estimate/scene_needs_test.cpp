// What a scene does not need is not there: no bytes in its records, no text in its kernels.
#include "photile/scene_needs.hpp"

#include <fmt/format.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>
#include <memory>
#include <regex>

#include "device/program_source.hpp"
#include "estimate/specialisation.hpp"
#include "maps/entry_defines.hpp"
#include "maps/map_store.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photon_tracer.hpp"
#include "photile/primary_hits.hpp"
#include "temporary_folder.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

/// A closed box with point lights, whose kind follows from the needs.
Scene box_of(const SceneNeeds& needs) {
  Scene scene = test::closed_box(needs.glossy ? test::glossy(glm::vec3(0.5f), glm::vec3(0.2f), 0.4f)
                                              : test::diffuse(glm::vec3(0.5f)));
  for (std::uint32_t i = 1; i < needs.light_count; ++i) {
    scene.lights.push_back(test::point_light(fmt::format("lamp {}", i), {0.5f, 0.4f, 0.6f}));
  }
  return scene;
}

/// Bytes that a reference takes in the buffers of a page.
std::size_t bytes_per_reference(const maps::MapPage& page) {
  const auto planes = [&](const device::Buffer<float>& buffer) {
    return buffer.size() * sizeof(float) / page.entry_stride;
  };
  return planes(page.entry_position) + planes(page.entry_flux) + planes(page.entry_incoming) +
         planes(page.entry_normal) + page.entry_light.size() / page.entry_stride +
         page.entry_photon.size() * sizeof(std::uint32_t) / page.entry_count;
}

/// A kernel file as a runtime's compiler sees it: its includes, then the C preprocessor.
std::string preprocessed(const std::string& file, const device::Defines& defines) {
  const TemporaryFolder folder;
  const std::filesystem::path source = folder.path / "kernel.c";
  std::ofstream(source) << device::assemble_source(file);
  const std::string command = fmt::format("'{}' -E -P -x c -D __OPENCL_VERSION__=120 {} '{}'",
                                          PHOTILE_C_COMPILER, defines.options(), source.string());
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
  REQUIRE(pipe != nullptr);
  std::string text;
  std::array<char, 4096> part{};
  while (const std::size_t read = std::fread(part.data(), 1, part.size(), pipe.get())) {
    text.append(part.data(), read);
  }
  REQUIRE(text.find("__kernel") != std::string::npos);
  return text;
}

bool has_word(const std::string& text, const std::string& word) {
  return std::regex_search(text, std::regex("\\b" + word + "\\b"));
}

/// Which of the words the text has, as "all" or "none", or those that are there.
std::string found(const std::string& text, const std::vector<std::string>& words) {
  std::vector<std::string> there;
  for (const std::string& word : words) {
    if (has_word(text, word)) there.push_back(word);
  }
  if (there.empty()) return "none";
  if (there.size() == words.size()) return "all";
  return fmt::format("{}", fmt::join(there, " "));
}

constexpr SceneNeeds diffuse_of(std::uint32_t lights) { return {.light_count = lights}; }
constexpr SceneNeeds glossy_of(std::uint32_t lights) {
  return {.glossy = true, .light_count = lights};
}

}  // namespace

TEST_CASE("a diffuse scene of one light has the smallest records, others what they need more",
          "[needs]") {
  // The table of docs/kernels.md, "Records".
  const auto [needs, bytes] = GENERATE(table<SceneNeeds, std::size_t>({
      {diffuse_of(1), 28},
      {diffuse_of(2), 29},
      {diffuse_of(300), 30},
      {glossy_of(1), 40},
      {glossy_of(2), 41},
      {glossy_of(300), 42},
  }));
  CAPTURE(needs.glossy, needs.light_count);
  const Scene scene = box_of(needs);
  const RayScene rays(scene);
  CHECK(rays.needs().glossy == needs.glossy);
  CHECK(rays.needs().light_count == needs.light_count);
  CHECK(maps::bytes_per_entry(rays.needs()) == bytes);

  const Photons photons = trace_photons(rays, {.emitted_photons = 3000}).photons;
  REQUIRE(photons.size() > 1000);
  CHECK(photons.incoming.size() == (needs.glossy ? photons.size() : 0));
  CHECK(photons.light.size() == (needs.light_count > 1 ? photons.size() : 0));

  Device device;
  const PhotonMaps maps(device, scene, photons,
                        find_map_groups(scene, photons, MapMode::triangle, {0.2}), {.radius = 0.2});
  for (std::size_t i = 0; i < maps::store_of(maps).pages.size(); ++i) {
    const maps::MapPage& page = maps::store_of(maps).pages.use(i);
    const maps::ResidentMaps::Release release{maps::store_of(maps).pages};
    CHECK(bytes_per_reference(page) == bytes);
  }

  const Camera camera =
      Camera::look_at({0.2, 0.2, 0.2}, {0.9, 0.8, 0.7}, {0, 0, 1}, /*field of view*/ 1.0);
  PrimaryHitParameters film;
  film.width = film.height = 8;
  const PrimaryHits hits = trace_primary_hits(rays, camera, film, 0, 8).hits;
  REQUIRE(hits.size() > 0);
  CHECK(hits.outgoing.size() == (needs.glossy ? hits.size() : 0));
  CHECK(hits.lobe.size() == (needs.glossy ? hits.size() : 0));
}

TEST_CASE("kernels hold no text of lobes or lights that the scene does not have", "[needs]") {
  const std::vector<std::string> glossy_words{"entry_incoming", "hit_outgoing", "hit_normal",
                                              "radiance"};
  const std::vector<std::string> light_words{"entry_light"};
  const std::vector<std::string> many_words{"slot_light", "slots_taken"};
  for (const EstimateStrategy strategy : all_estimate_strategies) {
    const bool lanes = strategy == EstimateStrategy::lanes;
    for (const SceneNeeds& needs : {diffuse_of(1), diffuse_of(5), diffuse_of(300), glossy_of(1),
                                    glossy_of(5), glossy_of(300)}) {
      const estimate::Specialisation choice =
          estimate::specialise({.strategy = strategy, .vector_width = lanes ? 32 : 1}, needs, 50);
      CAPTURE(lanes, needs.glossy, needs.light_count);
      const std::string text = preprocessed("estimate/estimate.cl", choice.defines());
      CHECK(found(text, glossy_words) == (needs.glossy ? "all" : "none"));
      CHECK(found(text, light_words) == (needs.several_lights() ? "all" : "none"));
      CHECK(found(text, many_words) == (needs.many_lights() ? "all" : "none"));
    }
  }
}

TEST_CASE("kernels that build maps copy what the scene's records hold, and no more", "[needs]") {
  for (const SceneNeeds& needs : {diffuse_of(1), diffuse_of(5), glossy_of(1), glossy_of(5)}) {
    CAPTURE(needs.glossy, needs.light_count);
    device::Defines defines;
    maps::set_entry_defines(defines, needs);
    const std::string text = preprocessed("grid/build.cl", defines);
    CHECK(found(text, {"incoming", "entry_incoming"}) == (needs.glossy ? "all" : "none"));
    CHECK(found(text, {"light", "entry_light"}) == (needs.several_lights() ? "all" : "none"));
  }
}

TEST_CASE("only what triangles have is needed: unused materials ask for nothing", "[needs]") {
  Scene scene = test::closed_box(test::diffuse(glm::vec3(0.5f)));
  scene.materials.push_back(test::glossy(glm::vec3(0.5f), glm::vec3(0.5f), 0.3f));
  scene.materials.push_back(test::glass(1.5f, /*thin=*/true));
  scene.materials.push_back(test::mirror(glm::vec3(0.9f)));
  const auto needs_with = [&](std::uint32_t material) {
    scene.triangle_material[0] = material;
    return RayScene(scene).needs();
  };
  const SceneNeeds none = needs_with(0);
  CHECK_FALSE((none.glossy || none.textures || none.specular_paths || none.see_through));
  CHECK(none.light_count == 1);
  CHECK(needs_with(1).glossy);
  CHECK_FALSE(needs_with(1).specular_paths);
  CHECK((needs_with(2).see_through && needs_with(2).specular_paths));
  CHECK((!needs_with(3).see_through && needs_with(3).specular_paths));
}

}  // namespace photile::test
