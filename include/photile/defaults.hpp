// Every default of photile, in one place. Parameter structs and the command line take theirs from
// here, so the help text cannot drift from the behaviour.
#pragma once

#include <cstddef>
#include <cstdint>

namespace photile::defaults {

// Picture
inline constexpr int image_width = 512;               ///< pixels
inline constexpr int image_height = 384;              ///< pixels
inline constexpr int samples_per_pixel = 4;           ///< primary hits a pixel
inline constexpr double exposure = 0.0;               ///< stops, on top of the automatic exposure
inline constexpr double vertical_field_of_view = 40;  ///< degrees, for a camera photile places
inline constexpr double fisheye_field_of_view = 180;  ///< degrees across the circle
inline constexpr double orthographic_height = 4;  ///< metres, height of a picture of parallel rays

// Photons
inline constexpr std::uint64_t emitted_photons = 1'000'000;  ///< over all lights
inline constexpr std::uint64_t seed = 1;
inline constexpr int max_path_length = 1'000'000;  ///< surfaces; roulette ends paths earlier
inline constexpr int roulette_start = 1;           ///< first bounce at which a path may end
/// From this surface on, paths of photons, and all paths of the integrator "path", survive with at
/// most this probability: so they end between perfect mirrors as well, and their number in white
/// rooms stays bounded.
inline constexpr int long_path = 64;
inline constexpr float largest_survival = 0.99f;

// Photon passes
/// The exponent by which radius and k shrink from pass to pass (Knaus and Zwicker 2011): bias and
/// variance vanish at the same rate.
inline constexpr double pass_alpha = 2.0 / 3.0;
inline constexpr int least_pass_neighbours = 5;  ///< k shrinks no further: fewer are too noisy

// A pilot, which measures how light is spread
inline constexpr std::uint64_t pilot_paths = 10'000;
inline constexpr double pilot_photons_of_cell = 64;  ///< on average, in cells with light

// Bright surface that rays are aimed at
/// Rays are aimed at the brightest `bright_part` of the lit surface where more than `bright_light`
/// of all reflected light comes from it. In a room with a cove half of the light comes from 4% of
/// the surface, in an office by day from 7%, in other rooms from 9% and more: there aimed rays gain
/// nothing.
inline constexpr double bright_part = 0.05, bright_light = 0.5;
inline constexpr double rays_to_bright = 0.5;  ///< of all

// Caustics
/// Paths that are aimed at mirrors and glass, for each path of all light.
inline constexpr std::uint64_t aimed_paths = 3;
/// The fraction of the noise of random photons that a difference of neighbouring points may have:
/// aimed paths fill their lines evenly, and neighbours share photons. A larger value blurs, a
/// smaller one leaves noise.
inline constexpr double aimed_noise = 1.0 / 3;

// Density estimation
inline constexpr int neighbours = 50;                ///< k
inline constexpr double group_angle_degrees = 60.0;  ///< largest angle between normals of a group
/// The automatic radius is this many times the median distance to the k-th photon.
inline constexpr double radius_over_median_kth_distance = 2.0;

// Light maps
inline constexpr double light_map_spacing = 0.04;  ///< metres, of the coarsest nodes
inline constexpr int light_map_levels = 4;         ///< the finest is an eighth
/// The distance between the finest nodes, metres: the coarsest nodes lie closer, so that no other
/// level exists.
inline constexpr double no_detail = 10;
inline constexpr double light_map_contrast = 0.25;  ///< of the corners of a cell that is not split
inline constexpr double published_texel = 0.02;     ///< metres, of the light maps of a page
inline constexpr double light_map_near = 0.5;  ///< cells larger than this fraction of the distance

// Nodes that gather
/// Estimates on surface closer than this to a node that gathers, in radii of the photon estimates,
/// are not used: the blur of the estimates, and what hides within their radius, would show at the
/// node.
inline constexpr double near_radii = 2;
/// Estimates at the ends of their rays use neighbours / `neighbours_over_ends` neighbours, and at
/// least `least_neighbours_at_ends`.
inline constexpr int neighbours_over_ends = 4, least_neighbours_at_ends = 12;
/// The distance between nodes that gather is the radius of an estimate with this many times the
/// neighbours.
inline constexpr int photons_between_nodes = 3;
inline constexpr int most_near_surfaces = 3;  ///< in a row that a ray continues from
/// From near surface that reflects less than the inverse of this, rays continue by Russian
/// roulette.
inline constexpr float survival_of_reflectance = 1.5f;
/// At ray ends whose lobe reflects more than this towards the ray, the direction of light counts.
inline constexpr float strong_lobe = 0.2f;
/// Finer nodes have a quarter of the rays of coarse ones, and at least this many: with fewer, walls
/// beside lights would be mottled, and the feet of furniture smudged.
inline constexpr int least_rays = 24;
/// Light samples for each ray of a node.
inline constexpr int light_samples_per_ray = 2;
/// The most point lights and suns that a node samples one by one instead of at random: no more than
/// the light samples that they replace.
inline constexpr std::size_t most_sampled_apart = 32;
/// Radians: the largest light that counts as a sun, whose disc is so small that all points use the
/// same directions. The real sun has 0.0093.
inline constexpr float largest_sun = 0.02f;
/// Directions on the rim of a sun and on its disc that show whether part of it is hidden: an edge
/// that covers 0.2% of it is detected. Where part of it is hidden, `hidden_sun_samples` directions
/// on the disc are used.
inline constexpr int sun_rim_samples = 16, sun_samples = 16, hidden_sun_samples = 256;
/// The factor on the rays where a sun or a sky shines: the light that they find, such as that of a
/// sunlit floor or a window, varies more.
inline constexpr int times_in_the_open = 4;
/// Where the surface of a scene has room for fewer nodes of the coarsest level than this, each node
/// gets proportionally more rays, up to `most_times_where_few` times as many: a node then covers
/// much of the picture, and so does its noise.
inline constexpr double few_nodes = 80'000, most_times_where_few = 4;
/// Where the error of the light samples exceeds this fraction of all light, as in penumbrae, a
/// point takes `light_samples_again` times as many, and `most_light_samples_again` times at most:
/// an error of 2% shows as ragged borders.
inline constexpr double tolerated_light_sample_error = 0.02;
inline constexpr int light_samples_again = 4, most_light_samples_again = 256;
/// The weight of a node's ray for normals at a right angle to the node's is its light over the
/// cosine, whose variance is unbounded: the inverse of the cosine is clamped to this. Surface less
/// than 2 degrees above the horizon then counts less for them, by 2% of what light of all heights
/// alike does.
inline constexpr float most_inverse_cosine = 32;
/// The number of points on each side that a point is averaged with, and the number of rounds. At
/// finer levels the window is smaller, because light changes from one point to the next there.
inline constexpr int averaged_window = 2, averaged_rounds = 2, averaged_fine_window = 1;
/// Standard errors by which points may differ, and how many times as large the standard errors of
/// direct light may be.
inline constexpr double tolerated_errors = 2.5, tolerated_error_ratio = 2;
/// Points whose light differs by less than this fraction of the brighter one's are averaged without
/// a test of what stands between them.
inline constexpr double parting_contrast = 0.5;
/// A light is judged separately from the others where its squared difference exceeds this many
/// times the square of the tolerated one: 4.3 standard errors, which the scatter of eight batches
/// seldom reaches.
inline constexpr double parting_difference = 3;
/// Errors above this fraction of their own light count as unknown: few rays found any of that
/// light.
inline constexpr double known_error = 0.5;
/// Shadow rays between points of one surface run above it by this fraction of their length, so that
/// rounding and what lies flat on it hide nothing. They end short of a node by
/// `visibility_left_out` of their length, which is less than the distance of a node from the foot
/// of a wall.
inline constexpr float visibility_ray_offset = 0x1p-9f, visibility_left_out = 0x1p-9f;
/// The distance of nodes from the borders of triangles, over the finest spacing, so that each node
/// is clearly on one side of what stands there.
inline constexpr double node_inset = 0x1p-5;
/// Shadow rays from a hit to the photons of its estimate run above the surface by this fraction of
/// the radius.
inline constexpr float photon_ray_offset = 0x1p-2f;

// Filter of gloss (docs/method/gloss.md)
/// A pixel is averaged with pixels within one row on each side per `filter_rows` rows of the
/// picture, and within at most `filter_most_reach`: what is reflected grows with the picture.
inline constexpr int filter_rows = 48, filter_most_reach = 8;
/// Pixels on each side by which two pixels are compared, and that show how noisy a pixel is.
inline constexpr int filter_patch = 1, filter_noise_reach = 3;
/// Standard errors by which pixels that are averaged may differ beyond their noise.
inline constexpr float filter_tolerance = 0.6f;
/// Noise below this fraction of a pixel does not show, and stays.
inline constexpr float filter_shown_noise = 0.002f;
/// Differences below this fraction of a pixel count as noise, even where none was measured.
inline constexpr float filter_least_noise = 0.001f;

// Edges
/// Pixels that show an edge have this many samples, but at most `most_times_at_edges` times as many
/// as others: a sample at an edge errs by the whole difference of the surfaces.
inline constexpr int edge_samples = 64, most_times_at_edges = 4;
/// Rays of a pixel that tell whether it shows an edge, beside its samples; pixels with fewer are
/// not tested.
inline constexpr int edge_probes = 8;
/// Two hits are of different surfaces where their normals differ by more than 10 degrees, where one
/// lies above the plane of the other by more than this part of their distance, or where their
/// colours differ by more than this part of the brighter one.
inline constexpr float edge_cosine = 0.985f, edge_slope = 0.2f, edge_contrast = 0.25f;

// Glass
/// Fraction of a pixel's sample from which on reflection and refraction are both followed. Glass
/// seen from the front reflects 0.04.
inline constexpr float least_glass_fraction = 0.02f;

// Gloss by rays
/// A path whose weight in its sample is less than this continues by Russian roulette, with this
/// weight. A smooth dielectric seen from the front reflects 0.04, and is always followed.
inline constexpr float least_lobe_weight = 0.02f;
/// Runs into which the samples of a pixel are divided; their scatter gives the error.
inline constexpr int runs_of_samples = 4;

// Uniform grid
inline constexpr float photons_per_cell = 4.0f;  ///< aimed at; about 4 is best for k = 50

// Primary rays
inline constexpr int max_specular_depth = 16;  ///< mirrors and glass followed by a primary ray

// Denoising
inline constexpr int denoising_samples = 16;  ///< primary rays per pixel for the guides
inline constexpr float denoising_errors = 3;  ///< known standard errors by which a value may change
inline constexpr const char* denoising_library = "libOpenImageDenoise.so.2";

// The trade between time and error
inline constexpr int trade_width = 256;         ///< pixels
inline constexpr int trade_height = 192;        ///< pixels
inline constexpr int reference_samples = 1024;  ///< paths per pixel

// The walkthrough: what is aimed at while moving, and how far a picture is refined at rest
inline constexpr double view_frames_per_second = 30;
/// Paths of the first picture, k of its estimates, and metres between its coarsest nodes: ends of
/// rays that gather average over many estimates.
inline constexpr std::uint64_t view_first_photons = 32'768;
inline constexpr int view_first_neighbours = 25;
inline constexpr double view_first_spacing = 0.5;
inline constexpr int clicked_rays = 1'024;  ///< of each repeat at a clicked point
inline constexpr std::size_t clicked_repeats = 64;
inline constexpr int view_sky_patches = 145;   ///< Tregenza's, of a sky that hours move
inline constexpr double work_light = 1'000;    ///< lm at the eye, of a room without any light yet
inline constexpr double luminaire_side = 0.6;  ///< metres, of an opening that no file states

// Several processes
/// The most bytes that a process sends in one round of an exchange, which bounds the buffers that
/// it needs beside the photons.
inline constexpr std::uint64_t exchange_round_bytes = std::uint64_t{1} << 24;
inline constexpr int rank_patience =
    120;  ///< seconds without a sign of a rank, after which all ranks end

// Trade
inline constexpr int trade_neighbours = 200;  ///< numbers around it are tried as well

// Validation: most readings are within the tolerance of 1% after the fewest seeds
inline constexpr std::uint64_t validation_photons = 1'000'000;  ///< of each seed
inline constexpr int validation_neighbours = 250;
inline constexpr int validation_paths = 50'000;  ///< of each seed, over the sensors of a case

// Lights
inline constexpr double sun_diameter_degrees = 0.533;  ///< as seen from the Earth, the mean

// Portals
/// The fraction of the photons of a sun or a sky that start through portals; the others carry the
/// light that comes another way.
inline constexpr double portal_photons = 0.85;
/// The fraction of the light samples of suns and skies that go through portals.
inline constexpr double portal_sample_fraction = 0.6;

// Daylight
inline constexpr int sky_patches = 577;            ///< Reinhart's, of a year of daylight
inline constexpr double ground_reflectance = 0.2;  ///< of the ground that surrounds a scene
inline constexpr double daylight_lux = 300;        ///< of daylight autonomy: LM-83 and EN 17037
inline constexpr double lamp_efficacy = 100;       ///< lm/W, of luminaires that dim with daylight
inline constexpr int daylight_rays = 256;          ///< of each sensor and repeat
inline constexpr int daylight_repeats = 4;

// Measuring: a mean of repeats, each with its own photons, whose scatter gives the standard error
inline constexpr int measuring_rays = 1'024;  ///< of each sensor and repeat
inline constexpr int measuring_repeats = 8;
inline constexpr double wall_band = 0.5;  ///< metres that EN 12464-1 allows grids to leave out
inline constexpr double maintenance_factor = 1.0;  ///< none: the light of a new installation

/// Limits beyond which a warning is printed: no paint reflects as much, and a candle emits 12 lm.
inline constexpr double doubtful_reflectance = 0.95, doubtful_lumens = 5;

// False colour, as in Radiance's falsecolor
inline constexpr int legend_steps = 8;

// Reflections that are marked
inline constexpr double glare_limit = 5;  ///< times the mean luminance, as evalglare's -b

// Glare ratings
inline constexpr double eye_height = 1.2;           ///< metres, seated (EN 12464-1)
inline constexpr int glare_directions = 4;          ///< of view at each point of a grid
inline constexpr int glare_picture_side = 512;      ///< pixels of a fisheye
inline constexpr int samples_of_luminaire = 256;    ///< at the luminous openings of a luminaire
inline constexpr double small_source_area = 0.005;  ///< m2 projected: CIE 147, small sources
inline constexpr double large_source_area = 1.5;    ///< m2: CIE 147, large sources
/// cd/m2 of a glare source in a picture, the angle (radians) within which its pixels are one
/// source, and the luminance of peaks that are separate sources: those of evalglare 3.
inline constexpr double glare_source_luminance = 2'000;
inline constexpr double glare_source_angle = 0.1;
inline constexpr double glare_peak_luminance = 50'000;
inline constexpr double largest_position_index = 16;  ///< of sources in pictures, as evalglare
/// UGR tables: spacing of luminaires over their height above the eyes. Data sheets have 0.25; the
/// example of CIE 190 has 1.
inline constexpr double ugr_table_spacing = 0.25;

// Contact sheets of walks
inline constexpr int contact_sheet_width = 256;  ///< pixels, of a frame

// Units
/// Luminous efficacy that turns watts into lumens: 683 lm/W, as glTF and Blender do. Radiance uses
/// 179. Written into every output.
inline constexpr double lumen_per_watt = 683.0;

}  // namespace photile::defaults
