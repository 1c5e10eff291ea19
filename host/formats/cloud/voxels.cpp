#include "cloud/voxels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "photile/scene.hpp"

namespace photile::cloud {
namespace {

constexpr double epsilon = std::numeric_limits<float>::epsilon();

}  // namespace

std::size_t Voxels::CellHash::operator()(const Cell& cell) const {
  std::uint64_t hash = 0;
  for (const std::int64_t coordinate : cell) {
    hash = (hash ^ static_cast<std::uint64_t>(coordinate)) * 0x9E37'79B9'7F4A'7C15ull;
    hash ^= hash >> 32;
  }
  return static_cast<std::size_t>(hash);
}

Voxels::Voxels(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
               double radius, double angle_degrees) {
  float largest = 0;
  glm::dvec3 low(0.0);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const glm::vec3& p = positions[i];
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    low = i == 0 ? glm::dvec3(p) : glm::min(low, glm::dvec3(p));
  }
  // Grown by the rounding of differences of positions on the device.
  reach_ = radius * (1.0 + 1e-5) + 8.0 * epsilon * (static_cast<double>(largest) + radius);
  margin_ = 4.0 * epsilon * (static_cast<double>(largest) + radius);
  width_ = 4.0 * reach_;
  origin_ = low - 1.5 * reach_;  // small clouds lie in one cube

  plan_.reach = static_cast<float>(reach_);
  plan_.normals = !normals.empty();
  plan_.name_of = [](std::uint32_t pair) { return fmt::format("cube {} of the cloud", pair); };
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for_each_near(positions[i], [&](std::uint32_t number) {
      Voxel& voxel = voxels_[number];
      voxel.low = glm::min(voxel.low, positions[i]);
      voxel.high = glm::max(voxel.high, positions[i]);
      if (!normals.empty()) voxel.lean += glm::dvec3(glm::abs(normals[i]));
    });
  }
  for (Voxel& voxel : voxels_) {
    const glm::dvec3 flatness = normals.empty() ? -glm::dvec3(voxel.high - voxel.low) : voxel.lean;
    voxel.axis = flatness.x > flatness.y ? (flatness.x > flatness.z ? 0 : 2)
                                         : (flatness.y > flatness.z ? 1 : 2);
  }
  // A photon may agree with a point on a side of the axis if its normal leans by no more than this
  // to the other.
  const double slack = 1e-3;
  const double least =
      std::cos(std::min(glm::radians(angle_degrees + 90.0) + slack, glm::radians(180.0)));
  maps::CandidateMaps& candidates = plan_.candidates;
  candidates.offsets.push_back(0);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    own_maps_.push_back(2 * find_or_add(cell_of(glm::dvec3(positions[i]))));
    for_each_near(positions[i], [&](std::uint32_t number) {
      const int axis = voxels_[number].axis;
      const double cosine = normals.empty() ? 1.0 : static_cast<double>(normals[i][axis]);
      if (normals.empty() || cosine >= least) candidates.members.push_back(2 * number);
      if (!normals.empty() && -cosine >= least) candidates.members.push_back(2 * number + 1);
    });
    candidates.list_of_photon.push_back(static_cast<std::uint32_t>(i));
    candidates.offsets.push_back(candidates.members.size());
    candidates.first_list_of.push_back(i);
  }
  candidates.first_list_of.push_back(positions.size());
  for (std::size_t v = 0; v < voxels_.size(); ++v) {
    plan_.surfaces.shapes.push_back(shape_of(cells_[v], voxels_[v], plan_.normals));
  }
  plan_.density_ratio.assign(2 * voxels_.size(), 1.0f);
}

std::uint32_t Voxels::map_at(const glm::vec3& point, const glm::vec3& normal) const {
  const auto found = number_of_.find(cell_of(glm::dvec3(point)));
  if (found == number_of_.end()) return none;
  const std::uint32_t number = found->second;
  return 2 * number + (normal[voxels_[number].axis] < 0 ? 1 : 0);
}

Voxels::Cell Voxels::cell_of(const glm::dvec3& point) const {
  Cell cell;
  // Far from every photon all cubes are empty: positions beyond are clamped to the range.
  constexpr double most = 9e15;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int i = static_cast<int>(axis);
    cell[axis] = static_cast<std::int64_t>(
        std::clamp(std::floor((point[i] - origin_[i]) / width_), -most, most));
  }
  return cell;
}

std::uint32_t Voxels::find_or_add(const Cell& cell) {
  const auto [entry, inserted] =
      number_of_.try_emplace(cell, static_cast<std::uint32_t>(cells_.size()));
  if (inserted) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    cells_.push_back(cell);
    voxels_.push_back({glm::vec3(infinity), glm::vec3(-infinity)});
  }
  return entry->second;
}

template <class Visit>
void Voxels::for_each_near(const glm::vec3& position, const Visit& visit) {
  const Cell low = cell_of(glm::dvec3(position) - reach_);
  const Cell high = cell_of(glm::dvec3(position) + reach_);
  for (std::int64_t z = low[2]; z <= high[2]; ++z) {
    for (std::int64_t y = low[1]; y <= high[1]; ++y) {
      for (std::int64_t x = low[0]; x <= high[0]; ++x) visit(find_or_add({x, y, z}));
    }
  }
}

/// The part of the cube that photons may be near, as a box in the plane across its axis.
PhotileMapShape Voxels::shape_of(const Cell& cell, const Voxel& voxel, bool normals) const {
  const glm::dvec3 corner(static_cast<double>(cell[0]), static_cast<double>(cell[1]),
                          static_cast<double>(cell[2]));
  const glm::dvec3 cube_low = origin_ + width_ * corner;
  const glm::dvec3 low = glm::max(cube_low, glm::dvec3(voxel.low) - reach_) - margin_;
  const glm::dvec3 high = glm::min(cube_low + width_, glm::dvec3(voxel.high) + reach_) + margin_;
  glm::vec3 axes[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  const int order[3] = {(voxel.axis + 1) % 3, (voxel.axis + 2) % 3, voxel.axis};
  for (int i = 0; i < 3; ++i) axes[i][order[i]] = 1.0f;
  const glm::vec3 origin(low);
  const glm::dvec3 size = high - low;

  PhotileMapShape shape{};
  shape.origin_x = origin.x, shape.origin_y = origin.y, shape.origin_z = origin.z;
  shape.u_axis_x = axes[0].x, shape.u_axis_y = axes[0].y, shape.u_axis_z = axes[0].z;
  shape.v_axis_x = axes[1].x, shape.v_axis_y = axes[1].y, shape.v_axis_z = axes[1].z;
  shape.axis_x = axes[2].x, shape.axis_y = axes[2].y, shape.axis_z = axes[2].z;
  shape.width_u = static_cast<float>(size[order[0]]);
  shape.width_v = static_cast<float>(size[order[1]]);
  shape.height = static_cast<float>(size[order[2]]);
  shape.area = shape.width_u * shape.width_v;
  shape.perimeter = 2 * (shape.width_u + shape.width_v);
  shape.certain_cosine = normals ? 2.0f : -2.0f;
  constexpr float far = std::numeric_limits<float>::max();  // its own box alone decides
  shape.low_x = shape.low_y = shape.low_z = -far;
  shape.high_x = shape.high_y = shape.high_z = far;
  shape.triangle = PHOTILE_NO_TRIANGLE;
  return shape;
}

}  // namespace photile::cloud
