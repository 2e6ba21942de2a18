"""The car on an endless flat road: what every scene starts from."""

import importlib.resources
from pathlib import Path

import mujoco

WHEELS = ("fl", "fr", "rl", "rr")
ROAD = "road"

# contype, conaffinity of what the car can meet; the car's own bits are in car.xml.
ROAD_BITS = (2, 1)
OBSTACLE_BITS = (10, 1)


def car_path(file: str = "car.xml") -> Path:
    """Where the MJCF of a car that ships with mjdrive lies."""
    return Path(str(importlib.resources.files("mjdrive.vehicle") / file))


def car_on_road(
    *, timestep: float, friction: float = 1.0, car: Path | None = None
) -> mujoco.MjSpec:
    """Build a scene of the car and one plane, to add the rest of a world to.

    All of the road is one plane because the tyre law belongs to pairs of geoms, and because a wheel bumps over the
    seams of tiles.

    Args:
        timestep: Length of one physics step [s].
        friction: Friction coefficient between tyre and road [-].
        car: MJCF of the car, as `cars.load` has checked it; car.xml if None.

    Returns:
        Scene that `Car` can drive once it is compiled.
    """
    spec = mujoco.MjSpec.from_file(str(car or car_path()))
    spec.option.timestep = timestep
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.solver = mujoco.mjtSolver.mjSOL_NEWTON
    spec.option.iterations = 20
    contype, conaffinity = ROAD_BITS
    spec.worldbody.add_geom(
        name=ROAD,
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[0, 0, 10],
        friction=[friction, 0.005, 0.0001],
        contype=contype,
        conaffinity=conaffinity,
        rgba=[0.55, 0.57, 0.55, 1],
    )
    for wheel in WHEELS:
        spec.add_pair(
            name=f"tyre_{wheel}",
            geomname1=ROAD,
            geomname2=f"tyre_{wheel}",
            condim=3,
            friction=[friction, friction, 0.005, 0.0001, 0.0001],
        )
    return spec
