"""A map of 10 MB takes seconds, and memory in proportion."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

# In a process of its own: without shape checks, and with a memory of its own to measure.
IMPORT = """
import re, sys, time
from pathlib import Path
from mjdrive.town import opendrive
from mjdrive.town.network import build_town
from mjdrive.town.settings import LightTiming

road_map = opendrive.read(Path(sys.argv[1]))
build_town(road_map, name="large", timing=LightTiming(), digest="")
# Not ru_maxrss: a new process begins with the peak of the one that started it.
peak = re.search(r"VmHWM:\\s+(\\d+) kB", Path("/proc/self/status").read_text())[1]
print(time.process_time(), peak)
"""


NOTE = b'<userData><vectorLane sOffset="0.0" laneId="{8be4df61-93ca-11d2-aa0d-00e098032b8c}"/></userData>'


def _large_map(document: bytes) -> bytes:
    """The streets of a map side by side many times, with notes in each lane as an editor leaves them."""
    streets = re.search(rb"<road.*</road>", document, re.DOTALL)
    assert streets is not None
    plain = re.sub(
        rb'<link>.*?</link>|<signals>.*?</signals>|<road [^>]*junction="[0-9].*?</road>',
        b"",
        streets[0],
        flags=re.DOTALL,
    ).replace(b"</lane>", 8 * NOTE + b"</lane>")
    copies = [
        re.sub(rb'(<road [^>]*id=")', rb"\g<1>%d-" % number, plain).replace(
            b' x="', b' x="%d' % (number + 1)
        )
        for number in range(150)
    ]
    header = b'<OpenDRIVE><header revMajor="1" revMinor="4"/>'
    return header + b"".join(copies) + b"</OpenDRIVE>"


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="peak memory is read the way Linux tells it")
def test_ten_megabytes_are_imported_in_20_seconds_and_1_gigabyte(
    tmp_path: Path, map_bytes: bytes
) -> None:
    path = tmp_path / "large.xodr"
    path.write_bytes(_large_map(map_bytes))
    assert path.stat().st_size > 10_000_000
    answer = subprocess.run(
        [sys.executable, "-c", IMPORT, str(path)], check=True, capture_output=True, text=True
    )
    seconds, kilobytes = map(float, answer.stdout.split())
    assert seconds < 20.0
    assert kilobytes < 1_000_000
