"""YAML text as plain dicts, lists, texts and numbers, with the place of every key and item.

YAML 1.2, core schema: 1e-3 is a number, `no` is a word.  The tree is built from the events of the
parser, so that what a scene may not have never becomes an object: tags, anchors, aliases, merge
keys, repeated keys, further documents, deep nesting, numbers that are not finite."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import isfinite
from typing import Any, NamedTuple

from ruamel.yaml import YAML
from ruamel.yaml import events as yaml
from ruamel.yaml.error import MarkedYAMLError
from ruamel.yaml.reader import ReaderError

from ..errors import InputError
from .wording import printable

DEEPEST = 32
LONGEST_INTEGER = 18

NULL = re.compile(r"~|null|Null|NULL|")
TRUE, FALSE = re.compile(r"true|True|TRUE"), re.compile(r"false|False|FALSE")
INTEGER = re.compile(r"[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+")
FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
NOT_FINITE = re.compile(r"[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)")
BASES = {"0o": 8, "0x": 16}

IN_WORDS = (
    (r"found character '\\t'", "a tab: YAML wants spaces here"),
    (r"mapping values are not", "a second ':' in one entry: is it indented as the lines around?"),
    (r"expected (<block end>|'<document start>')", "not in line with the entries before it"),
    (r"found unexpected end of stream", "the text ends within quotes"),
    (r"expected '?,", "a list or mapping that is not closed, or without a comma"),
)


class Place(NamedTuple):
    """Where something was said: `text` for people, `order` to sort by."""

    order: tuple[int, ...]
    text: str


class Fault(NamedTuple):
    """What is wrong with the key or item at a path."""

    path: tuple
    place: Place
    sentence: str


@dataclass
class Document:
    """The value of a text, with None where a fault left nothing."""

    value: Any
    places: dict[tuple, Place]
    faults: list[Fault] = field(default_factory=list)

    def place(self, path: tuple) -> Place:
        """Of the key or item at a path, or of the nearest thing around it."""
        while path not in self.places:
            path = path[:-1]
        return self.places[path]

    def add(self, path: tuple, sentence: str) -> None:
        """A fault at the place of a path."""
        self.faults.append(Fault(path, self.place(path), sentence))


def parse(text: str, name: str) -> Document:
    """The one document of a text; `name` begins its places.  InputError where it breaks off."""
    return _Reader(text, name).document


def plain_scalar(text: str) -> Any:
    """The value of a word without quotes: None, a truth value, a number or the text itself.

    OverflowError where a number is too large or not finite."""
    if NULL.fullmatch(text):
        return None
    if TRUE.fullmatch(text) or FALSE.fullmatch(text):
        return text[0] in "tT"
    if INTEGER.fullmatch(text):
        if len(text.lstrip("+-0ox")) > LONGEST_INTEGER:
            raise OverflowError(f"has more than {LONGEST_INTEGER} digits")
        return int(text, BASES.get(text[:2], 10))
    if NOT_FINITE.fullmatch(text):
        raise OverflowError("must be a finite number")
    if FLOAT.fullmatch(text):
        if not isfinite(float(text)):
            raise OverflowError("is too large for a floating-point number")
        return float(text)
    return text


class _Reader:
    """One walk over the events of a text, which fills `document`."""

    def __init__(self, text: str, name: str):
        self.text, self.name = text, name
        self.document = Document(None, {(): Place((0, 1, 1), f"{name}:1:1")})
        with self._syntax_errors_in_words():
            self.events: Iterator[Any] = iter(YAML(typ="safe", pure=True).parse(text))
            self._documents()

    def _documents(self):
        seen = False
        for event in self.events:
            if isinstance(event, yaml.DocumentStartEvent):
                if event.version or event.tags:
                    self._fault((), event, "directives (%YAML, %TAG) have no place here")
                if seen:
                    self._fault((), event, "a second document: one file holds one scene")
                    return
            elif isinstance(event, yaml.NodeEvent):
                self.document.value = self._node(event, ())
                seen = True

    def _node(self, event, path: tuple):
        if len(path) > DEEPEST:
            raise MarkedYAMLError(
                problem=f"nested deeper than {DEEPEST} levels", problem_mark=event.start_mark
            )
        if path:
            self.document.places.setdefault(path, self._place(event.start_mark))
        if isinstance(event, yaml.AliasEvent):
            return self._fault(path, event, f"alias *{event.anchor}: write the value itself")
        if event.anchor is not None:
            self._fault(path, event, f"anchor &{event.anchor}: values cannot be shared")
        if event.tag is not None:
            self._fault(path, event, f"tag {event.tag}: values have no tags")
        if isinstance(event, yaml.ScalarEvent):
            return self._scalar(event, path)
        if isinstance(event, yaml.MappingStartEvent):
            return self._mapping(path)
        items: list[Any] = []
        for item in self._until_end():
            items.append(self._node(item, (*path, len(items))))
        return items

    def _mapping(self, path: tuple) -> dict:
        entries: dict[str, Any] = {}
        for event in self._until_end():
            key = self._key(event, path)
            below = (*path, key)
            repeated = key in entries
            if repeated:
                first = self.document.places[below]
                self._fault(below, event, f"the key '{key}' is there twice, first at {first.text}")
            self.document.places.setdefault(below, self._place(event.start_mark))
            value = self._node(next(self.events), below)
            if not repeated:
                entries[key] = value
        return entries

    def _key(self, event, path: tuple) -> str:
        if not isinstance(event, yaml.ScalarEvent):
            self._fault(path, event, "a key must be a word, not a list, a mapping or an alias")
            self._node(event, (*path, "?"))
            return "?"
        if event.anchor is not None or event.tag is not None:
            self._fault(path, event, "a key has neither anchor nor tag")
        if event.implicit[0] and event.value == "<<":
            self._fault(path, event, "merge key <<: write the entries themselves")
        elif event.implicit[0]:
            try:
                word = isinstance(plain_scalar(event.value), str)
            except OverflowError:
                word = False
            if not word:
                text = f"a key must be a word; in quotes, '{event.value}' is one"
                self._fault((*path, event.value), event, text)
        return self._text(event, (*path, event.value))

    def _scalar(self, event, path: tuple):
        if not event.implicit[0]:
            return self._text(event, path)
        try:
            return plain_scalar(event.value)
        except OverflowError as error:
            return self._fault(path, event, f"{error} (got {event.value[:40]})")

    def _text(self, event, path: tuple) -> str:
        """Half of a surrogate pair, as in "\\ud800", is no character: nothing could print it."""
        if event.value.isascii() or not any("\ud800" <= c <= "\udfff" for c in event.value):
            return event.value
        self._fault(path, event, "an escape such as \\ud800 is no character")
        return "?"

    def _until_end(self) -> Iterator[Any]:
        for event in self.events:
            if isinstance(event, yaml.CollectionEndEvent):
                return
            yield event

    def _fault(self, path: tuple, event, sentence: str) -> None:
        self.document.faults.append(Fault(path, self._place(event.start_mark), sentence))

    def _place(self, mark) -> Place:
        line, column = mark.line + 1, mark.column + 1
        return Place((0, line, column), f"{self.name}:{line}:{column}")

    @contextmanager
    def _syntax_errors_in_words(self):
        try:
            yield
        except MarkedYAMLError as error:
            problem = str(error.problem or error.context)
            for pattern, words in IN_WORDS:
                if re.match(pattern, problem):
                    problem = words
            place = self._place(error.problem_mark or error.context_mark)
            raise InputError(f"{place.text}: {printable(problem)}") from None
        except ReaderError as error:
            lines = self.text[: error.position].splitlines() or [""]
            place = f"{self.name}:{len(lines)}:{len(lines[-1]) + 1}"
            raise InputError(f"{place}: the character {error.character!r} is not text") from None
