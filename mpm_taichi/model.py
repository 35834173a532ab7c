"""The base of everything that a scene file can say: frozen, strict, unknown keys refused."""

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError


def _require_type(schema: dict[str, Any]) -> None:
    """A file says which of several kinds it means; in Python the class says it."""
    if "const" in (word := schema.get("properties", {}).get("type", {})):
        word.pop("default", None)
        schema["required"] = ["type", *schema.get("required", [])]


class Model(BaseModel):
    """Strict: '3' is no number and true is no integer, but an integer serves as a float.

    Made in Python, `Ball(center=[0.5, 0.5], radius=0.1)`, it takes tuples and arrays for lists too;
    what is wrong is an InputError in the words of scene files."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, strict=True, allow_inf_nan=False,
        json_schema_extra=_require_type,
    )  # fmt: skip

    def __init__(self, **values):
        values = {name: _plain(value) for name, value in values.items()}
        try:
            super().__init__(**values)
        except ValidationError as error:
            from .scene.in_python import fault  # which knows all models

            raise fault(type(self), error, values) from None

    # What pydantic makes of a file does not come through here.
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]


def _plain(value):
    """Tuples and NumPy's arrays as lists, NumPy's numbers as Python's."""
    if isinstance(value, dict):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    return value.tolist() if type(value).__module__ == "numpy" else value


Positive = Annotated[float, Field(gt=0)]
Vector = Annotated[list[float], Field(min_length=2, max_length=3)]
