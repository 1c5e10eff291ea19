#!/usr/bin/python3
"""Writes pictures of all formats by the Python Imaging Library or by hand, and beside each its values: as the
library reads it, or as they were written. No reader or writer of OpenImageIO has a part in it.

    write_pictures.py FOLDER

NAME.values beside NAME: "width height channels type tolerance" in a line, then rows x width x channels values.
The tolerance is in steps of the type; of colours that were multiplied with alpha, over alpha."""

import pathlib
import struct
import sys
import zlib

import numpy as np
from PIL import Image

WIDTH, HEIGHT = 37, 21


def values_of(folder, name, values, tolerance=0):
    """Of a picture that is written: its values."""
    values = np.ascontiguousarray(values)
    values = values.reshape(values.shape[0], values.shape[1], -1)
    kind = {"uint8": "byte", "uint16": "word", "float32": "real"}[values.dtype.name]
    head = f"{values.shape[1]} {values.shape[0]} {values.shape[2]} {kind} {tolerance}\n"
    (folder / f"{name}.values").write_bytes(head.encode() + values.tobytes())


def by_library(folder, name, picture, mode=None, tolerance=0, **options):
    """Saved and read by the library, in this mode where that is another than its own."""
    picture.save(folder / name, **options)
    with Image.open(folder / name) as read:
        values = np.array(read.convert(mode) if mode else read)
    if values.dtype == np.int32:
        values = values.astype(np.uint16)
    if name.endswith(".gif"):
        values[values[..., 3] == 0] = 0  # what is transparent has no colour
    values_of(folder, name, values, tolerance)


def png(folder, name, values):
    """By hand: 16 bits, which the library writes of grey alone."""
    height, width, channels = values.shape
    kind = {3: 2, 4: 6}[channels]
    rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in values)

    def chunk(name, data):
        body = name + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    (folder / name).write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 16, kind, 0, 0, 0)) +
        # What libpng warns of.
        chunk(b"iCCP", b"sRGB\0\0" + zlib.compress(b"no profile")) +
        chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
    values_of(folder, name, values)


def pnm(folder, name, head, data, values, tolerance=0):
    (folder / name).write_bytes(head + data)
    values_of(folder, name, values, tolerance)


def radiance(folder, name, runs):
    """By hand: components in runs, as Radiance writes them, or plain pixels."""
    random = np.random.RandomState(5)
    mantissas = random.randint(128, 256, (HEIGHT, WIDTH, 3)).astype(np.uint8)
    mantissas[:, 10:20] = mantissas[:, 10:11]
    exponents = random.randint(100, 150, (HEIGHT, 1)).repeat(WIDTH, 1).astype(np.uint8)
    pixels = np.dstack([mantissas, exponents])
    data = b""
    for row in pixels:
        if not runs:
            data += row.tobytes()
            continue
        data += bytes([2, 2, WIDTH >> 8, WIDTH & 255])
        for component in row.T:
            data += bytes([10]) + component[:10].tobytes() + bytes([128 + 10, component[10]])
            data += bytes([WIDTH - 20]) + component[20:].tobytes()
    head = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y {HEIGHT} +X {WIDTH}\n"
    (folder / name).write_bytes(head.encode() + data)
    values_of(folder, name, np.ldexp(mantissas.astype(np.float32), exponents.astype(np.int32)[..., None] - 136)
              .astype(np.float32))


