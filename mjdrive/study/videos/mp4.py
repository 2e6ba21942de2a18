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


def encode(frames: Iterable[UInt8[np.ndarray, "H W 3"]], *, frames_per_second: int) -> bytes:
    """Encode a video.

    Args:
        frames: RGB pictures of one even height and one even width, at least one.
        frames_per_second: How fast they are shown [1/s].

    Returns:
        An MP4 file.
    """
    file = io.BytesIO()
    no_version = {"fflags": "+bitexact"}  # of the muxer
    with av.open(file, mode="w", format="mp4", options=no_version) as container:
        stream = None
        for picture in frames:
            if stream is None:
                stream = container.add_stream("libx264", rate=frames_per_second, options=_ENCODER)
                stream.height, stream.width = picture.shape[:2]
                stream.pix_fmt = "yuv420p"  # the only one that phones decode
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
        assert stream is not None, "a video needs a frame"
        container.mux(stream.encode())
    return file.getvalue()
