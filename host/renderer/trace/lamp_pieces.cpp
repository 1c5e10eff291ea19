#include "trace/lamp_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <numeric>
#include <string>

#include "photile/errors.hpp"

namespace photile::trace {

namespace {

/// Pieces that a point weighs; so many cost less than two rays.
constexpr std::size_t most_pieces = 64;
/// Beyond so many lamps to weigh each would cost more than it saves.
constexpr std::size_t most_lamps = 1024;
/// The fraction of light samples that are chosen by power alone.
constexpr double everywhere = 0.5;

/// Cosine of a - b, or 1 where b is larger, by cosines and sines of angles up to pi.
float cosine_of_difference(float cosine_a, float sine_a, float cosine_b, float sine_b) {
  return cosine_a >= cosine_b ? 1.0f : cosine_a * cosine_b + sine_a * sine_b;
}

float sine_of(float cosine) { return std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)); }

glm::dvec3 middle_of(const Scene& scene, std::uint32_t triangle) {
  const auto [a, b, c] = scene.corners(triangle);
  return (glm::dvec3(a) + glm::dvec3(b) + glm::dvec3(c)) / 3.0;
}

struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
  void add(const glm::dvec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
};

}  // namespace

LampPieces::LampPieces(const Scene& scene, std::span<const double> shares,
                       const BoundingSphere& bounds)
    : whole_(scene.lights.size(), none),
      far_(static_cast<float>(1 / (bounds.radius * bounds.radius))) {
  if (scene.lights.size() > most_lamps) return;
  for (std::uint32_t light = 0; light < scene.lights.size(); ++light) {
    const Light& lamp = scene.lights[light];
    Piece piece{.light = light, .share = static_cast<float>(shares[light])};
    if (lamp.kind == LightKind::area) {
      add_area_light(scene, piece);
      continue;
    }
    piece.is_far = lamp.is_distant();
    piece.center = lamp.position;
    whole_[light] = static_cast<std::uint32_t>(pieces_.size());
    pieces_.push_back(piece);
  }
  std::vector<float> extent;  // weighed by the share; 0 of what cannot be cut
  const auto extent_of = [&](const Piece& piece) {
    return piece.last - piece.first > 1 ? piece.share * piece.radius : 0.0f;
  };
  for (const Piece& piece : pieces_) extent.push_back(extent_of(piece));
  while (pieces_.size() < most_pieces) {
    const auto largest = std::max_element(extent.begin(), extent.end());
    if (!(*largest > 0.0f)) break;
    const auto index = static_cast<std::size_t>(largest - extent.begin());
    if (!cut(scene, index)) {
      *largest = 0.0f;
      continue;
    }
    *largest = extent_of(pieces_[index]);
    extent.push_back(extent_of(pieces_.back()));
  }
  for (std::uint32_t piece = 0; piece < pieces_.size(); ++piece) {
    const std::vector<std::uint32_t>& of_light = scene.lights[pieces_[piece].light].triangles;
    for (std::uint32_t i = pieces_[piece].first; i < pieces_[piece].last; ++i) {
      of_triangle_[of_light[triangles_[i].number]] = piece;
    }
  }
}

void LampPieces::add_area_light(const Scene& scene, Piece piece) {
  const Light& light = scene.lights[piece.light];
  piece.first = static_cast<std::uint32_t>(triangles_.size());
  for (std::uint32_t number = 0; number < light.triangles.size(); ++number) {
    triangles_.push_back({number, 0});
  }
  piece.last = static_cast<std::uint32_t>(triangles_.size());
  enclose(scene, piece);
  if (light.emission_texture != none) {
    triangles_.resize(piece.first);
    piece.last = piece.first;
    whole_[piece.light] = static_cast<std::uint32_t>(pieces_.size());
  } else {
    of_triangle_.resize(scene.triangle_count(), none);
    sum_areas(scene, piece);
  }
  pieces_.push_back(piece);
}

