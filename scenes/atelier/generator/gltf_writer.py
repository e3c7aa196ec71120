# SPDX-License-Identifier: Apache-2.0
"""Smallest glTF 2.0 writer that serves the atelier: one buffer, no interleaving, images beside the file."""

import json

import numpy as np

FLOAT, U8, U16, U32 = 5126, 5121, 5123, 5125
VERTEX_TARGET, INDEX_TARGET = 34962, 34963
U32_FROM_VERTICES = 4096  # u16 would reach 65,535; the denser shapes use u32 so that both are exercised


def rounded(values):
    """JSON numbers short enough to read and equal on every machine."""
    return [round(float(v), 6) + 0.0 for v in np.ravel(values)]


class GltfWriter:
    def __init__(self, generator):
        self.document = {
            "asset": {"version": "2.0", "generator": generator, "copyright": "CC0 1.0"},
            "extensionsUsed": [],
            "scene": 0,
            "scenes": [{"name": "Atelier", "nodes": []}],
        }
        self.binary = bytearray()
        self.images = {}  # uri -> (array, save options)
        self.triangle_counts = []  # per mesh
        self.shape_accessors_ = {}

    def add(self, kind, entry):
        """Appends to a top-level array and returns the index."""
        self.document.setdefault(kind, []).append(entry)
        return len(self.document[kind]) - 1

    def use_extension(self, name):
        if name not in self.document["extensionsUsed"]:
            self.document["extensionsUsed"].append(name)

    def add_accessor(self, array, component, kind, target=None, with_range=False, normalized=False):
        array = np.ascontiguousarray(array)
        self.binary += b"\0" * (-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": array.nbytes}
        if target:
            view["target"] = target
        self.binary += array.tobytes()
        accessor = {"bufferView": self.add("bufferViews", view), "componentType": component, "count": len(array), "type": kind}
        if normalized:
            accessor["normalized"] = True
        if with_range:  # exact float32 values, as the validator compares
            flat = array.reshape(len(array), -1)
            accessor["min"], accessor["max"] = ([float(v) for v in f(axis=0)] for f in (flat.min, flat.max))
        return self.add("accessors", accessor)

    def add_floats(self, array, kind, **options):
        return self.add_accessor(np.asarray(array, dtype="<f4"), FLOAT, kind, **options)

    def accessors_of(self, shape):
        """Accessors are shared by all meshes made from the same shape."""
        if id(shape) in self.shape_accessors_:
            return self.shape_accessors_[id(shape)][1:]
        attributes = {
            "POSITION": self.add_floats(shape.positions, "VEC3", target=VERTEX_TARGET, with_range=True),
            "NORMAL": self.add_floats(shape.normals, "VEC3", target=VERTEX_TARGET),
            "TEXCOORD_0": self.add_floats(shape.uvs, "VEC2", target=VERTEX_TARGET),
        }
        if shape.colors is not None:
            rgba = np.concatenate([shape.colors, np.ones((len(shape.colors), 1))], axis=1)
            rgba = np.rint(np.clip(rgba, 0, 1) * 255).astype("u1")
            attributes["COLOR_0"] = self.add_accessor(rgba, U8, "VEC4", target=VERTEX_TARGET, normalized=True)
        wide = len(shape.positions) >= U32_FROM_VERTICES
        flat = shape.triangles.reshape(-1).astype("<u4" if wide else "<u2")
        indices = self.add_accessor(flat, U32 if wide else U16, "SCALAR", target=INDEX_TARGET)
        self.shape_accessors_[id(shape)] = (shape, attributes, indices)  # keeps the shape, so its id stays taken
        return attributes, indices

    def add_mesh(self, name, *parts):
        """parts: (shape, material index)."""
        primitives = []
        for shape, material in parts:
            attributes, indices = self.accessors_of(shape)
            primitives.append({"attributes": attributes, "indices": indices, "material": material})
        self.triangle_counts.append(sum(len(s.triangles) for s, _ in parts))
        return self.add("meshes", {"name": name, "primitives": primitives})

    def add_node(self, name, parent=None, **fields):
        for key in ("translation", "rotation", "scale", "matrix"):
            if key in fields:
                fields[key] = rounded(fields[key])
        node = self.add("nodes", {"name": name, **fields})
        holder = self.document["scenes"][0].setdefault("nodes", []) if parent is None else self.document["nodes"][parent].setdefault("children", [])
        holder.append(node)
        return node

    def add_texture(self, uri, image, quality=88):
        self.images[uri] = (image, quality)
        sampler = 0 if self.document.get("samplers") else self.add("samplers", {"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497})
        source = self.add("images", {"name": uri.rsplit(".", 1)[0], "uri": uri})
        return self.add("textures", {"sampler": sampler, "source": source})

    def add_animation(self, name, *tracks):
        """tracks: (node, path, times in seconds, values); all linear."""
        animation = {"name": name, "channels": [], "samplers": []}
        for node, path, times, values in tracks:
            kind = "VEC4" if path == "rotation" else "VEC3"
            inputs = self.add_floats(np.asarray(times, dtype="<f4"), "SCALAR", with_range=True)
            sampler = {"input": inputs, "output": self.add_floats(values, kind), "interpolation": "LINEAR"}
            animation["channels"].append({"sampler": len(animation["samplers"]), "target": {"node": node, "path": path}})
            animation["samplers"].append(sampler)
        return self.add("animations", animation)

    def triangle_count(self):
        return sum(self.triangle_counts[n["mesh"]] for n in self.document["nodes"] if "mesh" in n)

    def save(self, folder, name):
        from PIL import Image

        folder.mkdir(parents=True, exist_ok=True)
        self.document["buffers"] = [{"uri": f"{name}.bin", "byteLength": len(self.binary)}]
        self.document["extensionsUsed"].sort()
        (folder / f"{name}.bin").write_bytes(self.binary)
        (folder / f"{name}.gltf").write_text(json.dumps(self.document, indent=1) + "\n")
        for uri, (image, quality) in self.images.items():
            pixels = Image.fromarray(np.rint(np.clip(image, 0, 1) * 255).astype("u1"))
            options = {"optimize": True} if uri.endswith(".png") else {"quality": quality, "subsampling": 0}
            pixels.save(folder / uri, **options)
