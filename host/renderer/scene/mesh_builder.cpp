#include "scene/mesh_builder.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "scene/scene_queries.hpp"

namespace photile::scene {
namespace {

/// Rounded to float, with -0 made +0 so that equal positions have equal bits.
glm::vec3 rounded(const glm::dvec3& position) { return glm::vec3(position) + glm::vec3(0.0f); }

/// `vector` as a unit vector; zero where it has no direction.
glm::dvec3 direction_of(const glm::dvec3& vector) {
  const double length = glm::length(vector);
  return std::isfinite(length) && length > 0.0 ? vector / length : glm::dvec3(0.0);
}

/// What turns the normals of the corners to the front. Files whose winding and normals disagree are
/// common; the winding says which side is the front.
double sign_of_normals(const std::array<const Corner*, 3>& corners, const glm::dvec3& front) {
  glm::dvec3 sum(0.0);
  for (const Corner* corner : corners) sum += direction_of(corner->normal);
  return glm::dot(sum, front) < 0.0 ? -1.0 : 1.0;
}

bool comes_before(const glm::vec3& a, const glm::vec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

}  // namespace

std::size_t MeshBuilder::TriangleHash::operator()(std::uint32_t triangle) const {
  return BytesHash{}(scene->triangles[triangle]) + scene->front_side[triangle];
}

bool MeshBuilder::TriangleEqual::operator()(std::uint32_t a, std::uint32_t b) const {
  return scene->triangles[a] == scene->triangles[b] && scene->front_side[a] == scene->front_side[b];
}

MeshBuilder::MeshBuilder(Scene& scene, const CornerNeeds& needs)
    : scene_(scene), needs_(needs), distinct_(0, TriangleHash{&scene}, TriangleEqual{&scene}) {}

std::uint32_t MeshBuilder::vertex_index(const glm::vec3& position) {
  const auto next = static_cast<std::uint32_t>(scene_.vertices.size());
  const auto [entry, inserted] = index_of_position_.try_emplace(position, next);
  if (inserted) {
    if (scene_.vertices.size() >= limits::max_vertices) {
      throw InputError(fmt::format("{}: more than {} vertices; split the scene",
                                   scene_.source.string(), limits::max_vertices));
    }
    scene_.vertices.push_back(position);
  }
  return entry->second;
}

bool MeshBuilder::add(const std::array<Corner, 3>& corners, std::uint32_t material,
                      std::uint32_t light) {
  std::array<const Corner*, 3> sorted{&corners[0], &corners[1], &corners[2]};
  std::array<glm::vec3, 3> p{rounded(corners[0].position), rounded(corners[1].position),
                             rounded(corners[2].position)};
  if (!within_limit(corners[0].position) || !within_limit(corners[1].position) ||
      !within_limit(corners[2].position)) {
    ++scene_.report.non_finite_triangles;
    return false;
  }
  // Sorting three corners: each exchange turns the winding round once.
  std::uint8_t front_side = 0;
  for (const auto& [i, j] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 1)}) {
    if (comes_before(p[j], p[i])) {
      std::swap(p[i], p[j]);
      std::swap(sorted[i], sorted[j]);
      front_side ^= 1;
    }
  }
  const glm::dvec3 normal =
      glm::cross(glm::dvec3(p[1]) - glm::dvec3(p[0]), glm::dvec3(p[2]) - glm::dvec3(p[0]));
  // Below the smallest normal float a device could not hold the area, nor a normal made from it.
  if (glm::length(normal) < static_cast<double>(std::numeric_limits<float>::min())) {
    ++scene_.report.degenerate_triangles;
    return false;
  }
  if (scene_.triangles.size() >= limits::max_triangles) {
    throw InputError(fmt::format("{}: more than {} triangles; split the scene",
                                 scene_.source.string(), limits::max_triangles));
  }
  glm::uvec3 triangle;
  for (int i = 0; i < 3; ++i) triangle[i] = vertex_index(p[static_cast<std::size_t>(i)]);
  scene_.triangles.push_back(triangle);
  scene_.front_side.push_back(front_side);
  scene_.triangle_material.push_back(material);
  scene_.triangle_light.push_back(light);
  if (is_duplicate(static_cast<std::uint32_t>(scene_.triangles.size() - 1), sorted)) {
    scene_.triangles.pop_back();
    scene_.front_side.pop_back();
    scene_.triangle_material.pop_back();
    scene_.triangle_light.pop_back();
    ++scene_.report.duplicate_triangles;
    return false;
  }
  if (needs_.uv) {
    scene_.corner_uv.push_back(
        {glm::vec2(sorted[0]->uv), glm::vec2(sorted[1]->uv), glm::vec2(sorted[2]->uv)});
  }
  if (needs_.emission_uv) {
    scene_.corner_emission_uv.push_back({glm::vec2(sorted[0]->emission_uv),
                                         glm::vec2(sorted[1]->emission_uv),
                                         glm::vec2(sorted[2]->emission_uv)});
  }
  if (needs_.normals || needs_.tangents) {
    const double sign = sign_of_normals(sorted, front_side == 0 ? normal : -normal);
    if (needs_.normals) add_normals(sorted, sign);
    if (needs_.tangents) add_tangents(sorted, sign);
  }
  return true;
}