/// Finds the sphere and the cone of a piece.
void LampPieces::enclose(const Scene& scene, Piece& piece) const {
  const Light& light = scene.lights[piece.light];
  const auto visit = [&](const auto& with) {
    for (std::uint32_t i = piece.first; i < piece.last; ++i) {
      with(light.triangles[triangles_[i].number]);
    }
  };
  Box box;
  glm::dvec3 normals(0.0);
  visit([&](std::uint32_t triangle) {
    for (const glm::vec3& corner : scene.corners(triangle)) box.add(corner);
    const double area = triangle_area(scene, triangle);
    if (area > 0)
      normals += area * sided_normal(scene, sided(triangle, scene.front_side[triangle]));
  });
  piece.center = glm::vec3(0.5 * (box.low + box.high));
  double squared_radius = 0;
  visit([&](std::uint32_t triangle) {
    for (const glm::vec3& corner : scene.corners(triangle)) {
      const glm::dvec3 offset = glm::dvec3(corner) - glm::dvec3(piece.center);
      squared_radius = std::max(squared_radius, glm::dot(offset, offset));
    }
  });
  piece.radius = static_cast<float>(std::sqrt(squared_radius));
  piece.cone_cosine = -1;
  piece.cone_sine = 0;
  if (light.two_sided || !(glm::length(normals) > 0)) return;
  const glm::dvec3 axis = glm::normalize(normals);
  double cosine = 1;
  visit([&](std::uint32_t triangle) {
    if (!(triangle_area(scene, triangle) > 0)) return;
    const glm::dvec3 normal = sided_normal(scene, sided(triangle, scene.front_side[triangle]));
    cosine = std::min(cosine, glm::dot(axis, normal));
  });
  piece.axis = glm::vec3(axis);
  piece.cone_cosine = static_cast<float>(cosine);
  piece.cone_sine = sine_of(piece.cone_cosine);
}

/// Sums the areas of the triangles of a piece, in their order.
void LampPieces::sum_areas(const Scene& scene, const Piece& piece) {
  double area = area_before(piece);
  for (std::uint32_t i = piece.first; i < piece.last; ++i) {
    const Light& light = scene.lights[piece.light];
    area += triangle_area(scene, light.triangles[triangles_[i].number]);
    triangles_[i].area_up_to = area;
  }
}

/// The area of the clusters of the light before this one.
double LampPieces::area_before(const Piece& piece) const {
  return piece.first == 0 ? 0.0 : triangles_[piece.first - 1].area_up_to;
}

/// In the middle of its longest side. Returns false where nothing can be parted.
bool LampPieces::cut(const Scene& scene, std::size_t index) {
  Piece piece = pieces_[index];
  const Light& light = scene.lights[piece.light];
  const auto middle = [&](const Triangle& triangle) {
    return middle_of(scene, light.triangles[triangle.number]);
  };
  const auto begin = triangles_.begin() + piece.first, end = triangles_.begin() + piece.last;
  Box box;
  std::for_each(begin, end, [&](const Triangle& triangle) { box.add(middle(triangle)); });
  const glm::dvec3 size = box.high - box.low;
  const int axis = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
  const double place = 0.5 * (box.low[axis] + box.high[axis]);
  const double whole_area = area(static_cast<std::uint32_t>(index));  // while its order stands
  const auto second = std::stable_partition(
      begin, end, [&](const Triangle& triangle) { return middle(triangle)[axis] < place; });
  sum_areas(scene, piece);
  Piece rest = piece;
  piece.last = rest.first = static_cast<std::uint32_t>(second - triangles_.begin());
  if (piece.first == piece.last) return false;  // what lies farthest is in the rest
  const double part = triangles_[piece.last - 1].area_up_to - area_before(piece);
  if (!(part > 0) || !(part < whole_area)) return false;
  piece.share *= static_cast<float>(part / whole_area);
  rest.share *= static_cast<float>(1 - part / whole_area);
  enclose(scene, piece);
  enclose(scene, rest);
  pieces_[index] = piece;
  pieces_.push_back(rest);
  return true;
}

/// At most, but for its colour and a factor that all pieces share, the illuminance by a piece.
float LampPieces::weight(const Piece& piece, const glm::vec3& position,
                         const glm::vec3& normal) const {
  if (piece.is_far) return piece.share * far_;
  const glm::vec3 offset = piece.center - position;
  const float squared_distance = glm::dot(offset, offset);
  const float squared_radius = piece.radius * piece.radius;
  if (squared_distance <= squared_radius) return piece.share / squared_radius;
  const float distance = std::sqrt(squared_distance);
  const float sphere_sine = piece.radius / distance;
  const float sphere_cosine = sine_of(sphere_sine);
  const float arriving = glm::dot(offset, normal) / distance;
  const float cosine =
      cosine_of_difference(arriving, sine_of(arriving), sphere_cosine, sphere_sine);
  if (!(cosine > 0.0f)) return 0.0f;
  float leaving = 0.25f;  // to all sides
  if (piece.cone_cosine > -1.0f) {
    const float towards = -glm::dot(offset, piece.axis) / distance, sine = sine_of(towards);
    leaving = cosine_of_difference(towards, sine, piece.cone_cosine, piece.cone_sine);
    if (leaving < 1.0f) {
      leaving = cosine_of_difference(leaving, sine_of(leaving), sphere_cosine, sphere_sine);
    }
    if (!(leaving > 0.0f)) return 0.0f;
  }
  return piece.share * cosine * leaving / squared_distance;
}

