// A scene as every later stage sees it: triangles, materials, lights and cameras, validated, in
// metres and linear RGB with Rec.709 primaries.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "photile/camera.hpp"

namespace photile {

/// An equirectangular picture of radiance. Its rows run from the zenith (+y) to the nadir, its
/// columns along the horizon; the middle column lies towards -z, turned by `rotation` towards +x,
/// and azimuths grow to the right, as for an observer inside. Each texel is an even patch of sky,
/// so that integrals over it are exact.
class EnvironmentMap {
 public:
  /// `texels`: width x height, row 0 at the top, linear RGB, finite and not negative.
  /// `rotation`: degrees clockwise as seen from above. Errors: std::invalid_argument.
  EnvironmentMap(std::string name, int width, int height, std::vector<glm::vec3> texels,
                 double rotation = 0);

  /// Radiance that arrives from a unit direction, cd/m2 or W/(m2 sr).
  const glm::vec3& radiance(const glm::vec3& direction) const {
    return texels_[texel_towards(direction)];
  }

  /// Integral of the radiance over the sphere, lm/m2 or W/m2 per channel.
  const glm::dvec3& integral() const { return integral_; }

  /// Solid angle of each texel of a row, steradian.
  double solid_angle(int row) const;
  /// Index of the texel that a unit direction points to.
  std::size_t texel_towards(const glm::vec3& direction) const;
  /// Direction of a point of the picture; `column` in [0, width], and the fraction `v` in [0, 1] of
  /// the solid angle of its row that lies above.
  glm::dvec3 direction_at(double column, int row, double v) const;

  const std::string& name() const { return name_; }
  int width() const { return width_; }
  int height() const { return height_; }
  const glm::vec3& texel(int column, int row) const {
    return texels_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(column)];
  }

 private:
  std::string name_;
  int width_ = 0, height_ = 0;
  double rotation_ = 0;  ///< radians
  std::vector<glm::vec3> texels_;
  glm::dvec3 integral_{0.0};
};

/// Axes of the spherical coordinates in which a luminaire was measured, in its own space: it is
/// aimed along its -z axis, as lights of glTF are.
struct PhotometricAxes {
  glm::dvec3 pole{0.0, 0.0, -1.0};    ///< unit; polar angle 0
  glm::dvec3 zero{1.0, 0.0, 0.0};     ///< unit; polar angle 90 degrees, azimuth 0
  glm::dvec3 quarter{0.0, 1.0, 0.0};  ///< unit; polar angle 90 degrees, azimuth 90 degrees
};

/// The part of a luminaire that shines, as its photometric file gives it, in the luminaire's own
/// space around its origin. All zero where the file says nothing.
struct LuminousOpening {
  /// Which of the three extents are diameters. A cylinder or an ellipsoid of which one extent is 0
  /// is a disc; they are elliptic where their diameters differ.
  enum class Shape { box, upright_cylinder, cylinder_along_x, cylinder_along_y, ellipsoid };

  double x = 0, y = 0;              ///< metres along the axes; of a file of type C, C0 and C90
  std::array<double, 4> heights{};  ///< metres along z, as seen from +x, +y, -x and -y
  Shape shape = Shape::box;

  double height() const { return *std::max_element(heights.begin(), heights.end()); }
  bool stated() const { return x > 0 || y > 0 || height() > 0; }
  /// m2 of its projection onto a plane that faces `direction`.
  ///   direction   unit, in the luminaire's space, away from it
  double projected_area(const glm::dvec3& direction) const;
};

/// The data of a photometric file about its luminaire beside the intensities, in which a list of
/// luminaires may state its own; "" and 0 = not stated.
struct LuminaireData {
  std::string maker, article, luminaire, source;  ///< UTF-8; `source`: the lamps in it
  double watts = 0;                               ///< electrical power that the luminaire draws
  double kelvin = 0;                              ///< correlated colour temperature
  double highest_kelvin = 0;                      ///< where it is tunable from `kelvin` on
  double rendering = 0;                           ///< Ra, at least
  double maintenance = 0;                         ///< maintenance factor, of a list of luminaires
};

/// Intensities on a grid of polar angles and azimuths, bilinear in the two angles between them and
/// zero beyond the outermost. One point emits all light: the luminaire's own size is left out,
/// which is the approximation of the files themselves (far-field photometry).
class IntensityDistribution {
 public:
  /// `polar`, `azimuth`: degrees, strictly ascending, at least two of each; polar angles within
  /// [0, 180], azimuths within 360 degrees. `intensity`: cd, [azimuth][polar], not negative.
  /// Errors: std::invalid_argument.
  IntensityDistribution(std::string name, const PhotometricAxes& axes,
                        const std::vector<double>& polar, const std::vector<double>& azimuth,
                        std::vector<float> intensity);

