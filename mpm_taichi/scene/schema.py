"""The grammar of scene files as JSON Schema, and what it says about one key."""

from functools import cache

from .models import Scene


@cache
def scene_schema() -> dict:
    """JSON Schema (2020-12) of scene files."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **Scene.model_json_schema(),
    }


def follow(location: tuple, data, whole: dict | None = None) -> tuple[tuple, dict, dict]:
    """Path in the file, rule for the value there and rule for the mapping or list that holds it;
    the data have the rule `whole`; default: that of a scene.

    `location` is pydantic's: after a union it names the branch taken, which the file need not
    have.  A rule is a part of the schema, {} where the schema says nothing."""
    path, holder, rule = (), {}, whole or scene_schema()
    branch, branch_comes = None, False
    for part in location:
        if branch_comes:
            branch, branch_comes = part, False
            continue
        holder = _branch(rule, branch, data)
        if isinstance(part, int):
            rule = holder.get("items", {})
        else:
            rule = holder.get("properties", {}).get(part, holder.get("additionalProperties") or {})
        rule = resolve(rule)
        data = _member(data, part)
        path = (*path, part)
        branch_comes = "discriminator" in rule or is_union(rule)
    return path, rule, holder


def value_at(path: tuple, data):
    """What the file has at a path; None where it has nothing."""
    for part in path:
        data = _member(data, part)
    return data


def resolve(rule: dict) -> dict:
    """A rule with its reference and its `or null` taken away."""
    if "allOf" in rule:  # around references, until pydantic 2.8
        rule = rule["allOf"][0]
    if "$ref" in rule:
        rule = scene_schema()["$defs"][rule["$ref"].rsplit("/", 1)[1]]
    branches = choices(rule)
    return resolve(branches[0]) if len(branches) == 1 else rule


def choices(rule: dict) -> list[dict]:
    """The branches of a union, except null."""
    return [branch for branch in rule.get("anyOf", []) if branch != {"type": "null"}]


def is_union(rule: dict) -> bool:
    return len(choices(rule)) > 1


def _branch(rule: dict, name, data) -> dict:
    """The rule of the branch that the data took, of the name that pydantic gave it."""
    rule = resolve(rule)
    if "discriminator" in rule:
        return resolve({"$ref": rule["discriminator"]["mapping"][name]})
    kind = {dict: "object", list: "array"}.get(type(data))
    for branch in map(resolve, choices(rule)):
        if "discriminator" in branch or branch.get("type") == kind:
            return _branch(branch, name, data)
    return rule


def _member(data, part):
    if isinstance(data, dict):
        return data.get(part)
    if isinstance(data, list) and isinstance(part, int) and part < len(data):
        return data[part]
    return None
