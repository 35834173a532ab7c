"""What pydantic found, in the words of the file: a path and a sentence."""

from collections.abc import Iterable

from .schema import choices, follow, is_union, resolve, value_at
from .wording import must_be_one_of, shown, suggestion

BOUNDS = {
    "exclusiveMinimum": "greater than",
    "minimum": "at least",
    "exclusiveMaximum": "less than",
    "maximum": "at most",
}
OUT_OF_BOUNDS = ("greater_than", "greater_than_equal", "less_than", "less_than_equal")
NOUNS = {"number": "number", "integer": "whole number", "string": "text", "object": "mapping"}


def messages(errors: Iterable, data, whole: dict | None = None) -> dict[tuple[tuple, str], None]:
    """Path and sentence of each of pydantic's errors about the data, without repetition.  `whole`:
    the rule of the data; default: that of a scene."""
    found = {}
    for error in errors:
        if error["type"] == "scene":
            found[error["loc"], error["msg"]] = None
            continue
        path, rule, holder = follow(error["loc"], data, whole)
        value = value_at(path, data)
        kind = error["type"]
        word = kind in ("literal_error", "bool_type")
        if word and is_union(rule) and isinstance(value, dict):
            continue  # the branch that is a mapping tells what is wrong within it
        if kind == "extra_forbidden":
            known = list(holder["properties"])
            listed = f"; known keys: {', '.join(known)}"
            sentence = "unknown key" + (suggestion(path[-1], known) or listed)
        elif kind == "union_tag_invalid":
            path = (*path, "type")
            sentence = must_be_one_of(rule["discriminator"]["mapping"], value_at(path, data))
        elif kind == "union_tag_not_found":
            path = (*path, "type")
            words = rule["discriminator"]["mapping"]
            presets = len(rule["oneOf"]) > len(words)  # mappings that need no type
            condition = " where there is no preset" * presets
            sentence = f"is required{condition}: {' or '.join(words)}"
        elif kind == "missing":
            sentence = f"is required: {described(rule)}"
        elif kind == "value_error":
            sentence = str(error["ctx"]["error"])
        elif kind in OUT_OF_BOUNDS and not is_union(rule):
            sentence = f"must be {_bounds(rule)} (got {shown(value)})"
        elif kind == "literal_error" and len(rule.get("enum", ())) > 1:
            sentence = must_be_one_of(rule["enum"], value)
        else:
            sentence = f"must be {described(rule)} (got {shown(value)})"
            sentence += suggestion(value, _words(rule)) if isinstance(value, str) else ""
        found[path, sentence] = None
    return found


def described(rule: dict) -> str:
    """What a rule of the schema asks for: `a number greater than 0 or auto`."""
    rule = resolve(rule)
    if "discriminator" in rule:
        return f"a mapping with type {' or '.join(rule['discriminator']['mapping'])}"
    if is_union(rule):
        return " or ".join(described(branch) for branch in choices(rule))
    if "enum" in rule or "const" in rule:
        return ", ".join(str(word) for word in rule.get("enum", [rule.get("const")]))
    kind = rule.get("type")
    if kind in ("number", "integer"):
        bounds = _bounds(rule)
        return f"a {NOUNS[kind]}{' of' * bounds.startswith('at')} {bounds}".rstrip()
    if kind == "boolean":
        return "true or false"
    if kind == "array":
        return _described_list(rule)
    if kind == "object":
        keys = ", ".join(rule.get("properties", ()))
        return f"a mapping with the keys {keys}" if keys else "a mapping with at least one entry"
    return "text that is not empty" if rule.get("minLength") else "text"


def _described_list(rule: dict) -> str:
    least, most = rule.get("minItems", 0), rule.get("maxItems")
    item = resolve(rule.get("items", {}))
    noun = NOUNS.get(item.get("type", ""), "entrie") + "s"
    count = f"{least}" if least == most else f"{least} or {most}" if most else f"at least {least}"
    each = _bounds(item)
    return f"a list of {count} {noun}" + (f", each {each}" if each else "")


def _bounds(rule: dict) -> str:
    """`greater than -1 and less than 0.5`."""
    return " and ".join(f"{word} {rule[key]:g}" for key, word in BOUNDS.items() if key in rule)


def _words(rule: dict) -> list[str]:
    branches = [resolve(branch) for branch in choices(rule)]
    return [str(w) for b in branches for w in b.get("enum", [b["const"]] if "const" in b else [])]