  /// cd in a unit direction of the luminaire's space.
  double intensity(const glm::dvec3& direction) const;

  /// lm: the integral of `intensity` over the sphere, in closed form.
  double flux() const { return flux_; }

  const std::string& name() const { return name_; }
  const PhotometricAxes& axes() const { return axes_; }

  const LuminousOpening& opening() const { return opening_; }
  void set_opening(const LuminousOpening& opening) { opening_ = opening; }
  const LuminaireData& data() const { return data_; }
  void set_data(LuminaireData data) { data_ = std::move(data); }
  /// The watts that the luminaire draws for this many lumens, in proportion; 0
  /// where its file does not state them.
  double electrical_watts(double lumens) const { return data_.watts * lumens / flux_; }

  // Cells of the grid: column of azimuths x row of polar angles.
  std::size_t columns() const { return azimuth_.size() - 1; }
  std::size_t rows() const { return polar_.size() - 1; }
  /// lm that a cell emits.
  double cell_flux(std::size_t column, std::size_t row) const;

  /// A point in a cell; `u` of the way from its first azimuth to its last, `v` of the way between
  /// the cosines of its polar angles, each in [0, 1].
  struct Sample {
    glm::dvec3 direction;  ///< unit, in the luminaire's space
    double intensity;      ///< cd
  };
  Sample in_cell(std::size_t column, std::size_t row, double u, double v) const;
  /// Largest intensity in a cell, cd.
  double cell_maximum(std::size_t column, std::size_t row) const;

 private:
  double at(std::size_t column, std::size_t row) const {
    return intensity_[column * polar_.size() + row];
  }
  double interpolated(std::size_t column, std::size_t row, double azimuth, double polar) const;

  std::string name_;
  PhotometricAxes axes_;
  std::vector<double> polar_, azimuth_;  ///< radians
  std::vector<float> intensity_;
  LuminousOpening opening_;
  LuminaireData data_;
  double flux_ = 0;
};

inline constexpr std::uint32_t none = 0xFFFF'FFFFu;  ///< "no light", "no texture", ...

/// Relative luminance of linear Rec.709 RGB.
inline double luminance(const glm::dvec3& rgb) {
  return 0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b;
}

/// The units of light powers and radiances in the scene.
enum class PowerUnit {
  lumen,  ///< photometric (glTF): powers in lm, picture in cd/m2
  watt    ///< radiometric (OBJ): powers in W, picture in W/(m2 sr)
};
inline const char* symbol_of(PowerUnit unit) { return unit == PowerUnit::lumen ? "lm" : "W"; }

/// A picture used as a texture: four bytes a texel, which are sRGB where they are a colour.
class Texture {
 public:
  Texture() = default;
  /// `texels`: width x height, row 0 at the top, RGBA.
  Texture(std::string name, int width, int height, std::vector<std::array<std::uint8_t, 4>> texels);

  /// Bilinear lookup of linear RGB. `uv` (0,0) is the top left corner of the picture, as in glTF;
  /// it repeats outside [0,1).
  glm::vec3 sample(glm::vec2 uv) const;

  /// The texel from the bytes as they are, RGBA in [0,1]: alpha, normals and factors are not
  /// colours.
  glm::vec4 sample_data(glm::vec2 uv) const;

  /// Whether every alpha is 1.
  bool opaque() const;

