// Scenes made in memory.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "photile/scene.hpp"

namespace photile {

/// The triangles of a mesh, in arrays that the caller owns. Arrays per vertex are empty or as long
/// as `vertices`, arrays per triangle empty or as long as `triangles`.
struct MeshArrays {
  std::span<const glm::vec3> vertices;    ///< metres
  std::span<const glm::uvec3> triangles;  ///< vertices, counter-clockwise as seen from the front

  std::span<const glm::vec3> normals = {};      ///< per vertex, any length; zero = flat
  std::span<const glm::vec2> uv = {};           ///< per vertex, of Material's textures
  std::span<const glm::vec2> emission_uv = {};  ///< per vertex, of Light::emission_texture
  std::span<const glm::vec4> tangents = {};     ///< per vertex, as in glTF: w is the handedness

  std::span<const std::uint32_t> materials = {};  ///< per triangle; empty: all have `material`
  std::span<const std::uint32_t> lights = {};     ///< per triangle; empty: all have `light`
  std::uint32_t material = 0;                     ///< of SceneBuilder::add
  std::uint32_t light = none;                     ///< an area light of SceneBuilder::add, or none
};

/// Makes a Scene that every stage can trust: vertices welded, corners in canonical order, all of
/// its arrays filled. What an object refers to (materials, textures, lights) is added before it.
/// Errors: InputError, one line that names the scene, the object and what is wrong with it.
class SceneBuilder {
 public:
  explicit SceneBuilder(std::string name = "scene in memory", PowerUnit unit = PowerUnit::lumen);
  ~SceneBuilder();
  SceneBuilder(SceneBuilder&&) noexcept;
  SceneBuilder& operator=(SceneBuilder&&) noexcept;

  // Each returns the index by which other objects refer to it.
  std::uint32_t add(Material material);
  std::uint32_t add(const MetallicRoughness& model);
  std::uint32_t add(Texture texture);
  std::uint32_t add(IntensityDistribution distribution);
  /// An area, point or spot light with the power `light.power`, in the unit of the scene. The
  /// triangles of an area light are added later, with its meshes. `color` may have any luminance
  /// above 0, directions any length. With an emission texture, `color` is the tint of its texels.
  std::uint32_t add(Light light);
  /// A directional light that makes `irradiance` (lux or W/m2) on a surface that faces it.
  std::uint32_t add_distant(Light light, double irradiance);
  /// Light from all around.
  std::uint32_t add_surroundings(std::string name, EnvironmentMap map);
  void add(Camera camera);

  /// Adds the triangles of a mesh. Those without area, and those that coincide with others, are
  /// counted in Scene::report and left out. Returns each triangle's number in the scene, `none`
  /// where it was left out.
  std::vector<std::uint32_t> add(const MeshArrays& mesh);

  /// One triangle, counter-clockwise as seen from its front; its number, or `none`.
  std::uint32_t triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                         std::uint32_t material, std::uint32_t light = none);
  /// Two triangles: a, b, c and a, c, d.
  void quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d,
            std::uint32_t material, std::uint32_t light = none);
  /// The parallelogram from `origin` along two edges, cut into cells x cells quads. Its front is on
  /// the side of u x v.
  void grid(const glm::vec3& origin, const glm::vec3& u, const glm::vec3& v, int cells,
            std::uint32_t material, std::uint32_t light = none);
  /// A box along the axes with cells x cells quads a face. Fronts look into the box if `inwards`.
  void box(const glm::vec3& low, const glm::vec3& high, std::uint32_t material, bool inwards,
           int cells = 1, std::uint32_t light = none);

  /// The scene so far, with a camera that shows it where none was added. Names of lights become
  /// unique and fit for layers of a picture. Errors: InputError without triangles, for an area
  /// light without any, and for light that is not finite.
  Scene build() const&;
  Scene build() &&;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Refuses a scene that later stages could not trust: arrays of wrong lengths, numbers out of
/// range, NaN. Every stage that takes a scene calls this; scenes from load_scene and SceneBuilder
/// pass. Errors: InputError.
void check_scene(const Scene& scene);

}  // namespace photile
