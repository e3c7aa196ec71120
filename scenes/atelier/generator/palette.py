# SPDX-License-Identifier: Apache-2.0
"""Materials of the atelier and the textures they use."""

from . import textures as tx


class Palette:
    """Creates the materials by name: palette["rug"]."""

    def __init__(self, writer, rng):
        self.writer = writer
        self.by_name = {}
        self.add_textured(rng)
        self.add_plain()
        self.add_special(rng)

    def __getitem__(self, name):
        return self.by_name[name]

    def add(self, name, color=(1, 1, 1), roughness=0.5, metallic=0.0, base=None, surface=None, normal=None, alpha=1.0, **extra):
        pbr = {"baseColorFactor": [*color, alpha], "roughnessFactor": roughness, "metallicFactor": metallic}
        if base is not None:
            pbr["baseColorTexture"] = base if isinstance(base, dict) else {"index": base}
        if surface is not None:
            pbr["metallicRoughnessTexture"] = {"index": surface}
        entry = {"name": name, "pbrMetallicRoughness": pbr, **extra}
        if normal is not None:
            entry["normalTexture"] = normal if isinstance(normal, dict) else {"index": normal}
        for extension in entry.get("extensions", {}):
            self.writer.use_extension(extension)
        self.by_name[name] = self.writer.add("materials", entry)

    def transformed(self, texture, **transform):
        self.writer.use_extension("KHR_texture_transform")
        return {"index": texture, "extensions": {"KHR_texture_transform": transform}}

    def add_textured(self, rng):
        image = self.writer.add_texture
        base, surface, normal = tx.planks(rng)
        self.add("floor", roughness=1, metallic=1, base=image("floor_base.jpg", base), surface=image("floor_surface.jpg", surface),
                 normal=image("floor_normal.jpg", normal))
        base, normal = tx.plaster(rng)
        plaster, plaster_normal = image("plaster_base.jpg", base), image("plaster_normal.jpg", normal)
        self.add("plaster", (0.93, 0.93, 0.93), 0.9, base=plaster, normal=plaster_normal)
        self.add("plaster_sage", (0.50, 0.60, 0.54), 0.85, base=plaster, normal=plaster_normal)
        wood = image("wood_base.jpg", tx.wood(rng))
        self.add("oak", roughness=0.35, base=wood)
        self.add("walnut", (0.50, 0.42, 0.36), 0.3, base=wood)
        tile = self.transformed(image("rug_base.jpg", tx.rug(rng)), offset=[0.0, 0.5], scale=[4.0, 3.0])
        self.add("rug", roughness=0.95, base=tile)
        base, normal = tx.weave(rng)
        cloth, cloth_normal = image("cloth_base.jpg", base), image("cloth_normal.jpg", normal)
        for name, color in (("cloth_ochre", (0.80, 0.52, 0.16)), ("cloth_teal", (0.14, 0.40, 0.42))):
            turned = {"scale": [5.0, 5.0], "rotation": 0.7853982}
            self.add(name, color, 0.95, base=self.transformed(cloth, **turned), normal=self.transformed(cloth_normal, **turned))
        self.add("curtain", (0.86, 0.82, 0.74), 0.95, base=cloth, normal=cloth_normal, doubleSided=True)
        self.add("stoneware", roughness=0.22, base=image("stoneware_base.jpg", tx.speckle(rng)))
        self.add("brushed_brass", (0.80, 0.62, 0.34), 1.0, 1.0, surface=image("brushed_surface.jpg", tx.brushed(rng)))
        for name in ("hills", "shapes", "waves"):
            picture = getattr(tx, f"painting_{name}")(rng)
            self.add(f"painting_{name}", roughness=0.6, base=image(f"painting_{name}.jpg", picture))

    def add_plain(self):
        self.add("copper", (0.80, 0.50, 0.36), 0.12, 1.0)
        self.add("steel", (0.66, 0.66, 0.68), 0.06, 1.0)
        self.add("iron", (0.16, 0.16, 0.17), 0.45, 0.6)
        self.add("glaze_blue", (0.10, 0.22, 0.48), 0.07)
        self.add("glaze_red", (0.62, 0.13, 0.09), 0.10)
        self.add("glaze_fade", (1.0, 1.0, 1.0), 0.12)  # coloured by its vertices
        self.add("book", (1.0, 1.0, 1.0), 0.6)  # coloured by its vertices
        self.add("terracotta", (0.62, 0.31, 0.19), 0.8)
        self.add("soil", (0.12, 0.09, 0.07), 1.0)
        self.add("stem", (0.33, 0.43, 0.17), 0.6)
        self.add("white_lacquer", (0.78, 0.77, 0.74), 0.3)
        self.add("petal_red", (0.72, 0.12, 0.09), 0.35)
        self.add("petal_yellow", (0.80, 0.58, 0.10), 0.35)
        self.add("petal_blue", (0.10, 0.27, 0.55), 0.35)

    def add_special(self, rng):
        leaf = self.writer.add_texture("leaf_base.png", tx.frond(rng))
        self.add("leaf", roughness=0.45, base=leaf, alphaMode="MASK", alphaCutoff=0.5, doubleSided=True)
        self.add("bottle_glass", (0.35, 0.62, 0.45), 0.04, alpha=0.3, alphaMode="BLEND")
        strength = lambda s: {"KHR_materials_emissive_strength": {"emissiveStrength": s}}
        self.add("lamp_globe", (0.8, 0.8, 0.8), 0.4, emissiveFactor=[1.0, 0.72, 0.42], extensions=strength(4.0))
        self.add("neon", (0.8, 0.8, 0.8), 0.4, emissiveFactor=[1.0, 0.22, 0.30], extensions=strength(9.0))
