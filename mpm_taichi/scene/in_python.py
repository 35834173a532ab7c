"""What is wrong with a model that is made in Python, in the words of scene files."""

from pydantic import ValidationError

from ..errors import InputError
from ..model import Model
from .messages import messages
from .schema import scene_schema
from .wording import path_text, printable


def fault(kind: type[Model], error: ValidationError, values: dict) -> InputError:
    """A line for each fault: `Ball: radius: must be greater than 0 (got -1)`."""
    whole = scene_schema()
    rule = whole["$defs"].get(kind.__name__, whole)
    found = messages(error.errors(include_url=False), as_in_a_file(values), rule)
    lines = (": ".join(filter(None, [kind.__name__, path_text(p), said])) for p, said in found)
    return InputError("\n".join(printable(line) for line in lines))


def as_in_a_file(value):
    """Models as mappings."""
    if isinstance(value, Model):
        return value.model_dump(exclude_none=True)
    if isinstance(value, dict):
        return {key: as_in_a_file(entry) for key, entry in value.items()}
    return [as_in_a_file(entry) for entry in value] if isinstance(value, list) else value
