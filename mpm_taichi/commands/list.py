"""List the gallery: the scenes that come with the program."""


def add(parser) -> None:
    """No arguments."""


def execute(options) -> int:
    from ..gallery import describe, scene_files

    print("\n".join(describe(path) for path in scene_files()))
    return 0
