"""The faults that mutants.py builds in, each with the tests that have to notice.

A mutant replaces a text that its file has exactly once. Tests are programs of tests/ with Catch2's
test specifications; those named are the ones to run, not all that may fail.
"""

import dataclasses


@dataclasses.dataclass(frozen=True)
class Mutant:
    name: str
    file: str  # of the repository; the tests of kernels/ need no build
    find: str
    replace: str
    tests: tuple  # (folder of tests/, specification)

    @property
    def in_kernels(self):
        return self.file.startswith("kernels/")


ORACLE = (("estimate", "neighbours equal the oracle's on a plate*,irradiance equals the oracle's for one*"),)
EVEN_LIGHT = ("validation", "even light is read without bias*")
EXACT_LAW = ("estimate", "the exact law of the estimate in the middle*")
PATCHES = ("estimate", "*neighbours in the Cornell box,*neighbours on a fine torus")
INTERREFLECTION = ("validation", "interreflected light is read without bias*")
EXTREMES = ("estimate", "extremes: photons within*")
PATHS = (("reference", "~[slow]"),)

MUTANTS = (
    # Light maps
    Mutant("light maps split nothing", "host/renderer/cache/light_maps.cpp",
           "return high - low > high * (parameters.contrast + noise);", "return false;",
           (("cache", "Cells are split where light varies*"),)),
    Mutant("weights of neighbouring nodes swapped", "host/renderer/cache/tiles.hpp",
           "within.x * (1 - within.y),", "(1 - within.x) * within.y,",
           (("cache", "Light maps give back light that varies linearly*"),)),
    Mutant("estimates depend on the hits before", "kernels/estimate/neighbourhood.clh",
           "max(walk->chunk, chunk_begin(start))", "max(walk->chunk, start)",
           (("cache", "What was looked at before changes no bit of a picture"),)),

    # Physics of photons
    Mutant("k for k - 1", "kernels/estimate/estimate_hit.clh",
           "if (k > 1) return nearest;", "",
           (("validation", "few neighbours are as unbiased as many*"), EXACT_LAW)),
    Mutant("area 1% off", "kernels/estimate/area.clh",
           "return disc.area;", "return 1.01f * disc.area;", (EVEN_LIGHT, EXACT_LAW)),
    Mutant("whole disc for the clipped one", "kernels/estimate/area.clh",
           "return disc.area;", "return 3.14159265f * squared;",
           (("estimate", "the exact law of the estimate at an edge"),)),
    Mutant("corners without an angle", "kernels/surface/region_border.clh",
           "const int_x8 at_end = at_a | at_b;", "const int_x8 at_end = 0;",
           (("estimate", "clipped irradiance on vertices*"),)),
    Mutant("edges of other triangles without a side", "kernels/surface/region_border.clh",
           "const int_x8 within = own_triangle | (side > 0.0f);", "const int_x8 within = own_triangle;",
           (("estimate", "areas at corners\\, edges and T-junctions of the bundled rooms*"),)),
    Mutant("all heights in the slab", "kernels/estimate/candidates.clh",
           "(fabs((x + y) + z) <= nearness->height)", "(fabs((x + y) + z) <= INFINITY)",
           (("estimate", "clipped irradiance on a torus*"),)),
    Mutant("cosine of lamps dropped", "host/renderer/trace/light_emitter.cpp",
           "sample_cosine_hemisphere(numbers.uniform(0), numbers.uniform(1))",
           "direction_at(numbers.uniform(0), numbers.uniform(1))",
           (INTERREFLECTION, ("trace", "A square lamp*,An area light emits*"))),
    Mutant("back side counted", "host/renderer/trace/photon_tracer.cpp",
           "run.oriented_face.push_back(point.oriented_face());",
           "run.oriented_face.push_back(point.oriented_face() ^ 1u);",
           (("validation", "the unlit side of a lit plate*"),)),
    Mutant("photons' roulette uncompensated", "host/renderer/trace/photon_tracer.cpp",
           "u < survival ? after / survival", "u < survival ? after",
           (INTERREFLECTION, ("trace", "In a closed diffuse box*"))),
    Mutant("one light 2% brighter", "host/renderer/trace/photon_tracer.cpp",
           "static_cast<double>(setup.paths)",
           "(static_cast<double>(setup.paths) * (setup.light == 1 ? 0.98 : 1.0))",
           (("validation", "each light of two is read at its own power"),)),
    Mutant("a step of Pascal's triangle left out", "host/renderer/trace/random_stream.hpp",
           "index ^= index >> 2 & 0x3333'3333u;", "",
           (("trace", "The second dimension is*,Any aligned 2^n points*"),)),
    Mutant("points in the same order for all pixels", "host/renderer/trace/random_stream.hpp",
           "scrambled_digits(reversed_bits(index), scramble.word(0))", "reversed_bits(index)",
           (("trace", "Each point of the sequence is uniform*,Pairs of dimensions*"),)),
    Mutant("one scramble for all batches of rays", "host/renderer/trace/hemisphere_rays.cpp",
           "block(Purpose::hemisphere_direction, batch)", "block(Purpose::hemisphere_direction, 0)",
           (("cache", "gathering: the stated error*"),)),
    Mutant("aimed rays that count as much as others", "host/renderer/trace/hemisphere_rays.cpp",
           "direction, weight * throughput,", "direction, throughput,",
           (("cache", "gathering: rays are aimed*"),)),
    Mutant("a filter that tolerates all differences", "host/renderer/cache/irradiance_filter.cpp",
           "(tolerated.errors * tolerated.errors * variance)", "(1e6 * variance)",
           (("cache", "filter: steps*"),)),
    Mutant("a filter for which errors may differ at will", "host/renderer/cache/irradiance_filter.cpp",
           "return part * part;", "return 1;",
           (("cache", "gathered nodes: a wall is dark below*"),)),
    Mutant("light samples of near lights that are not weighed", "host/renderer/trace/light_clusters.cpp",
           "(1 - everywhere) * probabilities.up_to[i] / weights", "(1 - everywhere) * share",
           (("trace", "light clusters: light samples*"),)),
    Mutant("one light's random numbers for all", "host/renderer/trace/photon_tracer.cpp",
           "random(setup.parameters->seed, path, setup.light)",
           "random(setup.parameters->seed, path, 0)",
           (("trace", "Another seed*"),)),
    Mutant("wrong unit: 683 lm/W for those asked for", "host/renderer/image/layered_picture.cpp",
           "? 1.0 : lumen_per_watt", "? 1.0 : 683.0", (("image", "~[slow]"),)),
    # Scenes and pictures
    Mutant("a picture's width for its height", "host/renderer/scene/camera.cpp",
           "half_height * width / height * camera.right", "half_height * height / width * camera.right",
           (("scene", "~[slow]"), ("loading", "rays of a camera meet*"))),
    Mutant("bounding sphere of half the radius", "host/renderer/scene/scene_queries.cpp",
           "0.5 * glm::length(high - low)", "0.25 * glm::length(high - low)",
           (("scene", "~[slow]"), ("loading", "the bounding sphere*"))),
    Mutant("relit colours without their tints", "host/renderer/image/relight.cpp",
           "ratio(now.power * now.tint[i], before.power * before.tint[i], now.name)",
           "ratio(now.power, before.power, now.name)", (("image", "~[slow]"),)),
    Mutant("reflections of lamps marked without their powers", "host/renderer/image/glare.cpp",
           "mixed.power * luminance(", "luminance(", (("image", "~[slow]"),)),
    Mutant("regions that mostly see a lamp count in errors", "host/renderer/image/picture_error.cpp",
           "2 * tile.counted < tile.pixels || ", "", (("image", "~[slow]"),)),
    Mutant("per cent of a light for its factor", "host/renderer/image/light_change.cpp",
           "ScalePower{*percent / 100}", "ScalePower{*percent}", (("image", "~[slow]"),)),
    # Where photons are
    Mutant("normal filter off", "kernels/estimate/normal_filter.clh",
           "return select((simd_float)(INFINITY), squared, (x + y) + z >= filter->least_cosine);",
           "return squared;", (PATCHES,)),
    Mutant("last photon of each row of cells dropped", "kernels/estimate/vector_path.clh",
           "offset < (simd_uint)(end - start));", "offset < (simd_uint)(end - start - 1u));", ORACLE),
    Mutant("photons of one light count for the other", "kernels/estimate/candidates.clh",
           "adds = is_near & (light_of_lane == (simd_int)((int)light));",
           "adds = is_near & (light_of_lane >= (simd_int)((int)light));",
           (("estimate", "*irradiance for several lights"),)),
    Mutant("all that tie count", "kernels/estimate/candidates.clh",
           "lanes_up_to(neighbourhood->last_tied, c->photon + record,", "lanes_up_to(0xFFFFFFFFu, c->photon + record,", (("estimate", "photons in one point: ties*,extremes: photons*"),)),
    Mutant("slack of cells 0", "kernels/grid/size_grids.cl",
           "grid.slack = 16.0f * FLT_EPSILON * (width_u + width_v);", "grid.slack = 0.0f;",
           (EXTREMES,)),
    Mutant("photons beyond 0.98 of the squared reach of a triangle left out",
           "kernels/grid/insertion.clh",
           "squared_distance_to_triangle(photon, a, b, c, gap_h * gap_h) <= squared_reach;",
           "squared_distance_to_triangle(photon, a, b, c, gap_h * gap_h) <= 0.98f * squared_reach;",
           (("maps", "grid contents equal*"),)),
    Mutant("photons beyond 0.98 of the squared reach of a patch left out",
           "kernels/grid/insertion.clh",
           "if ((gap_u * gap_u + gap_v * gap_v) + gap_h * gap_h > squared_reach) return false;",
           "if ((gap_u * gap_u + gap_v * gap_v) + gap_h * gap_h > 0.98f * squared_reach) "
           "return false;", (("estimate", "a patch has the photons*"),)),
    Mutant("distances from needles in floats", "host/renderer/maps/map_shapes.cpp",
           "constexpr double most_heights = 16;", "constexpr double most_heights = 1e30;",
           (("estimate", "extremes: needles*"),)),
    # Lights
    Mutant("ballast-lamp factor in files of any year", "host/formats/photometry/ies_reader.cpp",
           "has_ballast_lamp_factor(trimmed(lines.front())) && next > 0.0", "next > 0.0",
           (("loading", "[ies]"),)),
    Mutant("azimuth of measured lamps mirrored for photons", "host/renderer/scene/intensity_distribution.cpp",
           "+ std::sin(azimuth) * axes_.quarter", "- std::sin(azimuth) * axes_.quarter",
           (("trace", "[intensity]"),)),
    Mutant("rows of an environment without their solid angle", "host/renderer/trace/distant_light.cpp",
           "sum * map.solid_angle(row)", "sum", (("trace", "[environment]"),)),
    Mutant("environment met by paths counted in full", "host/renderer/render/surface_path.cpp",
           "weight_against(lights_.density(light, from_, direction))", "1.0f",
           (("trace", "[environment]"),)),
    Mutant("lamps behind a pane counted twice", "host/renderer/render/surface_path.cpp",
           "if (!unscattered || !trace::material_of(scene_, point).thin) density_ = 0.0f;",
           "density_ = 0.0f;", (("trace", "an environment behind a pane*"),)),
    Mutant("sun's illuminance by its solid angle", "host/renderer/scene/light_emission.cpp",
           "2.0 / (1.0 + std::cos(0.5 * angular_diameter))", "1.0", (("loading", "[sun]"),)),
    Mutant("photons of textured lamps without their density", "host/renderer/trace/light_emitter.cpp",
           "* sides / area_->density(point.where)", "* sides", (("loading", "[emission]"),)),
    # Measuring
    Mutant("lamps met by sensors' rays counted in full", "host/renderer/trace/eye_path.cpp",
           "return ray.unscattered ? power_heuristic(other->density, found) : 1.0f;", "return 1.0f;",
           (("measuring", "an area light gives*,in a furnace*"),)),
    Mutant("jackknife without its factor", "host/lighting/measuring/measurement.cpp",
           "std::sqrt((count - 1) / count * squares)", "std::sqrt(squares / (count - 1))",
           (("measuring", "standard errors are the spread*"),)),
    Mutant("hash of saved maps not compared", "host/formats/saved_maps/saved_maps.cpp",
           "hash_->digest() != part.digest", "false",
           (("saved_maps", "a file with any byte changed*"),)),
    Mutant("paths begin at speed", "host/formats/reading/camera_path.cpp",
           "if (i == 0 || i + 1 == times.size()) return glm::dvec3(0);",
           "if (i == 0 || i + 1 == times.size()) return glm::dvec3(0.1);",
           (("walk", "smooth paths have the velocity*"),)),
    # Paths
    Mutant("density of light samples 2% off", "host/renderer/trace/light_sampler.cpp",
           "chosen = probability(light, probabilities) *", "chosen = 1.02f * probability(light, probabilities) *", PATHS),
    Mutant("weight of light samples dropped", "host/renderer/render/surface_path.cpp",
           "light->weight_beside(density(light->direction))", "1.0f", PATHS),
    Mutant("paths' roulette uncompensated", "host/renderer/render/surface_path.cpp",
           "weights_ = weights_ * (weight / survival);", "weights_ = weights_ * weight;", PATHS),
    Mutant("weight of light samples from hits dropped", "host/renderer/trace/direct_light.cpp",
           "light->weight_beside(shading_point_.density(light->direction))", "1.0f",
           (("render", "direct rays*"),)),
    Mutant("photons that a window thins keep their weight", "host/renderer/trace/photon_tracer.cpp",
           "flux * (landed.window / landed.weight)", "flux",
           (("trace", "Weight windows change neither*"),)),
    Mutant("photons kept that rays from hits replace", "host/renderer/trace/photon_tracer.cpp",
           "!walk->unscattered || (setup.parameters->store_direct",
           "true || (setup.parameters->store_direct",
           (("render", "direct rays*"),)),
    Mutant("direct light among caustics, so counted twice", "host/renderer/trace/photon_tracer.cpp",
           "setup.parameters->store_direct && !setup.caustics", "setup.parameters->store_direct",
           (("trace", "Caustics of a bare bulb*"),)),
    Mutant("scattered light among caustics, so counted twice", "host/renderer/trace/photon_tracer.cpp",
           "(opaque && setup.caustics) || walk->bounce", "walk->bounce",
           (("trace", "Caustics of a bare bulb*"),)),
    Mutant("photons of all light for those of caustics", "host/renderer/render/photon_passes.cpp",
           "  Maps maps{build(std::move(traced.photons), parameters, plan_.used().kernel,",
           "  traced.caustics = traced.photons;\n"
           "  Maps maps{build(std::move(traced.photons), parameters, plan_.used().kernel,",
           (("cache", "gathering: the light of a caustic*"),)),
    Mutant("radiance seen through water as bright as in it", "host/renderer/trace/scatter.cpp",
           "if (material.thin) return 1;", "return 1;",
           (("render", "a pool shows*"), ("trace", "A lamp under water*"))),
    Mutant("Fresnel's share swapped", "host/renderer/trace/scatter.cpp",
           "if (choice < boundary.reflectance)", "if (choice >= boundary.reflectance)",
           (("trace", "Glass*,Thin glass*"),)),
)