  const std::string& name() const { return name_; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  std::string name_;
  int width_ = 0, height_ = 0;
  std::vector<std::array<std::uint8_t, 4>> texels_;
};

/// How a surface scatters. Each material has one interaction; `opaque` may have two lobes.
enum class Interaction : std::uint8_t {
  opaque,  ///< Lambertian lobe plus, where `specular` is not black, a GGX lobe; photons are stored
  mirror,  ///< perfect mirror with reflectance `specular`; nothing is stored
  glass    ///< smooth dielectric: Fresnel reflection and refraction; nothing is stored
};

/// The metallic-roughness model of glTF 2.0 with KHR_materials_ior and KHR_materials_specular,
/// whose factors textures may multiply.
struct MetallicRoughness {
  glm::dvec3 base_color{1.0};  ///< multiplied by Material::diffuse_texture
  double metallic = 1.0;
  double roughness = 1.0;                 ///< perceptual: the square root of GGX alpha
  double index_of_refraction = 1.5;       ///< KHR_materials_ior
  double specular_factor = 1.0;           ///< KHR_materials_specular
  glm::dvec3 specular_color{1.0};         ///< KHR_materials_specular
  std::uint32_t texture = none;           ///< roughness in its green, metallic in its blue channel
  std::uint32_t specular_texture = none;  ///< the specular factor in its alpha channel
  std::uint32_t specular_color_texture = none;
};

/// Reflection of one surface; the same on both of its sides. All textures of a material share the
/// coordinates in Scene::corner_uv.
struct Material {
  std::string name;
  Interaction interaction = Interaction::opaque;
  glm::vec3 diffuse{0.0f};  ///< Lambertian albedo in [0,1], multiplied by the texture
  std::uint32_t diffuse_texture = none;
  glm::vec3 specular{0.0f};  ///< reflectance at normal incidence, F0; black = no specular lobe
  float f90 = 1.0f;          ///< reflectance of the specular lobe at grazing incidence
  /// GGX alpha in [PHOTILE_MIN_GGX_ALPHA, 1]; only where `specular` is not black.
  float roughness = 1.0f;
  glm::vec3 transmission{1.0f};  ///< colour of what passes a glass surface
  float index_of_refraction = 1.5f;
  bool thin = false;  ///< glass without volume: refraction does not bend the ray
  /// Into Scene::metallic_roughness where textures vary more than the diffuse part, or a metal's
  /// reflectance; `diffuse`, `specular` and `roughness` are then those of white texels.
  std::uint32_t metallic_roughness = none;

  /// Fraction of the surface that is present, multiplied by the alpha of a texture.
  float opacity = 1.0f;
  std::uint32_t opacity_texture = none;
  /// If above 0, the surface is present where its opacity is at least this, and absent elsewhere.
  float opacity_cutoff = 0.0f;

  /// Tangent space normals, red along u, green along -v, blue along the shading normal; or none.
  std::uint32_t normal_texture = none;
  float normal_scale = 1.0f;  ///< of red and green

  bool glossy() const { return interaction == Interaction::opaque && specular != glm::vec3(0.0f); }
  bool has_cutouts() const { return opacity < 1.0f || opacity_texture != none; }
  bool textured() const {
    return diffuse_texture != none || metallic_roughness != none || opacity_texture != none ||
           normal_texture != none;
  }
};

enum class LightKind : std::uint8_t { area, point, spot, directional, environment };

/// "area", "point", "spot", "directional", "environment".
std::string_view name_of(LightKind kind);
inline constexpr std::array all_light_kinds = {LightKind::area, LightKind::point, LightKind::spot,
                                               LightKind::directional, LightKind::environment};

/// A light. Its photons carry `color` with luminance 1, so that `power` alone scales its layer.
struct Light {
  std::string name;   ///< unique; no dots; at most limits::max_light_name_bytes bytes
  std::string group;  ///< as LightGroups; "" = its own layer
  LightKind kind = LightKind::area;
  glm::vec3 color{1.0f};  ///< linear RGB scaled to luminance 1; of a picture: that of its mean
  /// Emitted flux in `Scene::unit`s (luminance-weighted). For directional lights and environments:
  /// the flux that crosses discs of the radius of `bounding_sphere`, each facing its direction.
  double power = 0;

  // Area lights: radiance over the triangles' front sides, or both sides, uniform or textured; with
  // a `distribution` each point emits its part of the intensities, so that radiance depends on the
  // direction.
  std::vector<std::uint32_t> triangles;
  bool two_sided = false;
  std::uint32_t emission_texture = none;
  /// Where a texture is: radiance of a white texel at power 1, linear RGB.
  glm::vec3 texel_radiance{0.0f};

  // Point, spot and directional lights.
  glm::vec3 position{0.0f};
  glm::vec3 direction{0.0f, 0.0f, -1.0f};  ///< unit, the direction of the emitted light
  float inner_cone_angle = 0.0f;           ///< radians, spot
  float outer_cone_angle = 0.7853982f;     ///< radians, spot
  /// The intensities of a point or area light: an index into Scene::distributions; `none` = the
  /// same intensity, or radiance, everywhere.
  std::uint32_t distribution = none;
  /// Unit, perpendicular to `direction`: the x axis of a light whose -z axis is `direction`.
  glm::vec3 x_axis{1.0f, 0.0f, 0.0f};
  float angular_diameter = 0.0f;  ///< radians, of a directional light's disc; 0 = parallel light
  /// The bounds of a directional light that is an even patch of the sky in place of a disc:
  /// its first and last azimuth, radians clockwise from -z as seen from above, and the sines of its
  /// lowest and highest elevation. All 0 = none.
  glm::vec4 sky_patch{0.0f};

