# SPDX-License-Identifier: Apache-2.0
"""Strips of docs/protocol.md, "Strips", decoded from that page alone: all codings but H264. Strict: what the page does
not allow raises Violation."""
import io
import math
import struct

import zstandard
from PIL import Image

RAW, ZSTD_FILTERED, JPEG, H264, REPEAT = 1, 2, 3, 4, 5
R11G11B10F, F32, OCT2X16, U32, RG8, RGB8, R16, OCT2X8 = 1, 2, 3, 4, 5, 6, 20, 30
PIXEL_BYTES = {R11G11B10F: 4, F32: 4, OCT2X16: 4, U32: 4, RG8: 2, RGB8: 3, R16: 2, OCT2X8: 2}
NONE, LEFT, GRADIENT, AVERAGE, REFERENCE = range(5)
BYTES, WORDS16, RELATIVE_TO_GREEN, WORDS32, PACKED_FLOATS = 1, 2, 3, 4, 11
HEADER = struct.Struct("<BBBBBBHHHI")


class Violation(Exception):
    """Bytes that docs/protocol.md does not allow."""


def require(condition, what):
    if not condition:
        raise Violation(what)


def layout_bits(layout, pixel_format):
    """Bits of each channel."""
    size = PIXEL_BYTES[pixel_format]
    fits = {BYTES: True, WORDS16: size in (2, 4), RELATIVE_TO_GREEN: pixel_format == RGB8, WORDS32: size == 4,
            PACKED_FLOATS: pixel_format == R11G11B10F}
    require(fits.get(layout, False), f"layout {layout} does not fit format {pixel_format}")
    return {BYTES: [8] * size, WORDS16: [16] * (size // 2), RELATIVE_TO_GREEN: [8] * 3, WORDS32: [32],
            PACKED_FLOATS: [11, 11, 10]}[layout]


def split_channels(pixels, layout, pixel_format):
    """One list of numbers per channel."""
    if layout == WORDS32:
        return [list(struct.unpack(f"<{len(pixels) // 4}I", pixels))]
    if layout == WORDS16:
        words = struct.unpack(f"<{len(pixels) // 2}H", pixels)
        count = PIXEL_BYTES[pixel_format] // 2
        return [list(words[c::count]) for c in range(count)]
    if layout == PACKED_FLOATS:
        pixels = struct.unpack(f"<{len(pixels) // 4}I", pixels)
        rgb = [(word & 0x7FF, word >> 11 & 0x7FF, word >> 22) for word in pixels]
        return [[g for _, g, _ in rgb], [(r - g + 1024) % 2048 for r, g, _ in rgb],
                [(b - g // 2 + 512) % 1024 for _, g, b in rgb]]
    size = PIXEL_BYTES[pixel_format]
    planes = [list(pixels[c::size]) for c in range(size)]
    if layout == BYTES:
        return planes
    red, green, blue = planes
    return [green] + [[(x - g + 128) % 256 for x, g in zip(other, green)] for other in (red, blue)]


def join_channels(channels, layout):
    if layout == WORDS32:
        return struct.pack(f"<{len(channels[0])}I", *channels[0])
    if layout == WORDS16:
        return b"".join(struct.pack(f"<{len(channels)}H", *pixel) for pixel in zip(*channels))
    if layout == PACKED_FLOATS:
        words = [(d + g - 1024) % 2048 | g << 11 | (e + g // 2 - 512) % 1024 << 22 for g, d, e in zip(*channels)]
        return struct.pack(f"<{len(words)}I", *words)
    if layout == RELATIVE_TO_GREEN:
        return bytes(value for g, d, e in zip(*channels) for value in ((d + g - 128) % 256, g, (e + g - 128) % 256))
    return bytes(value for pixel in zip(*channels) for value in pixel)


def read_errors(content, bits, count):
    """Errors of each channel, from the byte planes."""
    planes = [content[i * count:(i + 1) * count] for i in range(len(content) // count)]
    if bits == [11, 11, 10]:
        shifts = (0, 3, 6)
        return [[low | (high >> shift & (1 << n - 8) - 1) << 8 for low, high in zip(planes[c], planes[3])]
                for c, (n, shift) in enumerate(zip(bits, shifts))]
    errors, at = [], 0
    for n in bits:
        parts = planes[at:at + n // 8]
        errors.append([sum(byte << 8 * k for k, byte in enumerate(bytes_of)) for bytes_of in zip(*parts)])
        at += n // 8
    return errors


def unfold(error):
    return -(error + 1 >> 1) if error & 1 else error >> 1


def undo_prediction(errors, width, predictor, bits, reference):
    values, mask = [0] * len(errors), (1 << bits) - 1
    for i, error in enumerate(errors):
        has_left, has_up = i % width > 0, i >= width
        left, up = values[i - 1] if has_left else 0, values[i - width] if has_up else 0
        if predictor == REFERENCE:
            guess = reference[i]
        elif predictor == LEFT:
            guess = left
        elif predictor == NONE:
            guess = 0
        elif not has_left or not has_up:
            guess = up if has_up else left
        else:
            guess = left + up - values[i - width - 1] if predictor == GRADIENT else (left + up) // 2
        values[i] = guess + error & mask
    return values


def decode_zstd(body, header, pixel_format, size, reference):
    _, _, _, predictor, layout, flags, width, _, rows, _ = header
    require(predictor <= REFERENCE and flags <= 1, "unknown predictor or flags")
    bits = layout_bits(layout, pixel_format)
    require(zstandard.get_frame_parameters(body).content_size == size, "zstd: declared content size")
    decoder = zstandard.ZstdDecompressor().decompressobj()
    content = decoder.decompress(body)
    require(len(content) == size and decoder.unused_data == b"", "zstd: not exactly one frame of the pixels' size")
    channels = []
    all_known = split_channels(reference, layout, pixel_format) if predictor == REFERENCE else [None] * len(bits)
    for n, errors, known in zip(bits, read_errors(content, bits, width * rows), all_known):
        errors = [unfold(error) for error in errors] if flags else errors
        channels.append(undo_prediction(errors, width, predictor, n, known))
    return join_channels(channels, layout)


def small_float(bits, mantissa_bits):
    exponent, mantissa = bits >> mantissa_bits, bits & (1 << mantissa_bits) - 1
    if exponent == 31:
        return math.nan if mantissa else math.inf
    lead = 1 << mantissa_bits if exponent else 0
    return math.ldexp(lead + mantissa, max(exponent, 1) - 15 - mantissa_bits)


def unpack_light(word):
    """(red, green, blue) of a R11G11B10F pixel."""
    return small_float(word & 0x7FF, 6), small_float(word >> 11 & 0x7FF, 6), small_float(word >> 22, 5)


def nearest_bits(value, mantissa_bits):
    """Of the nearest finite value; the bits grow with the value."""
    low, high = 0, (31 << mantissa_bits) - 1
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if small_float(middle, mantissa_bits) <= value else (low, middle)
    return low if value - small_float(low, mantissa_bits) < small_float(high, mantissa_bits) - value else high


def decode_jpeg(body, pixel_format, width, rows):
    curve, picture = (body[:8], body[8:]) if pixel_format == R11G11B10F else (b"", body)
    try:
        image = Image.open(io.BytesIO(picture))
        image.load()
    except OSError as problem:
        raise Violation(f"JPEG: {problem}") from problem
    require(image.format == "JPEG" and image.mode == "RGB" and image.size == (width, rows), "JPEG: kind or size")
    require(picture[-2:] == b"\xff\xd9" and b"\xff\xc0" in picture and not image.info.get("progressive"),
            "JPEG: not SOF0")
    require(image.layer and all(layer[1:3] == (1, 1) for layer in image.layer), "JPEG: subsampled")
    samples = image.tobytes()
    if not curve:
        return samples
    knee, top = struct.unpack("<2f", curve)
    require(all(2.0**-40 <= x <= 2.0**40 for x in (knee, top)), "light curve: knee or top out of range")
    scale = math.log1p(top / knee) / 255
    tables = [[nearest_bits(knee * math.expm1(sample * scale), m) for sample in range(256)] for m in (6, 5)]
    words = [tables[0][r] | tables[0][g] << 11 | tables[1][b] << 22
             for r, g, b in zip(samples[::3], samples[1::3], samples[2::3])]
    return struct.pack(f"<{len(words)}I", *words)


def decode(strip, pixel_format, width, rows, codec, reference=None):
    """Pixels of `rows` = (first, count). `codec` is the plane's, `reference` the same rows of the key frame or None."""
    require(len(strip) >= HEADER.size, "strip: shorter than its header")
    header = HEADER.unpack_from(strip)
    version, coding, strip_format, predictor, layout, flags, strip_width, first, count, body_bytes = header
    body = strip[HEADER.size:]
    require(version == 1 and body_bytes == len(body), "strip header: version or size")
    require((strip_format, strip_width, (first, count)) == (pixel_format, width, rows), "strip: not as announced")
    size = width * count * PIXEL_BYTES[pixel_format]
    require(len(strip) <= HEADER.size + size, "strip: larger than RAW")
    require(coding in (RAW, ZSTD_FILTERED, REPEAT) or coding == codec, "strip: a lossy coding that was not announced")
    if coding != ZSTD_FILTERED:
        require((predictor, layout, flags) == (0, 0, 0) or coding == H264, "strip header: bytes 3 to 5")
    if coding == REPEAT or (coding == ZSTD_FILTERED and predictor == REFERENCE):
        require(reference is not None, "strip: refers to another frame, but its frame has no reference")
    if coding == RAW:
        require(len(body) == size, "RAW: size")
        return bytes(body)
    if coding == REPEAT:
        require(not body, "REPEAT: has bytes")
        return reference
    if coding == JPEG:
        require(pixel_format in (RGB8, R11G11B10F), "JPEG of another format")
        return decode_jpeg(bytes(body), pixel_format, width, count)
    require(coding == ZSTD_FILTERED, f"strip: unknown coding {coding}")
    return decode_zstd(bytes(body), header, pixel_format, size, reference)
