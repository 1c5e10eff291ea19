// Every reader of files and texts from strangers, as a function of bytes.
#pragma once

#include <map>
#include <span>
#include <string_view>

namespace photile::test {

using Bytes = std::span<const unsigned char>;

/// Reads what the bytes say and uses it as photile would. Returns whether they were accepted: they
/// may be refused with an Error of one line. Anything else is a finding: another exception, a value
/// that is no number, a crash.
using FuzzTarget = bool (*)(Bytes bytes);

/// By name: "gltf", "obj", ... A name is a folder and an archive of the corpus, too.
const std::map<std::string_view, FuzzTarget>& fuzz_targets();

// Scenes: text or binary glTF; OBJ, and its MTL behind the first zero byte.
bool fuzz_gltf(Bytes bytes);
bool fuzz_glb(Bytes bytes);
bool fuzz_obj(Bytes bytes);
bool fuzz_ies(Bytes bytes);
bool fuzz_ldt(Bytes bytes);
bool fuzz_texture(Bytes bytes);   ///< a picture of a scene, of any format
bool fuzz_radiance(Bytes bytes);  ///< surroundings
bool fuzz_camera_path(Bytes bytes);
bool fuzz_luminaires(Bytes bytes);  ///< and a photometric file behind the first zero byte
bool fuzz_weather(Bytes bytes);
bool fuzz_schedules(Bytes bytes);  ///< occupied hours

// Pictures
bool fuzz_relight(Bytes bytes);  ///< an EXR with layers
bool fuzz_picture(Bytes bytes);  ///< of any format, as compare and walk read it

// Measuring, moods
bool fuzz_points(Bytes bytes);  ///< sensors, or observers
bool fuzz_planes(Bytes bytes);
bool fuzz_moods(Bytes bytes);

bool fuzz_saved_maps(Bytes bytes);  ///< photons and light maps, whose digests are put right

bool fuzz_options(Bytes bytes);  ///< values of options: the first byte says of which

}  // namespace photile::test
