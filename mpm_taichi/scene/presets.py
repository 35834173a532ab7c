"""How a scene names a preset: `{preset: snow, density: 300}`."""

from typing import Any

from pydantic import ValidationError
from pydantic_core import core_schema

from ..materials.presets import PRESETS
from .wording import in_words, must_be_one_of, shown


class OrPreset:
    """Annotates the union of laws: a mapping with `preset` is a law too, that of the preset, with
    the preset's values where the mapping has none of its own."""

    def __get_pydantic_core_schema__(self, source, handler):
        return core_schema.no_info_before_validator_function(written_out, handler(source))

    def __get_pydantic_json_schema__(self, schema, handler):
        """Beside each law a mapping with the presets of that law, in which nothing else is
        required.  The `discriminator` stays that of the laws."""
        laws = handler(schema)
        rules = [handler.resolve_ref_schema(law) for law in laws["oneOf"]]
        of_presets = [rule for rule in map(_rule_of_presets, rules) if rule]
        return {**laws, "oneOf": [*laws["oneOf"], *of_presets]}


def written_out(value: Any) -> Any:
    """A material that names a preset, with all values and without the name."""
    if not isinstance(value, dict) or "preset" not in value:
        return value
    name = value["preset"]
    if not isinstance(name, str) or name not in PRESETS:
        raise _fault("preset", must_be_one_of(PRESETS, name), name)
    values = PRESETS[name].material.model_dump()
    law = value.get("type", values["type"])
    if law != values["type"]:
        text = f"must be {values['type']}, the law of preset {name} (got {shown(law)})"
        raise _fault("type", text, law)
    return values | {key: entry for key, entry in value.items() if key != "preset"}


def _fault(key: str, text: str, value: Any) -> ValidationError:
    return ValidationError.from_exception_data("Material", [in_words((key,), text, value)])


def _rule_of_presets(law: dict) -> dict | None:
    word = law["properties"]["type"]["const"]
    names = [name for name, preset in PRESETS.items() if preset.material.type == word]
    if not names:
        return None
    values = {
        key: {term: entry for term, entry in rule.items() if term != "default"}
        for key, rule in law["properties"].items()
    }
    preset = {"type": "string", "enum": names, "description": "whose values hold unless given here"}
    return {
        "type": "object",
        "title": f"{law['title']} by preset",
        "description": law.get("description", ""),
        "properties": {"preset": preset, **values},
        "required": ["preset"],
        "additionalProperties": False,
    }
