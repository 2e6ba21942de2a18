"""Frames -> an H.264 video in memory that every browser plays; the same bytes for the same frames."""

import io
from collections.abc import Iterable

import av
import numpy as np
from jaxtyping import UInt8

_ENCODER = {
    "crf": "26",  # constant quality: letters stay sharp, ten seconds take some 200 kB
    "preset": "medium",
    "tune": "animation",
    # The bytes must not hang on the number of cores, nor on what was in the memory before: the look-ahead by
    # macroblocks reads some that nobody wrote (the same frames came out in five ways).
    "threads": "1",
    "x264-params": "mbtree=0",
}

_FOR_JUMPS = {"g": "2", "bf": "0", "crf": "18"}
"""Whoever trains reads single frames in any order: no frame leans on more than one other."""


def encode(
    frames: Iterable[UInt8[np.ndarray, "H W 3"]],
    *,
    frames_per_second: int,
    for_jumps: bool = False,
) -> bytes:
    """Encode a video.

    Args:
        frames: RGB pictures of one even height and one even width, at least one.
        frames_per_second: How fast they are shown [1/s].
        for_jumps: Whether single frames are read in any order, which takes more bytes.

    Returns:
        An MP4 file.
    """
    file = io.BytesIO()
    options = {**_ENCODER, **(_FOR_JUMPS if for_jumps else {})}
    no_version = {"fflags": "+bitexact"}  # of the muxer
    with av.open(file, mode="w", format="mp4", options=no_version) as container:
        stream = None
        for picture in frames:
            if stream is None:
                stream = container.add_stream("libx264", rate=frames_per_second, options=options)
                stream.height, stream.width = picture.shape[:2]
                stream.pix_fmt = "yuv420p"  # the only one that phones decode
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
        assert stream is not None, "a video needs a frame"
        container.mux(stream.encode())
    return file.getvalue()
