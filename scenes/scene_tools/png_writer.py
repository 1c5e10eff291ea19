"""8-bit RGB PNG files, without a library."""

import struct
import zlib


def write_png(path, rows):
    """Writes rows of (r, g, b) code values, the first row at the top."""
    def chunk(kind, data):
        checksum = zlib.crc32(kind + data)
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", checksum)

    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)
    before, scanlines = bytes(3 * len(rows[0])), []
    for row in rows:
        here = bytes(c for pixel in row for c in pixel)
        # The filters "none", "sub" and "up"; the one whose differences are least is the smallest, mostly.
        filtered = ((0, here), (1, bytes((a - b) & 255 for a, b in zip(here, bytes(3) + here))),
                    (2, bytes((a - b) & 255 for a, b in zip(here, before))))
        kind, data = min(filtered, key=lambda f: sum(min(c, 256 - c) for c in f[1]))
        scanlines.append(bytes([kind]) + data)
        before = here
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
                     + chunk(b"IDAT", zlib.compress(b"".join(scanlines), 9)) + chunk(b"IEND", b""))