  std::uint32_t environment = none;  ///< of an environment light: into Scene::environments

  /// Whether all of the light comes from `position`.
  bool has_position() const { return kind == LightKind::point || kind == LightKind::spot; }
  /// Whether rays can meet the light: a surface, a disc in the sky or surroundings.
  bool has_size() const {
    return kind == LightKind::area || kind == LightKind::environment ||
           (kind == LightKind::directional && (angular_diameter > 0.0f || is_sky_patch()));
  }
  bool is_sky_patch() const { return sky_patch.y > sky_patch.x; }

  /// Whether it lies beyond the scene.
  bool is_distant() const {
    return kind == LightKind::directional || kind == LightKind::environment;
  }
};

/// A rectangle through which light from beyond the scene comes in: a window. Photons and light
/// samples of the sky prefer lines through portals; what is estimated does not depend on them.
struct Portal {
  glm::vec3 corner{0.0f};  ///< metres
  glm::vec3 u{0.0f};       ///< its sides, at a right angle; light comes in along u x v
  glm::vec3 v{0.0f};
};

/// A mesh that the scene repeats at several positions, in its own space around its centre.
struct SharedMesh {
  std::vector<glm::vec3> vertices;
  std::vector<glm::uvec3> triangles;  ///< vertex indices
};

/// Triangles of the scene that are a shared mesh, moved: triangle first_triangle + i is the mesh's
/// triangle i, with its corners in any order.
struct MeshInstance {
  std::uint32_t mesh = 0;            ///< into Scene::shared_meshes
  std::uint32_t first_triangle = 0;  ///< into Scene::triangles
  glm::mat4x3 to_world{1.0f};        ///< metres; a scale along the mesh's axes, then a rotation
};

/// A named part of a file's geometry: a node of glTF that has a mesh, an object or group of OBJ.
struct ImportedMesh {
  std::string name;
  std::uint64_t triangles = 0;  ///< that the scene took
};

/// The messages and counts of the import.
struct ImportReport {
  std::vector<std::string> warnings;       ///< one line each: object, what was found, what was done
  std::uint64_t degenerate_triangles = 0;  ///< zero area; dropped
  std::uint64_t non_finite_triangles = 0;  ///< a corner is NaN, infinite or too far away; dropped
  std::uint64_t duplicate_triangles = 0;   ///< coincide with another; dropped
  std::uint64_t polygons_triangulated = 0;
  std::vector<ImportedMesh> meshes;  ///< in the order of the file
};

/// The geometry is one indexed triangle soup. Corners of a triangle are stored in canonical order
/// (the lexicographically smallest position first, then the smaller of the other two), so that the
/// same mesh with another winding gives the same bits everywhere. `Scene::front_side` keeps the
/// original winding. Side 0 of a triangle is the one that its canonical geometric normal points to.
struct Scene {
  std::filesystem::path source;
  PowerUnit unit = PowerUnit::lumen;

  /// Where (0, 0, 0) of this scene lies in the file's world, metres. The importers read coordinates
  /// in double precision and subtract it before they round them, so that a scene far from the
  /// file's origin loses nothing. Every position below, and in all that is computed from them,
  /// counts from here; reports and pictures name world positions.
  glm::dvec3 origin{0.0};
  /// The rotation by which the file's world was turned so that y points up (SceneLoadOptions::up);
  /// `origin` is in the turned world.
  glm::dmat3 turn{1.0};

  std::vector<glm::vec3> vertices;                  ///< metres
  std::vector<glm::uvec3> triangles;                ///< vertex indices, canonical order
  std::vector<std::uint8_t> front_side;             ///< per triangle: 0 or 1
  std::vector<std::uint32_t> triangle_material;     ///< per triangle
  std::vector<std::uint32_t> triangle_light;        ///< per triangle: area light, or none
  std::vector<std::array<glm::vec2, 3>> corner_uv;  ///< empty when nothing is textured
  /// Coordinates of Light::emission_texture; empty when no light has one.
  std::vector<std::array<glm::vec2, 3>> corner_emission_uv;
  /// Shading normals per corner, on the front side; empty when the file has none, or all are those
  /// of their triangles and no material is specular, glossy or has a normal map. A zero vector
  /// means "use the geometric normal".
  std::vector<std::array<glm::vec3, 3>> corner_normal;
  /// Tangents per corner, of normal maps: unit, the direction of the map's red; w is 1 or -1, and
  /// green lies along w times normal x tangent, with the normal of the front. Empty when no
  /// material has a normal map, or the file has none. Zero means "as the texture's coordinates
  /// run".
  std::vector<std::array<glm::vec4, 3>> corner_tangent;

