# SPDX-License-Identifier: Apache-2.0
"""Small glTF files: one per feature that the loader supports, and one per kind of damage.

Each file shows triangles in the unit square. Buffers and images are data: URIs, so that a file stands alone.
"""
import base64
import copy
import json
import math
import struct
import zlib

FLOAT, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT = 5126, 5121, 5122, 5123  # component types of glTF
STRIP, FAN, POINTS = 5, 6, 0  # primitive modes
TRIANGLE = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
SQUARE = struct.pack("<12f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0)  # four corners, in the order of a strip
COORDINATES = struct.pack("<6f", 0, 0, 1, 0, 0, 1)


def data_uri(data, mime="application/octet-stream"):
    return f"data:{mime};base64," + base64.b64encode(data).decode()


def png():
    """One grey pixel."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"\0\x80\x80\x80"))
            + chunk(b"IEND", b""))


class Scene:
    """A glTF document that grows by accessors; at first one triangle without a camera."""

    def __init__(self, positions=TRIANGLE, count=3):
        self.data = b""
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                     "nodes": [{"name": "triangle", "mesh": 0}],
                     "meshes": [{"primitives": [{"attributes": {}}]}], "accessors": [], "bufferViews": []}
        self.attributes["POSITION"] = self.accessor(positions, count, "VEC3")

    @property
    def primitive(self):
        return self.json["meshes"][0]["primitives"][0]

    @property
    def attributes(self):
        return self.primitive["attributes"]

    def view(self, data, **members):
        """Number of a new buffer view with `data`."""
        padding = b"\0" * (-len(self.data) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data) + len(padding),
                                         "byteLength": len(data), **members})
        self.data += padding + data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, data, count, kind, component=FLOAT, stride=None, **members):
        """Number of a new accessor; `data` None: without a buffer view."""
        if data is not None:
            members["bufferView"] = self.view(data, **({"byteStride": stride} if stride else {}))
        self.json["accessors"].append({"componentType": component, "count": count, "type": kind, **members})
        return len(self.json["accessors"]) - 1

    def node(self, **members):
        """Number of a new root node."""
        self.json["nodes"].append(members)
        number = len(self.json["nodes"]) - 1
        self.json["scenes"][0]["nodes"].append(number)
        return number

    def use(self, *extensions, is_required=False):
        self.json["extensionsUsed"] = list(extensions)
        if is_required:
            self.json["extensionsRequired"] = list(extensions)

    def material(self, **members):
        self.json["materials"] = [members]
        self.primitive["material"] = 0

    def textured_material(self, **texture):
        self.attributes["TEXCOORD_0"] = self.accessor(COORDINATES, 3, "VEC2")
        self.json["images"] = [{"uri": data_uri(png(), "image/png")}]
        self.json["textures"] = [{"source": 0}]
        self.material(pbrMetallicRoughness={"baseColorTexture": {"index": 0, **texture}})

    def gltf(self):
        document = copy.deepcopy(self.json)
        document.setdefault("buffers", [{"byteLength": len(self.data), "uri": data_uri(self.data)}])
        return json.dumps(document).encode()

    def glb(self):
        document = {**self.json, "buffers": [{"byteLength": len(self.data)}]}
        chunks = b""
        for kind, content, filler in ((b"JSON", json.dumps(document).encode(), b" "), (b"BIN\0", self.data, b"\0")):
            content += filler * (-len(content) % 4)
            chunks += struct.pack("<I4s", len(content), kind) + content
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def with_camera():
    scene = Scene()
    scene.json["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}]
    scene.node(camera=0, translation=[0.3, 0.3, 2.0])
    return scene


def with_emissive_strength():
    scene = Scene()
    scene.use("KHR_materials_emissive_strength")
    scene.material(emissiveFactor=[1, 1, 1], extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 5.0}})
    return scene


def with_texture_transform():
    scene = Scene()
    scene.use("KHR_texture_transform", is_required=True)
    scene.textured_material(extensions={"KHR_texture_transform": {"offset": [0.5, 0], "rotation": 1, "scale": [2, 2]}})
    return scene


def with_glass():
    scene = Scene()
    scene.use("KHR_materials_transmission", "KHR_materials_ior")
    scene.material(extensions={"KHR_materials_transmission": {"transmissionFactor": 0.9},
                               "KHR_materials_ior": {"ior": 1.3}})
    return scene


def with_alpha(mode):
    scene = Scene()
    scene.material(alphaMode=mode, doubleSided=True, pbrMetallicRoughness={"baseColorFactor": [1, 1, 1, 0.6]})
    return scene


def with_colours():
    scene = Scene()
    colours = bytes([255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255])
    scene.attributes["COLOR_0"] = scene.accessor(colours, 3, "VEC4", UNSIGNED_BYTE, normalized=True)
    return scene


def with_node(**members):
    scene = Scene()
    scene.json["nodes"][0].update(members)
    return scene


def with_two_instances():
    scene = Scene()
    scene.node(mesh=0, translation=[2, 0, 0])
    return scene


def with_mode(mode):
    scene = Scene(SQUARE, 4)
    scene.primitive["mode"] = mode
    return scene


def with_indices(*numbers):
    scene = Scene()
    scene.primitive["indices"] = scene.accessor(struct.pack(f"<{len(numbers)}H", *numbers), len(numbers), "SCALAR",
                                                UNSIGNED_SHORT)
    return scene


def with_points():
    """Points beside the triangle: the loader ignores them with a warning."""
    scene = Scene()
    scene.json["meshes"][0]["primitives"].append({"attributes": dict(scene.attributes), "mode": POINTS})
    return scene


def with_interleaved_normals():
    scene = Scene()
    mixed = b"".join(TRIANGLE[12 * i:12 * i + 12] + struct.pack("<3f", 0, 0, 1) for i in range(3))
    view = scene.view(mixed, byteStride=24)
    for name, offset in (("POSITION", 0), ("NORMAL", 12)):
        scene.attributes[name] = scene.accessor(None, 3, "VEC3", bufferView=view, byteOffset=offset)
    return scene


def with_sparse_positions():
    """Zeros, of which two are replaced."""
    scene = Scene()
    indices = {"bufferView": scene.view(struct.pack("<2H", 1, 2)), "componentType": UNSIGNED_SHORT}
    sparse = {"count": 2, "indices": indices, "values": {"bufferView": scene.view(TRIANGLE[12:])}}
    scene.attributes["POSITION"] = scene.accessor(None, 3, "VEC3", sparse=sparse)
    return scene


def quantised():
    scene = Scene()
    scene.use("KHR_mesh_quantization", is_required=True)
    corners = struct.pack("<12h", 0, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0)  # the fourth value is padding
    scene.attributes["POSITION"] = scene.accessor(corners, 3, "VEC3", SHORT, stride=8, normalized=True)
    return scene


def animated():
    scene = Scene()
    times = scene.accessor(struct.pack("<2f", 0, 1), 2, "SCALAR", min=[0], max=[1])
    moves = scene.accessor(struct.pack("<6f", 0, 0, 0, 1, 0, 0), 2, "VEC3")
    half_turn = scene.accessor(struct.pack("<8f", 0, 0, 0, 1, 0, 1, 0, 0), 2, "VEC4")
    scene.json["animations"] = [{
        "samplers": [{"input": times, "output": moves}, {"input": times, "output": half_turn, "interpolation": "STEP"}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}},
                     {"sampler": 1, "target": {"node": 0, "path": "rotation"}}]}]
    return scene


def with_lights():
    scene = Scene()
    scene.use("KHR_lights_punctual")
    scene.json["extensions"] = {"KHR_lights_punctual": {"lights": [
        {"type": "directional"}, {"type": "point", "intensity": 5.0},
        {"type": "spot", "spot": {"outerConeAngle": 0.5}}]}}
    for light in range(3):
        scene.node(translation=[0, 0, 2], extensions={"KHR_lights_punctual": {"light": light}})
    return scene


def with_unknown_extension(is_required):
    scene = Scene()
    scene.use("VENDOR_unheard_of", is_required=is_required)
    return scene


def textured():
    scene = Scene()
    scene.textured_material()
    return scene


def valid():
    """Name -> bytes of files that open."""
    scenes = {
        "no_camera": Scene(), "camera": with_camera(), "emissive_strength": with_emissive_strength(),
        "textured": textured(), "texture_transform": with_texture_transform(), "glass": with_glass(),
        "mask": with_alpha("MASK"), "blend": with_alpha("BLEND"), "colours": with_colours(),
        "mirrored": with_node(scale=[-1, 1, 1]), "instances": with_two_instances(),
        "matrix": with_node(matrix=[2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1]), "strip": with_mode(STRIP),
        "fan": with_mode(FAN), "indexed": with_indices(0, 1, 2, 0, 2, 1), "points": with_points(),
        "interleaved": with_interleaved_normals(), "sparse": with_sparse_positions(), "quantised": quantised(),
        "animated": animated(), "lights": with_lights(), "unknown_extension": with_unknown_extension(is_required=False),
    }
    return {**{f"{name}.gltf": scene.gltf() for name, scene in scenes.items()},
            "binary.glb": with_camera().glb(), "UPPER.GLB": Scene().glb()}


def changed(change):
    """The bytes of the plain triangle after `change(document)`."""
    scene = Scene()
    change(scene.json)
    return scene.gltf()


def damaged():
    """Name -> (bytes, what the reason has to contain) of files that do not open."""
    nan = TRIANGLE[:16] + struct.pack("<f", math.nan) + TRIANGLE[20:]
    circle = [{"mesh": 0}, {"children": [2]}, {"children": [1]}]
    return {
        "empty.gltf": (b"", "json: line 1"),
        "no_json.gltf": (b"solid cube", "json: line 1"),
        "truncated.gltf": (Scene().gltf()[:-40], "json: line 1"),
        "truncated.glb": (Scene().glb()[:-30], "glb"),
        "header_only.glb": (Scene().glb()[:12], "glb header"),
        "version_1.gltf": (changed(lambda json: json["asset"].update(version="1.0")), "asset: version 1.0"),
        "vertex_out_of_range.gltf": (with_indices(0, 1, 7).gltf(), "mesh 0: primitive 0: index 7"),
        "mesh_out_of_range.gltf": (changed(lambda json: json["nodes"][0].update(mesh=7)), "mesh 7 does not exist"),
        "accessor_beyond_view.gltf": (changed(lambda json: json["accessors"][0].update(count=4)),
                                      "accessor 0: ends 12 bytes"),
        "view_beyond_buffer.gltf": (changed(lambda json: json["bufferViews"][0].update(byteLength=40)), "bufferView 0"),
        "huge_count.gltf": (changed(lambda json: json["accessors"][0].update(count=10**9)), "accessor 0: "),
        "negative_count.gltf": (changed(lambda json: json["accessors"][0].update(count=-3)), "accessors/0/count"),
        "buffer_missing.gltf": (changed(lambda json: json.update(buffers=[{"byteLength": 36, "uri": "none.bin"}])),
                                "cannot open 'none.bin'"),
        "buffer_elsewhere.gltf": (changed(lambda json: json.update(buffers=[{"byteLength": 36, "uri": "../a.bin"}])),
                                  "buffer 0: path leaves the scene's folder"),
        "unknown_required_extension.gltf": (with_unknown_extension(is_required=True).gltf(), "'VENDOR_unheard_of'"),
        "cyclic.gltf": (changed(lambda json: json.update(nodes=circle)), "node 1: is its own ancestor"),
        "nan.gltf": (Scene(nan).gltf(), "POSITION: accessor 0: element 1"),
        "no_triangle.gltf": (changed(lambda json: json.update(scenes=[{"nodes": []}])), "scene: shows no triangles"),
        "image_broken.gltf": (textured().gltf().replace(base64.b64encode(png()[:30]), b"A" * 40), "image 0"),
    }
