// The headers of an EXR, looked through before OpenEXR believes them.
#pragma once

#include <OpenEXR/ImfIO.h>

#include <cstdint>

namespace photile::image {

/// OpenEXR reserves what an attribute and a table of the rows are said to take, and reads
/// attributes of types that it knows by their type, whatever their size says: its own limits would
/// hold for the whole process. Leaves the stream at its beginning. `bytes` are those of the file.
/// Errors: DecodeError where an attribute is not as large as it has to be, announces more than the
/// file holds, or the picture is larger than limits.hpp.
void check_exr_headers(Imf::IStream& stream, std::uint64_t bytes);

}  // namespace photile::image