  /// Repeated meshes, for the ray tracing structure alone: every triangle is in the arrays above.
  /// Instances ascend by first_triangle and do not overlap.
  std::vector<SharedMesh> shared_meshes;
  std::vector<MeshInstance> instances;

  std::vector<Material> materials;
  std::vector<MetallicRoughness> metallic_roughness;
  std::vector<Texture> textures;
  std::vector<Light> lights;
  std::vector<IntensityDistribution> distributions;
  std::vector<EnvironmentMap> environments;
  std::vector<Portal> portals;  ///< at most limits::max_portals
  std::vector<Camera> cameras;  ///< never empty after load_scene
  ImportReport report;

  std::size_t triangle_count() const { return triangles.size(); }
  std::array<glm::vec3, 3> corners(std::size_t triangle) const {
    const glm::uvec3& t = triangles[triangle];
    return {vertices[t.x], vertices[t.y], vertices[t.z]};
  }
};

/// An oriented face is the unit of photon maps: 2 * triangle + side.
inline constexpr std::uint32_t oriented(std::uint32_t triangle, std::uint32_t side) {
  return 2 * triangle + side;
}
inline constexpr std::uint32_t triangle_of(std::uint32_t oriented_face) {
  return oriented_face >> 1;
}
inline constexpr std::uint32_t side_of(std::uint32_t oriented_face) { return oriented_face & 1; }

/// A point, and a direction, of the file's world in the scene's own coordinates, and back.
glm::dvec3 position_in_scene(const Scene& scene, const glm::dvec3& world);
glm::dvec3 position_in_world(const Scene& scene, const glm::dvec3& position);
glm::dvec3 direction_in_scene(const Scene& scene, const glm::dvec3& world);
glm::dvec3 direction_in_world(const Scene& scene, const glm::dvec3& direction);

/// The camera in the file's world, and one of that world in the scene.
Camera in_world(const Scene& scene, Camera camera);
Camera in_scene(const Scene& scene, Camera camera);

/// Unit geometric normal of an oriented face, computed in double precision.
glm::dvec3 face_normal(const Scene& scene, std::uint32_t oriented_face);

/// Area of a triangle in square metres, in double precision.
double triangle_area(const Scene& scene, std::uint32_t triangle);

/// A sphere that encloses the scene: around the centre of its bounding box, through the box's
/// corners. The flux of light from beyond the scene is that through its disc.
struct BoundingSphere {
  glm::dvec3 center{0.0};
  double radius = 0;  ///< metres
};
BoundingSphere bounding_sphere(const Scene& scene);

/// Up to this many layers (see light_layers.hpp) each has a value at every hit and pixel. With
/// more, memory and time grow with the lights that reach a hit, not with all.
inline constexpr std::uint32_t max_dense_lights = 8;

/// The features that later stages must support; those that are false cost nothing. From them follow
/// the records of photons and hits, the buffers of maps and estimates, the symbols that kernels are
/// compiled with, and what shadow rays test (docs/kernels/data.md, "Records").
struct SceneNeeds {
  bool glossy = false;       ///< some opaque material has a specular lobe or a normal map
  bool normal_maps = false;  ///< some opaque material has a normal map
  /// Some opaque surface has a normal map, or vertex normals that differ from its triangles'.
  bool smooth_shading = false;
  bool textures = false;        ///< some material has a texture
  bool specular_paths = false;  ///< some material is a mirror or glass
  bool see_through = false;  ///< some material is thin glass or has cutouts, which shadow rays pass
  std::uint32_t light_count = 0;  ///< layers: a group of lights counts as one

  /// Whether photons and estimates distinguish lights.
  bool several_lights() const { return light_count > 1; }
  /// Whether the reflected radiance at points is stored beside the irradiance, because the two are
  /// not proportional.
  bool tells_radiance() const { return glossy || smooth_shading; }
  /// Whether only the lights that reach a point are kept for it.
  bool many_lights() const { return light_count > max_dense_lights; }
};

/// Visits every triangle: RayScene::needs() and MapStore::needs keep the result. Materials that no
/// triangle has add no needs.
SceneNeeds needs_of(const Scene& scene);

}  // namespace photile
