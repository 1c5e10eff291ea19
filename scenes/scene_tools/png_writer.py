"""8-bit RGB PNG files, without a library."""

import struct
import zlib


def write_png(path, rows):
    """Writes rows of (r, g, b) sRGB code values, the first row at the top."""
    def chunk(kind, data):
        checksum = zlib.crc32(kind + data)
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", checksum)

    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)
    scanlines = b"".join(b"\0" + bytes(c for pixel in row for c in pixel) for row in rows)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
                     + chunk(b"IDAT", zlib.compress(scanlines, 9)) + chunk(b"IEND", b""))
