"""The command `materials`: what the models of the laws and the table of presets say, as text."""

import inspect
import re
import sys
from collections.abc import Iterable, Iterator
from textwrap import fill, shorten
from typing import get_args

from .errors import InputError
from .materials import MATERIALS, Material
from .materials.presets import PRESETS
from .scene.messages import described
from .scene.wording import suggestion

WIDTH = 100
LAWS = {get_args(law.model_fields["type"].annotation)[0]: law for law in MATERIALS}
NAMES = [*LAWS, *(name for name in PRESETS if name not in LAWS)]


def catalogue() -> str:
    """All laws, a line on each and its parameters, and all presets."""
    lines = ["laws (type), with units and defaults:", ""]
    for name, law in LAWS.items():
        lines += [shorten(f"{name}: {_what(law)}", WIDTH, placeholder=" ...")]
        lines += [wrapped(unbroken(_parameters(law)), indent=2), ""]
    lines += ["presets (preset), each value of which a scene can replace:", ""]
    for name in PRESETS:
        lines += [*_preset(name), ""]
    lines += ["`python -m mpm_taichi materials NAME` tells more of a law."]
    return "\n".join(lines)


def entry(name: str) -> str:
    """The law of a name, the preset, or both.  InputError where there is neither."""
    if name not in NAMES:
        hint = suggestion(name, NAMES) or f"; there are {', '.join(NAMES)}"
        raise InputError(f"no law or preset is named {name!r}{hint}")
    lines = [*_law(name), ""] if name in LAWS else []
    if name in PRESETS:
        lines += [*_preset(name), "", f"In a scene: materials: {{some_name: {{preset: {name}}}}}"]
        lines += ["Values that differ are given beside `preset`."]
    return "\n".join(lines).rstrip()


def _law(name: str) -> Iterator[str]:
    law = LAWS[name]
    yield fill(f"{name}: {_what(law)}", WIDTH)
    yield ""
    yield inspect.cleandoc(law.__doc__ or "")
    yield ""
    yield "parameters:"
    schema = law.model_json_schema()
    for key, rule in schema["properties"].items():
        if key != "type":
            need = "required" if key in schema["required"] else f"default {_text(rule['default'])}"
            says = f"{key}: {rule['description']}; {described(rule)}; {need}"
            yield fill(says, WIDTH, initial_indent="  ", subsequent_indent="      ")
    mine = [key for key, preset in PRESETS.items() if preset.material.type == name]
    yield f"presets: {', '.join(mine) or 'none'}"


def _preset(name: str) -> Iterator[str]:
    material, source, remark = PRESETS[name]
    yield f"{name}: preset of the law {material.type}"
    yield wrapped(unbroken(constants(material)), indent=2)
    yield wrapped(f"source: {source}", indent=2)
    yield wrapped(f"remark: {remark}", indent=2)


def constants(material: Material) -> Iterator[str]:
    """`density 1000 kg/m^3` and so on."""
    for key, field in type(material).model_fields.items():
        if key != "type":
            yield f"{key} {_text(getattr(material, key))} {_unit(field)}".rstrip()


def _what(law: type) -> str:
    """What its module says of a law, with its source."""
    return " ".join((sys.modules[law.__module__].__doc__ or "").split())


def _parameters(law) -> Iterator[str]:
    """`density [kg/m^3]`, `hardening [Pa] = 0`."""
    for key, field in law.model_fields.items():
        if key != "type":
            unit = f" [{_unit(field)}]" if _unit(field) else ""
            yield key + unit + ("" if field.is_required() else f" = {_text(field.default)}")


def _unit(field) -> str:
    """What the description has in brackets; nothing for a pure number."""
    found = re.search(r"\[(.+?)\]", field.description)
    return found[1] if found and found[1] != "-" else ""


def _text(value) -> str:
    """As a scene may have it."""
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:g}" if isinstance(value, float) else str(value)


def unbroken(items: Iterable[str]) -> str:
    """A list whose items `wrapped` leaves on one line."""
    return ", ".join(item.replace(" ", "\xa0") for item in items)


def wrapped(text: str, width: int = WIDTH, indent: int = 0) -> str:
    room = " " * indent
    lines = fill(text, width, initial_indent=room, subsequent_indent=room, break_on_hyphens=False)
    return lines.replace("\xa0", " ")
