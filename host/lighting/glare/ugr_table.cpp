#include "glare/ugr_table.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "glare/ratings.hpp"

namespace photile::glare {
namespace {

constexpr double height = 2;          // metres from the eyes up to the luminaires
constexpr double farthest_aside = 3;  // T / R
const double lowest_cosine = std::cos(glm::radians(85.0));

/// Form factor between the two squares of a box of height 1 (Hottel; Howell C-11).
double facing_factor(double a, double b) {
  const double x = a * a, y = b * b;
  return 2 / (glm::pi<double>() * a * b) *
         (0.5 * std::log((1 + x) * (1 + y) / (1 + x + y)) +
          a * std::sqrt(1 + y) * std::atan(a / std::sqrt(1 + y)) +
          b * std::sqrt(1 + x) * std::atan(b / std::sqrt(1 + x)) - a * std::atan(a) -
          b * std::atan(b));
}

/// How a luminaire hangs in the room, whose axes are: to the right, ahead, up.
struct Mounting {
  bool x_is_ahead;

  /// The length of an opening is its longer side; of a square one it lies along y, as EULUMDAT has
  /// it.
  Mounting(const LuminousOpening& opening, bool endwise)
      : x_is_ahead(endwise == (opening.x > opening.y)) {}

  /// A direction of the room in the lamp's space.
  glm::dvec3 in_lamp(const glm::dvec3& direction) const {
    return x_is_ahead ? glm::dvec3(direction.y, direction.x, direction.z) : direction;
  }
};

/// Middles of equal parts of about a spacing.
std::vector<double> places(double from, double to, double spacing) {
  const int count = std::max(1, static_cast<int>(std::lround((to - from) / spacing)));
  std::vector<double> all;
  for (int i = 0; i < count; ++i) all.push_back(from + (to - from) * (i + 0.5) / count);
  return all;
}

/// Where the light below a luminaire goes.
class DownwardLight {
 public:
  DownwardLight(const IntensityDistribution& luminaire, const Mounting& mounting) {
    constexpr int polar = 90, around = 72;
    constexpr double gamma_step = glm::half_pi<double>() / polar,
                     azimuth_step = glm::two_pi<double>() / around;
    for (int i = 0; i < polar; ++i) {
      const double gamma = gamma_step * (i + 0.5);
      for (int j = 0; j < around; ++j) {
        const double azimuth = azimuth_step * (j + 0.5);
        const glm::dvec3 direction(std::sin(gamma) * std::sin(azimuth),
                                   std::sin(gamma) * std::cos(azimuth), -std::cos(gamma));
        const double share = std::sin(gamma) * gamma_step * azimuth_step *
                             luminaire.intensity(mounting.in_lamp(direction)) / luminaire.flux();
        const double scale = height / -direction.z;
        rays_.push_back({scale * direction.x, scale * direction.y, share});
        whole_ += share;
      }
    }
  }

  /// Share of the luminaire's flux that leaves it downwards.
  double whole() const { return std::min(1.0, whole_); }

  /// Share that falls straight on the plane of the eyes within the room, from a point (metres from
  /// the middle of the observer's wall).
  double on_floor(double x, double y, double half_width, double depth) const {
    double sum = 0;
    for (const Ray& ray : rays_) {
      const double px = x + ray.x, py = y + ray.y;
      if (std::abs(px) <= half_width && py >= 0 && py <= depth) sum += ray.share;
    }
    return sum;
  }

  /// Its mean over a room full of luminaires, from a few points: it is smooth.
  double on_floor_of(double half_width, double depth) const {
    double sum = 0, count = 0;
    for (const double x : places(0, half_width, 0.5 * height)) {
      for (const double y : places(0, depth, 0.5 * height)) {
        sum += on_floor(x, y, half_width, depth);
        ++count;
      }
    }
    return sum / count;
  }

