"""The page that a frame of a video is: a title, and rows of pictures with a line of text above each."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import UInt8
from PIL import Image, ImageDraw, ImageFont

from mjdrive.bev.picture import Rgb
from mjdrive.recording.panels import INK, LINE, WHITE

GAP, HEAD, LABEL = 12, 40, 26
"""Between pictures, above all rows, and above each row [px]."""

_TITLE, _TEXT = 20, 15  # height of letters [px]


class Page:
    """A page to put pictures on again and again.

    Args:
        width: Even, so that videos take it [px].
        height: Even [px].
        title: What it is all about.
    """

    def __init__(self, width: int, height: int, title: str) -> None:
        self._page = Image.new("RGB", (width, height), WHITE)
        self._pen = ImageDraw.Draw(self._page)
        self._pen.text((GAP, HEAD / 2), title, INK, ImageFont.load_default(_TITLE), anchor="lm")
        self._font = ImageFont.load_default(_TEXT)

    @property
    def picture(self) -> UInt8[np.ndarray, "H W 3"]:
        """What it looks like now, RGB."""
        return np.asarray(self._page)

    def put_row(
        self,
        top: int,
        pictures: Sequence[UInt8[np.ndarray, "_ _ 3"]],
        labels: Sequence[str],
    ) -> None:
        """Put a row of pictures over what is there, each with a line of text above it.

        Args:
            top: Where the text begins [px].
            pictures: From left to right, all of one height.
            labels: One a picture.
        """
        self._pen.rectangle((0, top, self._page.width, top + LABEL - 1), fill=WHITE)
        left, upper = GAP, top + LABEL
        for picture, label in zip(pictures, labels, strict=True):
            height, width, _ = picture.shape
            self._page.paste(Image.fromarray(picture), (left, upper))
            corner = left + width - 1, upper + height - 1
            self._pen.rectangle((left, upper, *corner), outline=LINE)
            self._pen.text((left, top + LABEL / 2), label, INK, self._font, anchor="lm")
            left += width + GAP

    def put_bar(
        self, top: int, share: float, marks: Sequence[tuple[float, Rgb]], *, height: int
    ) -> None:
        """Put a bar that fills as time goes on, from edge to edge of the rows.

        Args:
            top: Where it begins [px].
            share: How much of it is filled [-].
            marks: Where something happened, as a share of the whole, and in which colour.
            height: Of the bar [px].
        """
        left, width = GAP, self._page.width - 2 * GAP
        lower = top + height - 1
        self._pen.rectangle((left, top, left + width - 1, lower), fill=WHITE, outline=LINE)
        self._pen.rectangle((left, top, left + round(share * (width - 1)), lower), fill=LINE)
        for place, colour in marks:
            x = left + round(place * (width - 1))
            self._pen.rectangle((x - 1, top - 3, x + 1, lower + 3), fill=colour)
