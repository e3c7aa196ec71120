# SPDX-License-Identifier: Apache-2.0
"""A client that was written from docs/protocol.md and believes nothing else, against the real server in all modes. What
it decodes is compared with what fieldcast-client writes for the same frames, and one mode with the other.

    python3 tests/protocol/strict_client_test.py SERVER CLIENT [TEST …]

The server starts the scene over every few frames with the same seeds, so that frames of equal scene time are equal.
Without the Python packages or a Vulkan device it says so and exits with 77, which ctest shows as skipped.
"""
import csv
import math
import pathlib
import re
import statistics
import struct
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/hostile"))
import packages

packages.NEEDED += ("zstandard", "PIL")
packages.run_where_they_are()
FOLDER = tempfile.TemporaryDirectory()
packages.make_messages(pathlib.Path(FOLDER.name) / "messages")

from PIL import Image
import connection
import frame as frames
import processes
import strict_session
import strip
from fieldcast.v1 import catalog_pb2 as catalog
from fieldcast.v1 import light_field_pb2 as v1
from fieldcast.v1 import types_pb2 as types

LOOP = 3  # frames until the scene starts over
STEP_NS = 125_000_000  # from one to the next: few enough for this client to keep up
FLAGS = ["--scene", "scenes/atelier/atelier.gltf", "--size", "64x36", "--clock", "frames", "--frames", str(LOOP),
         "--fps", "8", "--fixed-camera", "--largest-grid", "3x3", "--convergence", "3", "--spacing", "0.06"]
VIEWS, SCENE, WARP = types.DELIVERY_MODE_VIEWS, types.DELIVERY_MODE_SCENE, types.DELIVERY_MODE_WARP
RAW, ZSTD, JPEG = types.CODEC_RAW, types.CODEC_ZSTD_FILTERED, types.CODEC_JPEG


def prefer(semantics, *codecs, formats=(), quality=0):
    return [v1.CodecPreference(semantic=s, codecs=codecs, formats=formats, quality=quality) for s in semantics]


def whole_loop(came):
    """Where in (frame id, scene time) a loop begins of which nothing is missing; None: nowhere yet. Not the first one:
    what views keep from frame to frame depends on which other views were rendered then."""
    starts = [i for i, (_, time_ns) in enumerate(came) if time_ns == 0]
    for start in starts[1:]:
        if [number - came[start][0] for number, _ in came[start:start + LOOP]] == list(range(LOOP)):
            return start
    return None


def words(part, code="I"):
    return struct.unpack(f"<{len(part.pixels) // struct.calcsize(code)}{code}", part.pixels)


def direction(word, bits=16):
    """Of an octahedral pixel."""
    most = (1 << bits - 1) - 1
    signed = [(value ^ 1 << bits - 1) - (1 << bits - 1) for value in (word & (1 << bits) - 1, word >> bits)]
    x, y = (max(value / most, -1.0) for value in signed)
    z = 1 - abs(x) - abs(y)
    if z < 0:
        x, y = (1 - abs(y)) * math.copysign(1, x), (1 - abs(x)) * math.copysign(1, y)
    length = math.sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length


