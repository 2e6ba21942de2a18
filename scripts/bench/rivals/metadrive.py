"""MetaDrive with its top-down view of five channels, for mjdrive/benchmarks/serving.py.

Its wheel lacks the assets (meshes, textures), and its engine asks for a download before anything runs. Physics and
top-down views need none of them, and its check looks at two files alone (`should_update_asset` of
`metadrive/engine/asset_loader.py`): the version, and one texture from which it tells new assets from old. Placeholders
of the two pass it. What needs true assets, cameras above all, would fail.
"""

import importlib.metadata
import importlib.util
import logging
import time
from pathlib import Path

from metadrive.envs.top_down_env import TopDownMetaDrive

PACKAGE = "metadrive-simulator"
TEXTURE = Path("textures", "grass1", "GroundGrassGreen002_COL_1K.jpg")
SEED = 0
HORIZON = 1000
"""Steps until it starts again [-]."""


def stand_in_for_assets() -> None:
    """Put the two files there that the check of the assets looks at, where no assets are."""
    spec = importlib.util.find_spec("metadrive")
    assets = Path(spec.origin).parent / "assets"
    if (assets / "version.txt").exists():
        return
    (assets / TEXTURE).parent.mkdir(parents=True, exist_ok=True)
    (assets / TEXTURE).touch()
    (assets / "version.txt").write_text(importlib.metadata.version(PACKAGE), encoding="utf-8")


class MetaDriveWorld:
    """One car on a map of its own, 10 decisions a second, no traffic; the policy holds the lane."""

    def __init__(self, size: int) -> None:
        config = {
            "resolution_size": size,
            "traffic_density": 0.0,
            "num_scenarios": 1,
            "start_seed": SEED,
            "horizon": HORIZON,
            "log_level": logging.ERROR,
        }
        self._env = TopDownMetaDrive(config)
        self.num_resets = 0
        self.deciding = 0.0
        view, _ = self._env.reset(seed=SEED)
        self.facts = {
            "versions": {PACKAGE: importlib.metadata.version(PACKAGE)},
            "observation": list(view.shape),
        }

    def step(self) -> None:
        """Do one step, steered by a rule; start again at the end of an episode.

        The rule is ours, so its time is kept apart.
        """
        before = time.process_time()
        action = self._action()
        self.deciding += time.process_time() - before
        _, _, terminated, truncated, _ = self._env.step(action)
        if terminated or truncated:
            self._env.reset(seed=SEED)
            self.num_resets += 1

    def _action(self) -> list[float]:
        """Steer towards the middle of the lane, at a walking pace that lets an episode last."""
        car = self._env.agent
        lane = car.lane
        station, offset = lane.local_coordinates(car.position)
        turn = lane.heading_theta_at(station + 5.0) - car.heading_theta
        turn = (turn + 3.141592653589793) % 6.283185307179586 - 3.141592653589793
        speed = 6.0
        return [
            min(max(1.2 * turn + 0.15 * offset, -1.0), 1.0),
            min(max(0.5 * (speed - car.speed), -1.0), 1.0),
        ]


def make(argument: str) -> MetaDriveWorld:
    """Make the world; `argument` is the width of the view [px]."""
    stand_in_for_assets()
    return MetaDriveWorld(int(argument))
