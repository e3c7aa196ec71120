#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the files of this folder. tests/scene/malformed_gltf_test.cpp says how each one must be refused."""

import base64
import copy
import json
import pathlib
import struct
import zlib

FOLDER = pathlib.Path(__file__).parent
POSITIONS = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
NORMALS = struct.pack("<9f", 0, 0, 1, 0, 0, 1, 0, 0, 1)
INDICES = struct.pack("<3H2x", 0, 1, 2)


def data_uri(data, mime="application/octet-stream"):
    return f"data:{mime};base64," + base64.b64encode(data).decode()


def valid(data=POSITIONS + NORMALS + INDICES):
    """One triangle with normals and indices."""
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "triangle", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 36},
            {"buffer": 0, "byteOffset": 72, "byteLength": 6},
        ],
        "buffers": [{"byteLength": 80, "uri": data_uri(data)}],
    }


def write(name, document):
    text = document if isinstance(document, (str, bytes)) else json.dumps(document, separators=(",", ":"))
    (FOLDER / name).write_bytes(text if isinstance(text, bytes) else text.encode())


def change(name, path, value):
    """The valid file with one member replaced; `path` is "accessors/0/count"."""
    document = valid()
    *parents, last = [int(key) if key.isdigit() else key for key in path.split("/")]
    target = document
    for key in parents:
        target = target[key]
    target[last] = value
    write(name, document)


def with_image(name, image):
    document = valid()
    document["images"] = [image]
    document["textures"] = [{"source": 0}]
    document["materials"] = [{"normalTexture": {"index": 0}}]
    document["meshes"][0]["primitives"][0]["material"] = 0
    write(name, document)


def png_header(width, height):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"\0" * 64)) + chunk(b"IEND", b"")


def glb(document, binary, length=None, kind=b"JSON", json_length=None):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    json_size = len(text) if json_length is None else json_length
    body = struct.pack("<I", json_size) + kind + text + struct.pack("<I", len(binary)) + b"BIN\0" + binary
    return b"glTF" + struct.pack("<II", 2, 12 + len(body) if length is None else length) + body


def write_containers():
    document = valid()
    document["buffers"] = [{"byteLength": 80}]
    binary = POSITIONS + NORMALS + INDICES
    write("glb_version_1.glb", glb(document, binary).replace(b"glTF\2", b"glTF\1", 1))
    write("glb_length_beyond_file.glb", glb(document, binary, length=1 << 31))
    write("glb_chunk_beyond_file.glb", glb(document, binary, json_length=0xFFFFFFF0))
    write("glb_without_json.glb", glb(document, binary, kind=b"TEXT"))
    write("glb_short_binary.glb", glb(document, binary[:40]))
    write("glb_header_only.glb", b"glTF" + struct.pack("<I", 2))
    write("empty.gltf", "")
    write("not_json.gltf", "<gltf/>")
    write("not_utf8.gltf", b'{"asset":{"version":"2.0","generator":"\xff\xfe"}}')
    write("root_is_a_list.gltf", "[]")
    write("depth_bomb.gltf", '{"asset":{"version":"2.0"},"extras":' + "[" * 5000 + "]" * 5000 + "}")
    write("number_too_large.gltf", '{"asset":{"version":"2.0"},"nodes":[{"translation":[1e999,0,0]}]}')
    write("nan_literal.gltf", '{"asset":{"version":"2.0"},"nodes":[{"translation":[NaN,0,0]}]}')
    write("no_asset.gltf", "{}")
    write("version_1.gltf", {"asset": {"version": "1.0"}})
    write("version_3_needed.gltf", {"asset": {"version": "2.0", "minVersion": "2.1"}})
    write("empty_scene.gltf", {"asset": {"version": "2.0"}})