class Strict(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(FOLDER.name)
        try:
            cls.server = processes.Server(SERVER, cls.folder, FLAGS)
        except processes.NotStarted as problem:
            if "Vulkan d" not in str(problem):
                raise
            print("skipped: no Vulkan device")
            sys.exit(packages.SKIPPED)
        cls.target = connection.Target(cls.server.port)

    @classmethod
    def tearDownClass(cls):
        cls.server.stop()

    def play(self, mode, keeps_key_frames=True, **wishes):
        """A loop of frames by scene time, and the session."""
        with connection.Connection(self.target) as line:
            session = strict_session.Session(line, keeps_key_frames)
            answer = session.configure(modes=[mode], **wishes)
            self.assertIsInstance(answer, v1.Configured, answer)
            came, start = [], None
            while start is None:
                came += session.frames(1)
                start = whole_loop([(done.id, done.header.scene_time_ns) for done in came])
            self.assertEqual(0, session.close(), "status OK after the half-close")
        found = {done.header.scene_time_ns: done for done in came[start:]}
        self.assertEqual([STEP_NS * i for i in range(LOOP)], sorted(found))
        return found, session

    def expect_equal(self, one, other):
        """The same pixels in all frames of equal scene time."""
        self.assertEqual(set(one), set(other))
        for time_ns, done in one.items():
            for part, twin in zip(done.parts, other[time_ns].parts, strict=True):
                self.assertEqual(part.pixels, twin.pixels, f"semantic {part.semantic} at {time_ns} ns")

    def test_views_in_all_codecs(self):
        grid = types.Grid(rows=2, cols=3)  # its base is part 1
        zstd, session = self.play(VIEWS, grid=grid)
        self.assertGreater(session.other["heartbeat"], 0)
        raw, _ = self.play(VIEWS, grid=grid, codecs=prefer([frames.COLOUR], RAW), keeps_key_frames=False,
                           chunk_bytes=16 << 10)
        self.expect_equal(zstd, raw)
        lossy, _ = self.play(VIEWS, grid=grid, codecs=prefer([frames.COLOUR], JPEG, quality=90), keeps_key_frames=False)
        for time_ns, done in lossy.items():
            self.assertIn((strip.JPEG, 0), done.codings)
            for part, twin in zip(done.parts, raw[time_ns].parts):
                apart = statistics.fmean(abs(a - b) for a, b in zip(part.pixels, twin.pixels))
                self.assertLess(apart, 8, "a quarter of the largest step of the tables at quality 90, which is 31")

    def test_views_are_those_of_our_client(self):
        ours, _ = self.play(VIEWS)
        out = self.folder / "out"
        subprocess.run([CLIENT, "--server", f"127.0.0.1:{self.server.port}", "--grid", "3x3", "--frames", str(5 * LOOP),
                        "--save", "all", "--write", "views", "--out", out, "--frame-log", self.folder / "log.csv"],
                       check=True, timeout=120, stdout=subprocess.DEVNULL)
        with open(self.folder / "log.csv", encoding="utf-8") as log:
            rows = [(int(row["frame"]), int(row["scene_time_ns"])) for row in csv.DictReader(log)]
        rows = [(frame_id, time_ns) for frame_id, time_ns in rows if (out / f"frame_{frame_id:08}").exists()]
        start = whole_loop(rows)
        self.assertIsNotNone(start, rows)
        for frame_id, time_ns in rows[start:start + LOOP]:
            for number, part in enumerate(ours[time_ns].parts):
                name = f"frame_{frame_id:08}/view_r{number // 3}_c{number % 3}.png"
                self.assertEqual(bytes(part.pixels), Image.open(out / name).convert("RGB").tobytes(), name)

    def test_scene_planes(self):
        names = [frames.DIFFUSE, frames.SPECULAR, frames.DEPTH, frames.NORMAL, frames.ID, frames.MATERIAL]
        found, session = self.play(SCENE, planes=v1.PLANE_SET_WITH_G_BUFFER)
        self.assertEqual(names, [plane.semantic for plane in session.answer.planes])
        band = session.answer.guard_band
        height = 36 + band.top_px + band.bottom_px
        self.assertEqual([3 * height] * 2 + [height] * 4, [plane.height_px for plane in session.answer.planes])
        raw, _ = self.play(SCENE, planes=v1.PLANE_SET_WITH_G_BUFFER, codecs=prefer(names, RAW))
        self.expect_equal(found, raw)
        for done in found.values():
            self.assertEqual(2, done.header.layer_count, "the atelier has BLEND materials")
            if done.header.key_frame_id not in (0, done.id):  # the camera rests, and so does most of the scene
                self.assertTrue(done.codings & {(strip.REPEAT, 0), (ZSTD, strip.REFERENCE)}, done.codings)
            self.check_g_buffer(done)
        coarse, _ = self.play(SCENE, planes=v1.PLANE_SET_WITH_G_BUFFER,
                              codecs=prefer([frames.NORMAL], formats=[types.PLANE_FORMAT_OCT2X8]))
        for time_ns, done in coarse.items():
            fine = words(found[time_ns].find(frames.NORMAL))
            for word, exact in zip(words(done.find(frames.NORMAL), "H"), fine):
                cosine = sum(a * b for a, b in zip(direction(word, 8), direction(exact)))
                self.assertGreater(cosine, math.cos(math.radians(1)))

    def check_g_buffer(self, done):
        lit = [words(done.find(semantic)) for semantic in (frames.DIFFUSE, frames.SPECULAR)]
        planes = zip(words(done.find(frames.DEPTH), "f"), words(done.find(frames.NORMAL)), words(done.find(frames.ID)),
                     words(done.find(frames.MATERIAL), "H"), *lit)
        hits = 0
        for depth, normal, name, material, *light in planes:
            if name == 0xFFFFFFFF:
                self.assertEqual((math.inf, 0, 0, [0, 0]), (depth, normal, material, light))
            else:
                hits += 1
                self.assertTrue(0 < depth < 1e3 and name >> 12 < 1000 and name & 0xFFF < 100, (depth, name))
        self.assertGreater(hits, 1000)
        for plane in lit:
            self.assertTrue(all(math.isfinite(sum(strip.unpack_light(word))) for word in plane))

    def test_light_in_one_plane_and_as_jpeg(self):
        both, _ = self.play(SCENE)
        total, _ = self.play(SCENE, planes=v1.PLANE_SET_TOTAL_LIGHT)
        lossy, _ = self.play(SCENE, codecs=prefer([frames.DIFFUSE, frames.SPECULAR], JPEG, quality=90),
                             keeps_key_frames=False)
        for time_ns, done in both.items():
            kinds = [list(map(strip.unpack_light, words(done.find(s)))) for s in (frames.DIFFUSE, frames.SPECULAR)]
            for one, diffuse, specular in zip(words(total[time_ns].parts[0]), *kinds):
                for mixed, d, s in zip(strip.unpack_light(one), diffuse, specular):
                    slack = max(d, s) / 32 + 1e-6  # a step of blue's mantissa
                    self.assertTrue(min(d, s) - slack <= mixed <= max(d, s) + slack, (mixed, d, s))
            self.assertIn((strip.JPEG, 0), lossy[time_ns].codings)
            for word, exact in zip(words(lossy[time_ns].find(frames.DIFFUSE))[::7], kinds[0][::7]):
                self.assertLess(abs(strip.unpack_light(word)[1] - exact[1]), 0.3 * exact[1] + 0.2)

    def test_warp_planes_and_cameras(self):
        warp, session = self.play(WARP, warp_planes=[v1.WARP_PLANE_RESIDUAL, v1.WARP_PLANE_ID])
        scene, _ = self.play(SCENE, planes=v1.PLANE_SET_WITH_G_BUFFER)
        views, _ = self.play(VIEWS)
        self.assertEqual([frames.COLOUR, frames.INVERSE_DEPTH, frames.RESIDUAL_COLOUR, frames.RESIDUAL_INVERSE_DEPTH,
                          frames.ID], [plane.semantic for plane in session.answer.planes])
        for time_ns, done in warp.items():
            depths = words(scene[time_ns].find(frames.DEPTH), "f")
            for steps, depth in zip(words(done.find(frames.INVERSE_DEPTH), "H"), depths):
                exact = min(1 / (depth * done.header.inverse_depth_unit), 65535)
                self.assertLessEqual(abs(steps - exact), 0.502, "half a step, and single precision")
            self.assertEqual(done.find(frames.ID).pixels, scene[time_ns].find(frames.ID).pixels)
            self.check_residual(done, views[time_ns])
            self.check_cameras(done, views[time_ns])

    def check_residual(self, done, views):
        """Tiles of the corners show what the same views show that were sent as views."""
        layer, source, colour = done.header.residual, done.header.source, done.find(frames.RESIDUAL_COLOUR)
        across, down = -(-source.width_px // 8), -(-source.height_px // 8)
        positions = frames.lattice_positions(views.header.views.view_set.grid)
        corners = [positions.index((p.row_halves, p.col_halves)) for p in layer.positions]
        self.assertEqual([0, 8, 2, 6], corners, "top left, bottom right, top right, bottom left")
        number = -1
        for slot, gap in enumerate(layer.gaps):
            number += gap + 1
            view, at = views.parts[corners[number // (across * down)]], number % (across * down)
            for y in range(min(8, source.height_px - at // across * 8)):
                from_view = 3 * ((at // across * 8 + y) * source.width_px + at % across * 8)
                from_tile = 3 * ((slot // 128 * 8 + y) * 1024 + slot % 128 * 8)
                self.assertEqual(view.pixels[from_view:from_view + 24], colour.pixels[from_tile:from_tile + 24], slot)
        self.assertLess(number, across * down * len(corners))

    def check_cameras(self, done, views):
        """Moves the source's pixels into the corner views, the nearest wins. Half of them must show what the view does:
        measured 1 step of green apart; with another sign 9 and more, without the shear of convergence 5 and more."""
        colour, steps = done.find(frames.COLOUR).pixels, words(done.find(frames.INVERSE_DEPTH), "H")
        source, band, grid = done.header.source, done.header.guard_band, views.header.views.view_set.grid
        width, _ = frames.widened(done.header)
        for part, (row, col) in zip(views.parts, frames.lattice_positions(grid)):
            if row == 0 or col == 0:
                continue
            moved = (col / 2 * grid.spacing_x_m, row / 2 * grid.spacing_y_m)
            shear = [o * source.focal_px / grid.convergence_m for o in moved]
            centre = (part.width / 2 + shear[0], part.height / 2 + shear[1])
            seen = {}
            for pixel, step in enumerate(steps):
                inverse_depth = step * done.header.inverse_depth_unit
                at = [place + 0.5 - p - inverse_depth * source.focal_px * o + c for place, p, o, c in zip(
                    (pixel % width, pixel // width),
                    (source.principal_x_px + band.left_px, source.principal_y_px + band.top_px), moved, centre)]
                x, y = map(math.floor, at)
                if 0 <= x < part.width and 0 <= y < part.height:
                    seen[x, y] = max(seen.get((x, y), (-1, 0)), (step, pixel))
            apart = [abs(colour[3 * pixel + 1] - part.pixels[3 * (y * part.width + x) + 1])
                     for (x, y), (_, pixel) in seen.items()]
            self.assertGreater(len(apart), 0.8 * part.width * part.height)
            self.assertLess(statistics.median(apart), 3, f"view at half steps ({row}, {col})")

    def test_refusals_change_nothing(self):
        refusals = [
            ("channel", v1.REFUSAL_REASON_NOT_FOUND, {"channel": "nowhere"}),
            ("modes", v1.REFUSAL_REASON_UNSUPPORTED, {"modes": [99]}),
            ("grid.rows", v1.REFUSAL_REASON_INVALID, {"grid": {"rows": 0, "cols": 3}}),
            ("grid", v1.REFUSAL_REASON_INVALID, {"grid": {"rows": 9, "cols": 9}}),
            ("grid.spacing_x_m", v1.REFUSAL_REASON_INVALID, {"grid": {"rows": 1, "cols": 1, "spacing_x_m": -1.0}}),
            ("view_width_px", v1.REFUSAL_REASON_INVALID, {"view_width_px": 65, "view_height_px": 36}),
            ("view_height_px", v1.REFUSAL_REASON_INVALID, {"view_width_px": 64}),
            ("fovy_rad", v1.REFUSAL_REASON_INVALID, {"fovy_rad": 3.0}),
            ("chunk_bytes", v1.REFUSAL_REASON_INVALID, {"chunk_bytes": 1000}),
            ("max_frames_per_second", v1.REFUSAL_REASON_INVALID, {"max_frames_per_second": -1.0}),
            ("codecs", v1.REFUSAL_REASON_INVALID, {"codecs": prefer([frames.COLOUR], JPEG, quality=101)}),
            ("codecs", v1.REFUSAL_REASON_UNSUPPORTED, {"modes": [SCENE], "planes": v1.PLANE_SET_WITH_G_BUFFER,
                                                       "codecs": prefer([frames.DEPTH], JPEG)}),
        ]
        with connection.Connection(self.target) as line:
            session = strict_session.Session(line)
            granted = session.configure(modes=[99, SCENE, VIEWS])
            self.assertEqual((SCENE, 1), (granted.mode, granted.epoch))
            for field, reason, wishes in refusals:
                answer = session.configure(**wishes)
                self.assertEqual((field, reason), (answer.field, answer.reason), answer)
            self.assertEqual(1, session.frames(1)[0].parts[0].semantic, "still of the first epoch: DIFFUSE")
            again = session.configure(grid={"rows": 1, "cols": 2}, max_frames_per_second=1e9)
            self.assertEqual(2, again.epoch)
            self.assertEqual(2, len(session.frames(1)[0].parts))
            session.send(time_sync=v1.TimeSyncRequest(client_send_ns=7))
            session.read_until(lambda: "time_sync" in session.other)
            self.assertEqual(0, session.close())

    def test_bundle(self):
        with connection.Connection(self.target) as line:
            info = catalog.GetServerInfoResponse.FromString(line.ask("/fieldcast.v1.Catalog/GetServerInfo"))
            limits = info.limits
            self.assertEqual((72, 64, 36), (limits.max_views, limits.max_view_width_px, limits.max_view_height_px))
            channel, = catalog.ListChannelsResponse.FromString(line.ask("/fieldcast.v1.Catalog/ListChannels")).channels
            self.assertEqual(("atelier", 64, 36), (channel.name, channel.source_width_px, channel.source_height_px))
            whole, status = strict_session.fetch(line, catalog, channel.scene_hash)
            self.assertEqual(0, status)
            sky, main, environment, files = strict_session.read_bundle(whole, channel.scene_hash)
            self.assertEqual(([0.5, struct.unpack("<f", struct.pack("<f", 0.7))[0], 1.0], b"atelier.gltf", b""),
                             (sky, main, environment))
            for path, data in files.items():
                self.assertEqual((ROOT / "scenes/atelier" / path.decode()).read_bytes(), data, path)
            self.assertEqual((whole[1000:], 0), strict_session.fetch(line, catalog, channel.scene_hash, 1000))
            self.assertEqual((b"", 0), strict_session.fetch(line, catalog, channel.scene_hash, len(whole)))
            statuses = [strict_session.fetch(line, catalog, *asked)[1] for asked in (
                (b"short",), (bytes(32),), (channel.scene_hash, len(whole) + 1))]
            self.assertEqual([3, 5, 11], statuses, "INVALID_ARGUMENT, NOT_FOUND, OUT_OF_RANGE")

    def test_messages_that_are_none(self):
        for message, status in ((b"\xff\xff", 3), (bytes(70000), 8)):  # INVALID_ARGUMENT, RESOURCE_EXHAUSTED
            with connection.Connection(self.target) as line:
                session = strict_session.Session(line)
                session.call.send(message)
                self.assertEqual(status, session.call.finish(strict_session.PATIENCE_S))
        with connection.Connection(self.target) as line:
            call = line.call("/fieldcast.v1.Catalog/Nothing")
            self.assertEqual(12, call.finish(strict_session.PATIENCE_S), "UNIMPLEMENTED")


class Document(unittest.TestCase):
    """Examples of the page, and the bytes of tests/data/wire, which decode for ever."""

    FORMATS = {"r11g11b10f": 1, "f32": 2, "oct2x16": 3, "u32": 4, "rg8": 5, "rgb8": 6, "r16": 20, "oct2x8": 30}
    KEPT = ROOT / "tests/data/wire/v1"
    ROWS = (3, 15)

    def hexadecimal(self, begin, end):
        """Bytes of the page's example between two lines; what is no pair of digits ends a line."""
        text = (ROOT / "docs/protocol.md").read_text(encoding="utf-8")
        lines = text[text.index(begin):text.index(end, text.index(begin)) + len(end)].splitlines()
        return bytes.fromhex(" ".join(re.match(r"(?:[0-9A-F]{2}\b\s*)*", line).group() for line in lines))

    def test_bundle_of_the_example(self):
        data = self.hexadecimal("46 43 42 55", "32 2E 30 22 7D 7D")
        page = (ROOT / "docs/protocol.md").read_text(encoding="utf-8")
        digest = re.search("Its hash is `([0-9a-f]{64})`", page).group(1)
        sky, main, environment, files = strict_session.read_bundle(data, bytes.fromhex(digest))
        self.assertEqual((b"tiny.gltf", b"", {main: b'{"asset":{"version":"2.0"}}'}), (main, environment, files))
        self.assertAlmostEqual(0.7, sky[1], 6)

    def test_strips_of_the_example(self):
        raw = self.hexadecimal("01 01 05 00", "0A C8 0C C9 0B C8 0E CB")
        packed = self.hexadecimal("01 02 05 02", "0A 02 01 01 C8 01 00 02")
        self.assertEqual(bytes([10, 200, 12, 201, 11, 200, 14, 203]), strip.decode(raw, strip.RG8, 2, (0, 2), ZSTD))
        with self.assertRaises(strip.Violation):  # larger than RAW, as the page says
            strip.decode(packed, strip.RG8, 2, (0, 2), ZSTD)
        self.assertEqual(9 + 8, struct.unpack_from("<I", packed, 12)[0])

    def test_kept_strips(self):
        for name, pixel_format in self.FORMATS.items():
            kept = {kind: (self.KEPT / f"{name}_{kind}.strip").read_bytes() for kind in ("raw", "zstd", "predicted")}
            raw, *others = (strip.decode(data, pixel_format, 33, self.ROWS, ZSTD) for data in kept.values())
            self.assertEqual([raw, raw], others, name)

    def test_malformed_strips(self):
        for path in (self.KEPT / "malformed").iterdir():
            for pixel_format in self.FORMATS.values():
                with self.assertRaises(strip.Violation, msg=path.name):
                    strip.decode(path.read_bytes(), pixel_format, 33, self.ROWS, ZSTD)


if __name__ == "__main__":
    SERVER, CLIENT = (pathlib.Path(program).resolve() for program in sys.argv[1:3])
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
