import io

import av
import numpy as np

from mjdrive.study.videos import mp4


def moving_square() -> list[np.ndarray]:
    frames = [np.full((64, 96, 3), 255, np.uint8) for _ in range(12)]
    for index, frame in enumerate(frames):
        frame[20:40, 5 * index : 5 * index + 20] = (200, 30, 30)
    return frames


def decoded(video: bytes) -> list[np.ndarray]:
    with av.open(io.BytesIO(video)) as container:
        return [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]


def test_a_video_shows_the_frames_that_went_in() -> None:
    frames = moving_square()
    seen = decoded(mp4.encode(frames, frames_per_second=10))
    assert len(seen) == len(frames)
    for shown, meant in zip(seen, frames, strict=True):
        assert np.abs(shown.astype(float) - meant).mean() < 4.0


def test_a_video_is_h264_in_the_colours_that_phones_decode_at_the_speed_asked_for() -> None:
    with av.open(io.BytesIO(mp4.encode(moving_square(), frames_per_second=10))) as container:
        stream = container.streams.video[0]
        assert (stream.codec_context.name, stream.pix_fmt) == ("h264", "yuv420p")
        assert float(stream.average_rate) == 10.0


def test_the_same_frames_give_the_same_bytes_whatever_was_in_memory_before() -> None:
    # Frames whose height is no multiple of 16: their last row of macroblocks is where x264 reads beyond them.
    frames = [np.pad(frame, ((0, 6), (0, 0), (0, 0))) for frame in moving_square()]
    rng = np.random.default_rng(0)
    videos = set()
    for _ in range(3):
        litter = [np.full(70 * 96 * 3, value, np.uint8) for value in rng.integers(255, size=9)]
        videos.add(mp4.encode(iter(frames), frames_per_second=10))
        del litter
    assert len(videos) == 1