def main():
    folder = pathlib.Path(sys.argv[1])
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    colours = np.stack([(x * 6) % 256, (y * 11) % 256, (x * 3 + y * 5) % 256], -1).astype(np.uint8)
    opacity = ((x * 7 + y * 3) % 256).astype(np.uint8)
    rgb = Image.fromarray(colours)
    rgba = Image.fromarray(np.dstack([colours, opacity]))
    grey, bits, palette = rgb.convert("L"), rgb.convert("1"), rgb.quantize(200)
    grey_alpha = Image.merge("LA", (grey, Image.fromarray(opacity)))
    words = colours.astype(np.uint16) * 257 + 13
    real = (colours[..., 0] / np.float32(77)).astype(np.float32)

    for name, picture in {"grey": grey, "grey_alpha": grey_alpha, "rgb": rgb, "rgba": rgba}.items():
        by_library(folder, f"{name}.png", picture)
        by_library(folder, f"{name}.tga", picture)
        by_library(folder, f"{name}_runs.tga", picture, compression="tga_rle")
    by_library(folder, "palette.png", palette, "RGB")
    by_library(folder, "transparent.png", palette, "RGBA", transparency=3)
    by_library(folder, "bits.png", bits, "L")
    by_library(folder, "words.png", Image.fromarray(words[..., 0]))
    png(folder, "words_rgb.png", words)
    png(folder, "words_rgba.png", np.dstack([words, words[..., 0]]))

    # Other versions of libjpeg may round otherwise.
    by_library(folder, "grey.jpg", grey, tolerance=1)
    by_library(folder, "rgb.jpg", rgb, tolerance=1, quality=90)
    by_library(folder, "progressive.jpg", rgb, tolerance=1, progressive=True)
    by_library(folder, "inks.jpg", rgb.convert("CMYK"), "RGB", tolerance=2)

    for compression in ["raw", "tiff_lzw", "tiff_adobe_deflate", "packbits"]:
        by_library(folder, f"rgb_{compression}.tif", rgb, compression=compression)
        by_library(folder, f"rgba_{compression}.tif", rgba, compression=compression)
        by_library(folder, f"real_{compression}.tif", Image.fromarray(real), compression=compression)
    by_library(folder, "grey.tif", grey)
    by_library(folder, "words.tif", Image.fromarray(words[..., 0]))
    by_library(folder, "palette.tif", palette, "RGB", tolerance=1)  # of 16 bits, written as 256 times 8
    by_library(folder, "bits.tif", bits, "L", compression="group4")
    by_library(folder, "jpeg.tif", rgb, tolerance=1, compression="jpeg")
    by_library(folder, "inks.tif", rgb.convert("CMYK"), "RGB", tolerance=2)

    for name, picture in {"rgb": rgb, "grey": grey, "palette": palette, "bits": bits}.items():
        by_library(folder, f"{name}.bmp", picture, "RGB")
    by_library(folder, "palette.gif", palette, "RGBA")
    by_library(folder, "transparent.gif", palette, "RGBA", transparency=3)
    by_library(folder, "interlaced.gif", palette, "RGBA", interlace=True)

    by_library(folder, "palette.tga", rgb.quantize(256), "RGB")
    by_library(folder, "from_above.tga", rgba, orientation=1)

    by_library(folder, "lossless.webp", rgb, lossless=True)
    by_library(folder, "lossy.webp", rgb, tolerance=1)
    by_library(folder, "alpha.webp", rgba, tolerance=255, lossless=True, exact=True)

    by_library(folder, "rgb.ppm", rgb)
    by_library(folder, "grey.pgm", grey)
    by_library(folder, "bits.pbm", bits, "L")
    pnm(folder, "text.ppm", b"P3\n# three\n2 1 # pixels\n255\n", b"1 2 3\n 254 0 128",
        np.array([[[1, 2, 3], [254, 0, 128]]], np.uint8))
    pnm(folder, "tenths.pgm", b"P5 4 1 10\n", bytes([0, 1, 5, 10]), np.array([[0, 26, 128, 255]], np.uint8), 1)
    pnm(folder, "words.pgm", b"P5 3 1 65535\n", bytes([0, 1, 255, 255, 18, 52]),
        np.array([[1, 65535, 4660]], np.uint16), 1)

    radiance(folder, "runs.hdr", True)
    radiance(folder, "pixels.hdr", False)


if __name__ == "__main__":
    main()
