"""Scenes: YAML file -> frozen, validated Scene.  Nothing here compiles, meshes or starts Taichi.

- `load_scene(path, overrides)`  -> Scene, or an InputError that lists every fault with its place
- `load_material(values, overrides)` -> one material, of a mapping as a scene has it
- `dump_scene(scene)`            -> the scene as YAML that `load_scene` reads back as an equal Scene
- `scene_schema()`               -> JSON Schema of scene files, for editors

and all that a scene is made of, for scenes made in Python: `Scene(version=1, domain=Domain(...))`.
"""

from ..materials import (
    DruckerPrager,
    FixedCorotated,
    Fluid,
    Gas,
    Hencky,
    Hypoelastic,
    LinearElastic,
    NeoHookean,
    Snow,
    VonMises,
)
from ..sampling import GmshMesh, Lattice, MeshFile
from ..shapes import Ball, Box, Cylinder, Ring
from ..transfers import APICChoice, FLIPChoice, PICChoice, TPICChoice, XPICChoice
from .models import (
    Body,
    Domain,
    Exact,
    History,
    Images,
    Method,
    Output,
    ParaView,
    Scene,
    Time,
    View,
    Walls,
)
from .reader import load_material, load_scene
from .schema import scene_schema
from .writer import dump_scene

__all__ = [
    "APICChoice",
    "Ball",
    "Body",
    "Box",
    "Cylinder",
    "Domain",
    "DruckerPrager",
    "Exact",
    "FLIPChoice",
    "FixedCorotated",
    "Fluid",
    "Gas",
    "GmshMesh",
    "Hencky",
    "History",
    "Hypoelastic",
    "Images",
    "Lattice",
    "LinearElastic",
    "MeshFile",
    "Method",
    "NeoHookean",
    "Output",
    "PICChoice",
    "ParaView",
    "Ring",
    "Scene",
    "Snow",
    "TPICChoice",
    "Time",
    "View",
    "VonMises",
    "Walls",
    "XPICChoice",
    "dump_scene",
    "load_material",
    "load_scene",
    "scene_schema",
]
