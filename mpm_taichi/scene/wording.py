"""How paths, values and near misses are put into words."""

from collections.abc import Iterable
from difflib import get_close_matches

from pydantic_core import InitErrorDetails, PydanticCustomError

Found = tuple[tuple[str | int, ...], str]
"""A fault: the location of a key and the sentence that follows it."""


def path_text(path: tuple) -> str:
    """`bodies[0].velocity`."""
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path)
    return text.removeprefix(".")


def printable(text: str) -> str:
    """One line that any terminal can show: control characters and the like are escaped."""
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text)


def shown(value) -> str:
    """A value as YAML has it, shortened to what fits into a message."""
    if value is None:
        return "nothing"
    if isinstance(value, dict):
        return "a mapping"
    if isinstance(value, list):
        text = f"[{', '.join(map(shown, value))}]"
    else:
        text = str(value).lower() if isinstance(value, bool) else repr(value)
    return text if len(text) <= 60 else f"{text[:56]} ..."


def suggestion(word: object, known: Iterable[str]) -> str:
    """`; did you mean 'x'?`, or nothing where no known word is close."""
    words = {candidate.lower(): candidate for candidate in known}
    close = get_close_matches(str(word).lower(), words, 1)
    return f"; did you mean '{words[close[0]]}'?" if close else ""


def must_be_one_of(words: Iterable[object], value) -> str:
    """Of a value that is none of the words."""
    known = list(map(str, words))
    return f"must be one of {', '.join(known)} (got {shown(value)})" + suggestion(value, known)


def in_words(place: tuple, text: str, value) -> InitErrorDetails:
    """A fault for pydantic to raise, with a text that the reader shows as it is."""
    kind = PydanticCustomError("scene", "{text}", {"text": text})
    return InitErrorDetails(type=kind, loc=place, input=value)


def wrong_length(vector: list, domain) -> str:
    """Of a vector that has not one entry per axis."""
    return (
        f"must have {domain.dimension} entries, one for each axis of domain.size "
        f"(got {len(vector)})"
    )