/// Whether the triangle adds nothing to an earlier one in the same place. Of two that look the same
/// way the first counts. Two that look away from each other are the two sides of a surface; where
/// both are of one material, as files often have them, one is enough, since a material reflects on
/// either side. Lights shine from the front, so that they need both.
bool MeshBuilder::is_duplicate(std::uint32_t triangle, const std::array<const Corner*, 3>& sorted) {
  const std::uint32_t light = scene_.triangle_light[triangle];
  std::uint8_t& front_side = scene_.front_side[triangle];
  front_side ^= 1;
  const auto behind = distinct_.find(triangle);
  front_side ^= 1;
  if (behind != distinct_.end() && light == none) {
    if (both_sides_.contains(*behind)) return true;
    if (repeats(*behind, triangle, sorted)) return both_sides_.insert(*behind).second;
  }
  const auto [first, inserted] = distinct_.insert(triangle);
  return !inserted && (light == none || light == scene_.triangle_light[*first]);
}

/// Whether a triangle has the same material as another in its place, and the same texels.
bool MeshBuilder::repeats(std::uint32_t other, std::uint32_t triangle,
                          const std::array<const Corner*, 3>& sorted) const {
  if (scene_.triangle_material[other] != scene_.triangle_material[triangle]) return false;
  const Material& material = scene_.materials[scene_.triangle_material[triangle]];
  if (!needs_.uv || !material.textured()) return true;
  for (std::size_t i = 0; i < 3; ++i) {
    if (glm::vec2(sorted[i]->uv) != scene_.corner_uv[other][i]) return false;
  }
  return true;
}

void MeshBuilder::add_normals(const std::array<const Corner*, 3>& sorted, double sign) {
  std::array<glm::vec3, 3> stored;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 normal = direction_of(sorted[i]->normal);
    any_normal_ |= normal != glm::dvec3(0.0);
    stored[i] = glm::vec3(sign * normal);
  }
  scene_.corner_normal.push_back(stored);
}

/// All three or none: between a tangent and none there is nothing to interpolate, nor between two
/// of opposite hands.
void MeshBuilder::add_tangents(const std::array<const Corner*, 3>& sorted, double sign) {
  std::array<glm::vec4, 3> stored{};
  bool whole = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 tangent = direction_of(sorted[i]->tangent);
    const double hand = std::copysign(1.0, sign * sorted[i]->handedness);
    stored[i] = glm::vec4(glm::dvec4(tangent, hand));
    // Without a normal there is no frame: glTF 2.0, section 3.7.2.1.
    whole &= tangent != glm::dvec3(0.0) && direction_of(sorted[i]->normal) != glm::dvec3(0.0) &&
             stored[i].w == stored[0].w;
  }
  any_tangent_ |= whole;
  scene_.corner_tangent.push_back(whole ? stored : std::array<glm::vec4, 3>{});
}

void MeshBuilder::also_need(const CornerNeeds& needs) {
  const auto want = [&](bool requested, bool& needed, auto& array) {
    if (!requested || needed) return;
    needed = true;
    array.resize(scene_.triangles.size());
  };
  want(needs.uv, needs_.uv, scene_.corner_uv);
  want(needs.emission_uv, needs_.emission_uv, scene_.corner_emission_uv);
  want(needs.normals, needs_.normals, scene_.corner_normal);
  want(needs.tangents, needs_.tangents, scene_.corner_tangent);
}

void MeshBuilder::finish() {
  if (!any_normal_) scene_.corner_normal.clear();
  if (!any_tangent_) scene_.corner_tangent.clear();
}

}  // namespace photile::scene
