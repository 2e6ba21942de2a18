"""Take checked values out of XML elements, and keep account of what was taken."""

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from typing import Any, NoReturn

from mjdrive.errors import TownFormatError

# An lxml element; lxml ships no types.
Element = Any

LARGEST_NUMBER = 1e9
"""Largest value that any number of a map may have, in its own unit."""


class XmlFields:
    """Takes values out of the elements of one document; its errors name the source, the line and the road.

    Attributes:
        source: How errors call the document.
        used: Elements that something was taken from.
        asked: Attributes that were asked for, by the tag of their element.
        notes: What the reader met and could not use, with counts.
    """

    def __init__(self, source: str) -> None:
        self.source = source
        # lxml makes elements on demand; those in this set stay, so that each is itself when met again.
        self.used: set[Element] = set()
        self.asked: defaultdict[str, set[str]] = defaultdict(set)
        self.notes: Counter[str] = Counter()

    def fail(self, element: Element, problem: str) -> NoReturn:
        """Refuse the document because of an element."""
        road = next(
            (f", road '{e.get('id')}'" for e in element.iterancestors("road")),
            f", road '{element.get('id')}'" if element.tag == "road" else "",
        )
        raise TownFormatError(
            f"{self.source}:{element.sourceline}{road}: <{element.tag}> {problem}"
        )

    def note(self, what: str, count: int = 1) -> None:
        """Count something that the map says and mjdrive does not use."""
        self.notes[what] += count

    def child(self, element: Element | None, *path: str) -> Element | None:
        """Take the first child of a tag, its first child of the next tag and so on; None if there is none."""
        for tag in path:
            if element is None:
                return None
            element = next(element.iterchildren(tag), None)
            if element is not None:
                self.used.add(element)
        return element

    def each(self, element: Element | None, *path: str) -> Iterator[Element]:
        """Take all children of the last tag of a path, under the first child of each tag before it."""
        holder = self.child(element, *path[:-1])
        if holder is not None:
            for found in holder.iterchildren(path[-1]):
                self.used.add(found)
                yield found

    def some(self, element: Element, *path: str) -> list[Element]:
        """Take all children on a path, of which there must be one or more."""
        found = list(self.each(element, *path))
        if not found:
            self.fail(element, f"has no {'/'.join(path)}; expected at least one.")
        return found

    def use_all(self, element: Element) -> None:
        """Account for an element and all that it holds."""
        self.used.update(element.iter("*"))

    def optional(self, element: Element, name: str, default: str = "") -> str:
        """Take an attribute that may be missing or empty."""
        self.asked[element.tag].add(name)
        return str(element.get(name) or default)

    def text(self, element: Element, name: str) -> str:
        """Take an attribute that must be there."""
        self.asked[element.tag].add(name)
        value = element.get(name)
        if value is None:
            self.fail(element, f"has no attribute '{name}'.")
        return str(value)

    def choice(
        self, element: Element, name: str, allowed: Iterable[str], default: str | None = None
    ) -> str:
        """Take one of a few words; one is required unless there is a default."""
        value = (
            self.text(element, name) if default is None else self.optional(element, name, default)
        )
        if value not in allowed:
            self.fail(element, f"has {name}='{value}'; expected {' or '.join(allowed)}.")
        return value

    def number(self, element: Element, name: str, default: float | None = None) -> float:
        """Take a finite number; it is required unless there is a default."""
        value = self.text(element, name) if default is None else self.optional(element, name)
        if not value and default is not None:
            return default
        try:
            number = float(value)
        except ValueError:
            self.fail(element, f"has {name}='{value[:40]}'; expected a number.")
        if not math.isfinite(number):
            self.fail(element, f"has {name}='{value[:40]}'; expected a finite number.")
        if abs(number) > LARGEST_NUMBER:
            self.fail(
                element, f"has {name}='{value[:40]}'; expected at most {LARGEST_NUMBER:g} in size."
            )
        return number

    def integer(self, element: Element, name: str) -> int:
        """Take a whole number."""
        value = self.text(element, name)
        try:
            number = int(value)
        except ValueError:
            self.fail(element, f"has {name}='{value[:40]}'; expected a whole number.")
        if abs(number) > LARGEST_NUMBER:
            self.fail(
                element, f"has {name}='{value[:40]}'; expected at most {LARGEST_NUMBER:g} in size."
            )
        return number
