"""Demonstrations as carla-bc records them: looked at, and refused with what they lack.

Its `data_collect.py` leaves route_<i>/ep_<i>/ with `episode.json` (columns done, actions, state), `birdview_masks/` and
three folders of camera pictures. No column says where the car was, nor when in the cycle of the lights; the pictures have
road, route and lanes but no lights; the actions are throttle and steering without a brake. None of what an episode of
ours needs can be had from that, and nothing is invented here.
"""

import json
from pathlib import Path
from typing import NoReturn

from mjdrive.errors import DataError

FILE = "episode.json"
LACKING = "town, position, heading, speed in m/s, time into the light cycle, and a brake among the actions"


def read(folder: Path) -> NoReturn:
    """Say what is there, and what is missing.

    Raises:
        DataError: Always: what carla-bc records does not say where the car was.
    """
    found = sorted(folder.glob(f"route_*/ep_*/{FILE}"))
    if not found:
        raise DataError(
            f"'{folder}' holds no demonstrations of carla-bc; expected route_<number>/ep_<number>/{FILE} in it."
        )
    try:
        columns = ", ".join(json.loads(found[0].read_text()))
    except ValueError as error:
        raise DataError(f"'{found[0]}' is no JSON file: {error}. Fetch it again.") from error
    raise DataError(
        f"'{folder}' holds {len(found)} episodes of carla-bc with the columns {columns}, and pictures. They lack {LACKING}, so "
        f"they cannot be taken over: our views are drawn again from where the car was. Record those values in CARLA and write "
        f"them as a Minari data set (docs/recordings.md), or collect anew: `mjdrive collect --town town01`."
    )
