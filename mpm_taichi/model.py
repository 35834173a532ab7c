"""The base of everything that a scene file can say: frozen, strict, unknown keys refused."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field


class Model(BaseModel):
    """Strict: '3' is no number and true is no integer, but an integer serves as a float."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


Positive = Annotated[float, Field(gt=0)]
Vector = Annotated[list[float], Field(min_length=2, max_length=3)]
