"""Write scene.xml and scene.png of every town from its map and town.json.

python scripts/make_scenes.py              # all towns, no pictures
python scripts/make_scenes.py --pictures   # needs OpenGL
"""

import argparse

import cv2
import mujoco
import numpy as np

from mjdrive import geometry
from mjdrive.config import SimulationConfig
from mjdrive.datatypes import Town
from mjdrive.simulation.cameras import Cameras, overview
from mjdrive.simulation.lamps import set_lamps
from mjdrive.simulation.scene import build_scene, scene_xml
from mjdrive.town import library, signals
from mjdrive.vehicle.car import Car

CAR_BEFORE_STOP_LINE = 14.0  # rear axle [m]
CLOCK = 4.0  # time into the light cycle of the pictures [s]


def main() -> None:
    """Write the files of every town."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--pictures", action="store_true", help="draw scene.png too")
    arguments = parser.parse_args()
    for name in library.shipped_names():
        town, settings = library.load(name), library.load_settings(name)
        spec = build_scene(town, settings, timestep=SimulationConfig().timestep)
        path = library.folder_of(name) / "scene.xml"
        path.write_text(scene_xml(spec))
        print(f"{path}: {path.stat().st_size / 1e3:.0f} kB")
        if arguments.pictures:
            picture = draw(town, spec.compile())
            cv2.imwrite(
                str(path.with_name("scene.png")),
                cv2.cvtColor(picture, cv2.COLOR_RGB2BGR),
                [cv2.IMWRITE_PNG_COMPRESSION, 9],
            )


def draw(town: Town, model: mujoco.MjModel) -> np.ndarray:
    """Draw the whole town, and the car from behind, from its hood and from above, each on another lane."""
    data = mujoco.MjData(model)
    car = Car(model, data)
    set_lamps(model, town, signals.all_at(town, CLOCK))
    approaches = [light.lane for light in town.lights.values()] or list(town.lanes)
    pictures = []
    with Cameras(model, width=640, height=360) as cameras:
        for number, view in enumerate((overview(town, aspect=16 / 9), "chase", "hood", "top")):
            points = town.lanes[approaches[number * len(approaches) // 4]].centerline
            points = geometry.resample(points, 1.0)
            index = max(int(len(points) - CAR_BEFORE_STOP_LINE), 0)
            x, y = points[index].tolist()
            car.place(x, y, float(geometry.headings(points)[index]))
            pictures.append(cameras.render(data, view))
    return np.vstack([np.hstack(pictures[:2]), np.hstack(pictures[2:])])


if __name__ == "__main__":
    main()