void LampPieces::weigh(const glm::vec3& position, const glm::vec3& normal,
                       LampChances& chances) const {
  chances.up_to.resize(pieces_.size());
  double weights = 0;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    weights += chances.up_to[i] = double{weight(pieces_[i], position, normal)};
  }
  const bool near = weights > 0 && std::isfinite(weights);
  double sum = 0;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const double share = double{pieces_[i].share};
    const double chance =
        near ? everywhere * share + (1 - everywhere) * chances.up_to[i] / weights : share;
    chances.up_to[i] = sum += chance;
  }
}

LampPieces::Choice LampPieces::choose(const LampChances& chances, const RandomBlock& choice,
                                      const RandomBlock& place) const {
  // The last entry is larger than the target, so there always is one.
  const double target = choice.uniform_double(0) * chances.up_to.back();
  const auto found =
      std::upper_bound(chances.up_to.begin(), chances.up_to.end(), target) - chances.up_to.begin();
  const auto index = static_cast<std::uint32_t>(found);
  const Piece& piece = pieces_[index];
  if (piece.first == piece.last) return {piece.light, index, none};
  const double before = area_before(piece);
  const double area_target = before + place.uniform_double(0) * area(index);
  const auto triangle = std::upper_bound(
      triangles_.begin() + piece.first, triangles_.begin() + piece.last - 1, area_target,
      [](double wanted, const Triangle& other) { return wanted < other.area_up_to; });
  return {piece.light, index, triangle->number};
}

}  // namespace photile::trace

namespace photile {

namespace trace {

std::vector<double> light_shares(const std::vector<Light>& lights, PhotonQuota quota) {
  const double count = static_cast<double>(lights.size());
  double power = 0;
  for (const Light& light : lights) power += light.power;
  // Lights that are all off can still be turned up by relighting.
  if (!(power > 0)) quota = PhotonQuota::equal;
  const double by_power = quota == PhotonQuota::power      ? 1.0
                          : quota == PhotonQuota::balanced ? 0.5
                                                           : 0.0;
  std::vector<double> share;
  for (const Light& light : lights)
    share.push_back((by_power > 0 ? by_power * (light.power / power) : 0.0) +
                    (1.0 - by_power) / count);
  return share;
}

}  // namespace trace

std::string_view name_of(PhotonQuota quota) {
  switch (quota) {
    case PhotonQuota::balanced:
      return "balanced";
    case PhotonQuota::power:
      return "power";
    case PhotonQuota::equal:
      return "equal";
  }
  return "unknown";
}

namespace {

/// Adds what rounding down left over, one path each, by the largest remainder first.
void give_remainder(std::vector<std::uint64_t>& paths, const std::vector<double>& wanted,
                    std::uint64_t remainder) {
  std::vector<std::size_t> order(paths.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return wanted[a] - std::floor(wanted[a]) > wanted[b] - std::floor(wanted[b]);
  });
  for (std::uint64_t i = 0; i < remainder; ++i) ++paths[order[i % order.size()]];
}

}  // namespace

std::vector<std::uint64_t> photons_per_light(const Scene& scene, std::uint64_t total,
                                             PhotonQuota quota) {
  const std::size_t count = scene.lights.size();
  if (count == 0)
    throw InputError(scene.source.string() +
                     ": the scene has no lights; add a light or an emissive material");
  // Each light is given its first path, and shares decide about the paths beyond it.
  total = std::max<std::uint64_t>(total, count);
  const std::vector<double> share = trace::light_shares(scene.lights, quota);
  std::vector<double> wanted(count);
  std::vector<std::uint64_t> paths(count);
  for (std::size_t l = 0; l < count; ++l)
    wanted[l] = std::max(0.0, share[l] * static_cast<double>(total) - 1.0);
  // What the smallest lights are given beyond their share is taken from the others in proportion.
  const double beyond = std::accumulate(wanted.begin(), wanted.end(), 0.0);
  const double available = static_cast<double>(total - count);
  for (std::size_t l = 0; l < count; ++l) {
    if (beyond > 0) wanted[l] *= available / beyond;
    paths[l] = 1 + static_cast<std::uint64_t>(wanted[l]);
  }
  const std::uint64_t given = std::accumulate(paths.begin(), paths.end(), std::uint64_t{0});
  give_remainder(paths, wanted, total - given);
  return paths;
}

}  // namespace photile
