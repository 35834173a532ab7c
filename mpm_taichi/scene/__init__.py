"""Scenes: YAML file -> frozen, validated Scene.  Nothing here compiles, meshes or starts Taichi.

- `load_scene(path, overrides)`  -> Scene, or an InputError that lists every fault with its place
- `load_material(values, overrides)` -> one material, of a mapping as a scene has it
- `dump_scene(scene)`            -> the scene as YAML that `load_scene` reads back as an equal Scene
- `scene_schema()`               -> JSON Schema of scene files, for editors
"""

from .models import Body, Domain, History, Images, Method, Output, Scene, Time, Walls
from .reader import load_material, load_scene
from .schema import scene_schema
from .writer import dump_scene

__all__ = [
    "Body",
    "Domain",
    "History",
    "Images",
    "Method",
    "Output",
    "Scene",
    "Time",
    "Walls",
    "dump_scene",
    "load_material",
    "load_scene",
    "scene_schema",
]
