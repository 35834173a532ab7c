"""Print the JSON Schema of scene files, for editors."""

import json


def add(parser) -> None:
    """No arguments."""


def execute(options) -> int:
    from ..scene import scene_schema

    print(json.dumps(scene_schema(), indent=2))
    return 0
