// UGR by the tabular method: a luminaire in standard rooms.
#pragma once

#include <array>
#include <vector>

#include "photile/defaults.hpp"
#include "photile/scene.hpp"

namespace photile::glare {

/// A room as the table has it: multiples of the height H of the luminaires above the eyes.
struct TableRoom {
  double across, along;  ///< to the line of sight
};
/// The rooms of CIE 190:2010.
inline constexpr std::array<TableRoom, 19> table_rooms{{{2, 2},
                                                        {2, 3},
                                                        {2, 4},
                                                        {2, 6},
                                                        {2, 8},
                                                        {2, 12},
                                                        {4, 2},
                                                        {4, 3},
                                                        {4, 4},
                                                        {4, 6},
                                                        {4, 8},
                                                        {4, 12},
                                                        {8, 4},
                                                        {8, 6},
                                                        {8, 8},
                                                        {8, 12},
                                                        {12, 4},
                                                        {12, 6},
                                                        {12, 8}}};

struct RoomReflectances {
  double ceiling, walls, floor;
};
inline constexpr std::array<RoomReflectances, 5> table_reflectances{
    {{0.7, 0.5, 0.2}, {0.7, 0.3, 0.2}, {0.5, 0.5, 0.2}, {0.5, 0.3, 0.2}, {0.3, 0.3, 0.2}}};

/// Indirect flux that reaches the walls of a room for each lumen that falls directly on its floor
/// (the plane of the eyes), walls and ceiling (the plane of the luminaires): the transfer factors
/// F_T,FW, F_T,WW-1 and F_T,CW of CIE 190, by radiosity of three surfaces.
struct TransferFactors {
  double floor, walls, ceiling;
};
TransferFactors transfer_factors(const TableRoom& room, const RoomReflectances& reflectances);

/// For each room, crosswise (the luminaires' length at a right angle to the line of sight) and
/// endwise, and for each of the reflectances.
struct UgrTable {
  using Row = std::array<double, table_reflectances.size()>;
  std::array<Row, table_rooms.size()> crosswise, endwise;
};

/// UGR tables of CIE 117:1995 and CIE 190:2010: luminaires 2 m above the eyes in a regular array,
/// the first half a spacing from the walls, an observer at the middle of a wall who looks straight
/// on. Luminances are intensity over projected opening; those farther aside than T/R = 3, or lower
/// than 85 degrees from straight down, are left out. The background is the mean indirect
/// illuminance of the walls between the two planes over pi; what falls directly on the floor is
/// counted luminaire by luminaire, where the report has zonal multipliers for a spacing of 1 H.
/// Values are those of the luminaire's own flux; 8 log10(flux / 1000 lm) less are the uncorrected
/// ones. NaN where no luminance is known (no opening) or nothing is seen.
///   spacing   of the luminaires, over H
UgrTable ugr_table(const IntensityDistribution& luminaire,
                   double spacing = defaults::ugr_table_spacing);

}  // namespace photile::glare
