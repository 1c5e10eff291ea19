// What a report of `photile measure` has of the scene and of its pictures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "photile/layered_picture.hpp"
#include "photile/scene.hpp"
#include "report/false_colour.hpp"
#include "report/report.hpp"

namespace photile::app {

/// Lamps with their numbers on the plans, kinds, photometric files, positions in the scene file's
/// world and powers. Lights of the sky have no position.
report::ReportTable lamp_schedule(const Scene& scene, const LightMix& mix);

/// A row for each opaque material that a triangle has, with its luminous reflectance in percent.
report::ReportTable reflectances(const Scene& scene);

/// The file of moods for a report: the one that is given, else the scene's, "" where there is none.
std::filesystem::path moods_of_report(const std::string& given, const std::filesystem::path& scene);

/// The picture as it was rendered and with each mood of the file, in its colours and, where it has
/// illuminance, in lux. Errors: those of relit_picture and of Moods.
std::vector<report::ReportPicture> report_pictures(const std::filesystem::path& picture,
                                                   const std::filesystem::path& moods,
                                                   const report::FalseColour& colours);

}  // namespace photile::app