 private:
  struct Ray {
    double x, y;  ///< metres from the point to where it meets the plane of the eyes
    double share;
  };
  std::vector<Ray> rays_;
  double whole_ = 0;
};

/// The luminaires that count, as the observer sees them.
std::vector<Source> seen_sources(const IntensityDistribution& luminaire, const Mounting& mounting,
                                 const std::vector<double>& xs, const std::vector<double>& ys) {
  const Observer eye{"", glm::dvec3(0.0), {0, 1, 0}, {0, 0, 1}};
  std::vector<Source> sources;
  for (const double y : ys) {
    for (const double x : xs) {
      const glm::dvec3 way(x, y, height);
      const double distance = glm::length(way);
      const glm::dvec3 direction = way / distance;
      if (std::abs(x) > farthest_aside * y || direction.z < lowest_cosine) continue;
      const glm::dvec3 in_lamp = mounting.in_lamp(-direction);
      const double area = luminaire.opening().projected_area(in_lamp);
      if (!(area > 0)) continue;
      sources.push_back({luminaire.intensity(in_lamp) / area, area / (distance * distance),
                         position_index(eye, direction)});
    }
  }
  return sources;
}

UgrTable::Row row_of(const IntensityDistribution& luminaire, const TableRoom& room, double spacing,
                     const Mounting& mounting, const DownwardLight& light) {
  const double half_width = 0.5 * room.across * height, depth = room.along * height;
  const std::vector<double> xs = places(-half_width, half_width, spacing * height);
  const std::vector<double> ys = places(0, depth, spacing * height);
  const double floor = light.on_floor_of(half_width, depth);
  const double walls = light.whole() - floor, ceiling = 1 - light.whole();
  const double wall_area = 2 * height * (2 * half_width + depth);
  const double flux = luminaire.flux() * static_cast<double>(xs.size() * ys.size());
  const std::vector<Source> sources = seen_sources(luminaire, mounting, xs, ys);
  UgrTable::Row row{};
  for (std::size_t i = 0; i < table_reflectances.size(); ++i) {
    const TransferFactors factors = transfer_factors(room, table_reflectances[i]);
    const double indirect =
        flux / wall_area *
        (floor * factors.floor + walls * factors.walls + ceiling * factors.ceiling);
    const double rating = ugr(sources, indirect / glm::pi<double>());
    row[i] = std::isfinite(rating) ? rating : std::numeric_limits<double>::quiet_NaN();
  }
  return row;
}

}  // namespace

TransferFactors transfer_factors(const TableRoom& room, const RoomReflectances& reflectances) {
  const double facing = facing_factor(room.across, room.along);
  const double floor_area = room.across * room.along, wall_area = 2 * (room.across + room.along);
  const double to_walls = 1 - facing, from_walls = to_walls * floor_area / wall_area;
  const double among_walls = 1 - 2 * from_walls;
  // Flux on each surface: what falls directly plus what the others reflect, until it is all there.
  const auto on_walls = [&](const glm::dvec3& direct) {
    glm::dvec3 flux = direct, reflected = direct;  // floor, walls, ceiling
    while (reflected.x + reflected.y + reflected.z > 1e-12) {
      const glm::dvec3 leaves =
          reflected * glm::dvec3(reflectances.floor, reflectances.walls, reflectances.ceiling);
      reflected = {leaves.y * from_walls + leaves.z * facing,
                   (leaves.x + leaves.z) * to_walls + leaves.y * among_walls,
                   leaves.y * from_walls + leaves.x * facing};
      flux += reflected;
    }
    return flux.y - direct.y;
  };
  return {on_walls({1, 0, 0}), on_walls({0, 1, 0}), on_walls({0, 0, 1})};
}

UgrTable ugr_table(const IntensityDistribution& luminaire, double spacing) {
  UgrTable table;
  for (const bool endwise : {false, true}) {
    const Mounting mounting(luminaire.opening(), endwise);
    const DownwardLight light(luminaire, mounting);
    auto& rows = endwise ? table.endwise : table.crosswise;
    for (std::size_t i = 0; i < table_rooms.size(); ++i) {
      rows[i] = row_of(luminaire, table_rooms[i], spacing, mounting, light);
    }
  }
  return table;
}

}  // namespace photile::glare
