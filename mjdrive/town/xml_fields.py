"""Take checked values out of XML elements."""

import math
from typing import Any, NoReturn

from mjdrive.errors import TownFormatError

# An lxml element; lxml ships no types.
Element = Any


class XmlFields:
    """Takes values out of the elements of one document; its errors name the source, the line and the road.

    Attributes:
        source: How errors call the document.
    """

    def __init__(self, source: str) -> None:
        self.source = source

    def fail(self, element: Element, problem: str) -> NoReturn:
        """Refuse the document because of an element."""
        road = next(
            (f", road '{e.get('id')}'" for e in element.iterancestors("road")),
            f", road '{element.get('id')}'" if element.tag == "road" else "",
        )
        raise TownFormatError(
            f"{self.source}:{element.sourceline}{road}: <{element.tag}> {problem}"
        )

    def text(self, element: Element, name: str) -> str:
        """Take an attribute that must be there."""
        value = element.get(name)
        if value is None:
            self.fail(element, f"has no attribute '{name}'.")
        return str(value)

    def number(self, element: Element, name: str) -> float:
        """Take a finite number."""
        try:
            value = float(self.text(element, name))
        except ValueError:
            self.fail(element, f"has {name}='{element.get(name)}'; expected a number.")
        if not math.isfinite(value):
            self.fail(element, f"has {name}='{element.get(name)}'; expected a finite number.")
        return value

    def integer(self, element: Element, name: str) -> int:
        """Take a whole number."""
        try:
            return int(self.text(element, name))
        except ValueError:
            self.fail(element, f"has {name}='{element.get(name)}'; expected a whole number.")

    def some(self, element: Element, path: str) -> list[Element]:
        """Take the children on a path, of which there must be one or more."""
        found = list(element.iterfind(path))
        if not found:
            self.fail(element, f"has no {path}.")
        return found
