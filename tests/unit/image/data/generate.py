# SPDX-License-Identifier: Apache-2.0
"""Writes the images of this folder: PNG by hand, JPEG and WebP with Pillow (any version)."""
import struct
import zlib

from PIL import Image


def chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def write_png(name, width, height, depth, colour_type, rows, extra=b""):
    header = struct.pack(">IIBBBBB", width, height, depth, colour_type, 0, 0, 0)
    pixels = zlib.compress(b"".join(b"\0" + row for row in rows))
    with open(name, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + extra + chunk(b"IDAT", pixels) + chunk(b"IEND", b""))


GREY, RGB, PALETTE, GREY_ALPHA, RGBA = 0, 2, 3, 4, 6
write_png("rgb8.png", 2, 1, 8, RGB, [bytes([200, 100, 50, 10, 20, 30])])
write_png("rgba8.png", 2, 2, 8, RGBA, [bytes([200, 100, 50, 0, 200, 100, 50, 128]), bytes([1, 2, 3, 1, 255, 254, 253, 255])])
write_png("rgba16.png", 1, 1, 16, RGBA, [struct.pack(">4H", 200 * 257, 100 * 257, 50 * 257, 3 * 257)])
write_png("grey16.png", 2, 2, 16, GREY, [struct.pack(">2H", 0, 128 * 257), struct.pack(">2H", 65535, 18 * 257)])
write_png("grey1.png", 8, 1, 1, GREY, [bytes([0b10100000])])
write_png("grey_alpha8.png", 2, 1, 8, GREY_ALPHA, [bytes([77, 0, 88, 200])])
write_png("palette.png", 3, 1, 8, PALETTE, [bytes([2, 0, 1])],
          chunk(b"PLTE", bytes([1, 2, 3, 40, 50, 60, 7, 8, 9])) + chunk(b"tRNS", bytes([0, 128])))
write_png("gamma.png", 1, 1, 8, RGBA, [bytes([200, 100, 50, 128])], chunk(b"gAMA", struct.pack(">I", 100000)))

flat = Image.new("RGB", (16, 8), (200, 100, 50))
flat.save("baseline.jpg", quality=95)
flat.save("progressive.jpg", quality=95, progressive=True)
Image.new("L", (16, 8), 90).save("grey.jpg", quality=95)
flat.save("lossy.webp", quality=95)
Image.open("rgba8.png").save("lossless.webp", lossless=True, exact=True)
Image.open("rgba8.png").save("extended.webp", quality=95, exact=True, exif=b"Exif\0\0")
