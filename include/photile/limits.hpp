// Every limit of photile, in one place, each with its reason. A refusal names the limit and the
// value found.
#pragma once

#include <cstddef>
#include <cstdint>

namespace photile::limits {

// Photon counts
inline constexpr std::uint64_t min_photons = 1;
/// Photon indices on the device are 32 bits wide, and the largest one marks "none".
inline constexpr std::uint64_t max_stored_photons = 0xFFFF'FFFEull;
inline constexpr std::uint64_t max_emitted_photons = 10'000'000'000ull;
inline constexpr std::uint32_t max_shards = 1'000'000;  ///< processes that share the paths
/// Each pass traces at least one sample of every pixel.
inline constexpr int max_passes = 65'536;
inline constexpr int max_specular_depth = 1'000'000;  ///< mirrors and glass that a ray follows
inline constexpr int max_neighbours = 1'000'000;      ///< k
inline constexpr int max_direct_rays = 4096;          ///< light samples from a hit
inline constexpr int max_gathering_rays = 4096;  ///< from a point; each has its own random numbers

// Radii of search
/// Metres. The square of a hundred-thousandth of it is a normal float, and so is its inverse.
inline constexpr double min_radius = 1e-13;
/// As a fraction of the scene's diagonal: squares of distances, divided by a hundred-thousandth of
/// the radius, stay within the range of a float.
inline constexpr double min_radius_over_scene = 1e-9;
/// Metres: beyond the largest scene. Its square is within the range of a float.
inline constexpr double max_radius = 1e13;

// Neighbour groups
/// 4 GB of members; a radius as large as the scene would fill any memory.
inline constexpr std::uint64_t max_group_members = 1'000'000'000;

// Light maps
inline constexpr int max_light_map_levels = 12;  ///< of refinement: positions fit 32 bits

// Scene
inline constexpr std::uint64_t max_file_bytes = 2ull << 30;      ///< the scene file itself
inline constexpr std::uint64_t max_external_bytes = 8ull << 30;  ///< buffers and images together
inline constexpr std::uint64_t max_triangles = 500'000'000ull;   ///< oriented faces fit 32 bits
inline constexpr std::uint64_t max_vertices = 0x7FFF'FFFFull;
/// Metres from the scene's origin. Areas times photons, and squares of distances, stay within the
/// range of a float.
inline constexpr double max_coordinate = 1e12;
inline constexpr std::uint64_t max_materials = 100'000;  ///< an empty material takes 2 kB
inline constexpr std::uint64_t max_lights = 10'000;
inline constexpr std::uint64_t max_polygon_corners = 65'536;  ///< triangulated in a second or two
inline constexpr int max_node_depth = 512;
/// Each takes 600 bytes and 2 us before any of its triangles is read.
inline constexpr std::uint64_t max_nodes = 250'000;
/// Instances of nodes beyond their number: shared children multiply. The format has none.
inline constexpr std::uint64_t max_repeated_visits = 100'000;
inline constexpr std::uint64_t max_node_visits = max_nodes + max_repeated_visits;
inline constexpr int max_json_depth = 256;  ///< recursive parsers overflow the stack
/// Triangles that a glTF file may place for each triangle that its buffers and nodes can hold
/// (three bytes, or a node), above a number that is not worth a check: nodes may repeat a mesh, and
/// meshes share buffers, so that a file of kilobytes could ask for any memory.
inline constexpr std::uint64_t max_triangle_expansion = 1'000;
inline constexpr std::uint64_t unchecked_triangles = 1'000'000;

/// Elements of a glTF accessor that has no buffer view: zeros that cost a file nothing.
inline constexpr std::uint64_t max_implicit_elements = 1'000'000;

// Materials
inline constexpr double max_index_of_refraction = 1e6;  ///< F0 is 1 within rounding
inline constexpr double max_normal_scale = 1e6;  ///< bumps are walls then, which floats must hold

// Photometric files (LM-63, EULUMDAT): ten times the finest that goniophotometers write
inline constexpr std::uint64_t max_photometry_bytes = 64ull << 20;
inline constexpr std::uint64_t max_photometric_angles = 20'000;  ///< of either kind
inline constexpr std::uint64_t max_photometric_values = 4'000'000;

// Light
inline constexpr double min_color_temperature = 1'000, max_color_temperature = 40'000;  ///< kelvin
/// Lumens or watts of a light: over any area above a square millimetre, floats hold its radiance.
inline constexpr double max_light_power = 1e30;
/// Lux of a sun or a sky: floats hold the radiance of all of its parts.
inline constexpr double min_illuminance = 1e-30, max_illuminance = 1e30;
inline constexpr double max_irradiance = 10'000;  ///< W/m2 of a sun or a sky; the sun has 1,400
/// Each line of photons and each light sample of the sky is tested against all of them.
inline constexpr std::size_t max_portals = 64;
/// Degrees of a sun's disc: the light of a wider one is that of an environment.
inline constexpr double max_sun_diameter_degrees = 90;

// Pictures
inline constexpr int max_image_side = 16'384;
/// The most texels of all light maps of a page together: 48 MB on the graphics processor.
inline constexpr std::uint64_t max_published_texels = 12'000'000;
inline constexpr std::uint64_t max_image_pixels = 268'435'456;
inline constexpr int max_cube_map_side = max_image_side / 4;  ///< of a face: four of them go around
inline constexpr int max_image_channels = 1'024;              ///< of a picture in memory
/// The most channels of an EXR in a single part, which every program reads. OpenEXR compresses
/// blocks of 16 rows of a part, two for each thread: with more lights they would take as much
/// memory as the picture, and from 1,024 channels on other programs refuse the file.
inline constexpr std::size_t max_single_part_lights = 64;
/// The most channels of a picture that is read a few rows at a time: a root and all lights.
inline constexpr std::size_t max_layered_channels = 4 + 4 * max_lights;
inline constexpr std::uint64_t max_image_bytes = 4ull << 30;  ///< decoded
/// Decoded bytes for each encoded one, in pictures above the size that is not worth a check: a
/// picture of a few kilobytes must not fill the memory.
inline constexpr std::uint64_t max_image_expansion = 1'000;
inline constexpr std::uint64_t unchecked_image_bytes = 64ull << 20;
/// Pixels of an EXR above that size for each encoded byte. The noise of photons takes 20 bytes a
/// pixel and more: in such a picture one pixel in 300 would show something.
inline constexpr std::uint64_t max_exr_pixels_per_byte = 16;
/// A tile or a strip of rows, decoded, of which a decoder keeps some at a time.
inline constexpr std::uint64_t max_image_block_bytes = 256ull << 20;
inline constexpr int max_samples_per_pixel = 65'536;

/// Beyond, 2^stops times a bright pixel leaves the range of a float.
inline constexpr double max_exposure_stops = 64;

/// The most bytes of a text beside the scene: points, planes, camera paths, moods.
inline constexpr std::uint64_t max_input_text_bytes = 256ull << 20;

// Measuring
inline constexpr std::uint64_t max_sensors = 1'000'000;
inline constexpr std::size_t max_outline_corners = 1'000;  ///< each point is compared with each
/// Hours times points of a year of daylight: 4 bytes each, twice.
inline constexpr std::uint64_t max_profile_values = 250'000'000;
inline constexpr int max_repeats = 1'000;  ///< each traces its own photons

// Walks
inline constexpr int max_frames = 1'000'000;

// Host
inline constexpr int max_threads = 1'024;  ///< each costs a stack; no machine has more cores

// Names
/// Blender keeps pass names in 64 bytes, "Combined_" included.
inline constexpr int max_light_name_bytes = 50;

}  // namespace photile::limits