def write_references():
    change("accessor_beyond_view.gltf", "accessors/0/count", 4)
    change("accessor_offset_beyond_view.gltf", "accessors/0/byteOffset", 1000)
    change("accessor_huge_count.gltf", "accessors/0/count", 1000000000)
    change("accessor_count_overflow.gltf", "accessors/0/count", (1 << 64) // 12 + 2)
    change("accessor_count_zero.gltf", "accessors/0/count", 0)
    change("accessor_count_negative.gltf", "accessors/0/count", -3)
    change("accessor_count_fraction.gltf", "accessors/0/count", 2.5)
    change("accessor_double.gltf", "accessors/0/componentType", 5130)
    change("accessor_type.gltf", "accessors/0/type", "VEC5")
    change("accessor_wrong_shape.gltf", "accessors/0/type", "SCALAR")
    document = valid()
    del document["accessors"][0]["bufferView"]
    document["accessors"][0]["count"] = document["accessors"][1]["count"] = 1000000000
    del document["accessors"][1]["bufferView"]
    write("accessor_huge_without_view.gltf", document)
    change("view_missing.gltf", "accessors/0/bufferView", 3)
    change("view_index_truncated.gltf", "accessors/0/bufferView", 1 << 32)
    change("view_beyond_buffer.gltf", "bufferViews/0/byteLength", 81)
    change("view_offset_overflow.gltf", "bufferViews/0/byteOffset", (1 << 64) - 30)
    change("view_stride_too_small.gltf", "bufferViews/0/byteStride", 8)
    change("view_stride_odd.gltf", "bufferViews/0/byteStride", 13)
    change("buffer_missing.gltf", "bufferViews/0/buffer", 1)
    change("buffer_too_short.gltf", "buffers/0/byteLength", 81)
    change("index_beyond_vertices.gltf", "accessors/1", {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC3"})
    bad_index = valid(POSITIONS + NORMALS + struct.pack("<3H2x", 0, 1, 3))
    write("index_value.gltf", bad_index)
    change("indices_of_floats.gltf", "meshes/0/primitives/0/indices", 0)
    change("primitive_without_attributes.gltf", "meshes/0/primitives/0", {})
    change("primitive_without_position.gltf", "meshes/0/primitives/0/attributes", {"NORMAL": 1})
    change("primitive_mode.gltf", "meshes/0/primitives/0/mode", 9)
    change("primitive_two_corners.gltf", "accessors/2/count", 2)
    change("mesh_missing.gltf", "nodes/0/mesh", 7)
    change("material_missing.gltf", "meshes/0/primitives/0/material", 0)
    change("scene_missing.gltf", "scene", 2)
    change("scene_node_missing.gltf", "scenes/0/nodes", [5])
    change("cycle_of_one.gltf", "nodes/0/children", [0])
    change("cycle_of_two.gltf", "nodes", [{"mesh": 0}, {"children": [2]}, {"children": [1]}])
    change("nodes_are_numbers.gltf", "nodes", [1, 2, 3])
    change("mesh_is_text.gltf", "nodes/0/mesh", "0")
    sparse = {"count": 1, "indices": {"bufferView": 2, "componentType": 5123}, "values": {"bufferView": 1}}
    for name, member, value in (
        ("sparse_huge", "count", 2000000000),
        ("sparse_missing_view", "values", {"bufferView": 9}),
        ("sparse_float_indices", "indices", {"bufferView": 2, "componentType": 5126}),
        ("sparse_offset", "values", {"bufferView": 1, "byteOffset": 30}),
        ("sparse_unsorted", "indices", {"bufferView": 2, "byteOffset": 2, "componentType": 5123}),
    ):
        broken = copy.deepcopy(sparse)
        broken[member] = value
        broken["count"] = 2 if name == "sparse_unsorted" else broken["count"]
        document = valid(POSITIONS + NORMALS + struct.pack("<3H2x", 0, 2, 1)) if name == "sparse_unsorted" else valid()
        document["accessors"][0]["sparse"] = broken
        write(name + ".gltf", document)


def write_values():
    write("nan_position.gltf", valid(POSITIONS[:12] + struct.pack("<f", float("nan")) + POSITIONS[16:] + NORMALS + INDICES))
    write("infinite_normal.gltf", valid(POSITIONS + struct.pack("<f", float("inf")) + NORMALS[4:] + INDICES))
    change("required_extension.gltf", "extensionsRequired", ["VENDOR_unheard_of"])
    change("required_gpu_instancing.gltf", "extensionsRequired", ["KHR_lights_punctual", "EXT_mesh_gpu_instancing"])


def write_uris():
    change("uri_missing_file.gltf", "buffers/0/uri", "none.bin")
    change("uri_parent.gltf", "buffers/0/uri", "../malformed_gltf/generate.py")
    change("uri_encoded_parent.gltf", "buffers/0/uri", "%2e%2e/malformed_gltf/generate.py")
    change("uri_absolute.gltf", "buffers/0/uri", "/etc/passwd")
    change("uri_scheme.gltf", "buffers/0/uri", "file:///etc/passwd")
    change("uri_folder.gltf", "buffers/0/uri", ".")
    change("uri_broken_data.gltf", "buffers/0/uri", "data:;base64,*")
    change("uri_absent.gltf", "buffers/0", {"byteLength": 80})
    with_image("image_missing.gltf", {"uri": "none.png"})
    with_image("image_parent.gltf", {"uri": "../secret.png"})
    with_image("image_without_source.gltf", {"name": "nothing"})
    with_image("image_missing_view.gltf", {"bufferView": 12, "mimeType": "image/png"})
    with_image("image_no_image.gltf", {"uri": data_uri(b"not an image", "image/png")})
    with_image("image_huge.gltf", {"uri": data_uri(png_header(60000, 60000), "image/png")})
    with_image("image_truncated.gltf", {"uri": data_uri(png_header(64, 64)[:60], "image/png")})


if __name__ == "__main__":
    write_containers()
    write_references()
    write_values()
    write_uris()
