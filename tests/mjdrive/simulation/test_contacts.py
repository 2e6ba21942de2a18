import mujoco
import pytest

from mjdrive.datatypes import InfractionKind
from mjdrive.simulation.contacts import ContactWatch

SCENE = """
<mujoco>
  <worldbody>
    <geom name="road" type="plane" size="0 0 1"/>
    <geom name="kerb_7" type="box" size="1 .1 .1" pos="0 3 .1"/>
    <geom name="newspaper_stand" type="box" size="1 1 1" pos="0 -9 1"/>
    <geom name="building_2" type="box" size="1 1 3" pos="0 9 3"/>
    <body name="car">
      <freejoint/>
      <geom name="{part}" type="sphere" size=".5" mass="1"/>
    </body>
  </worldbody>
</mujoco>
"""


def watch(part: str, *, y: float, z: float) -> ContactWatch:
    model = mujoco.MjModel.from_xml_string(SCENE.format(part=part))
    data = mujoco.MjData(model)
    data.qpos[:3] = 0.0, y, z
    mujoco.mj_forward(model, data)
    return ContactWatch(model, data)


def hits(part: str, *, y: float, z: float) -> set[tuple[InfractionKind, str]]:
    return watch(part, y=y, z=z).hits()


@pytest.mark.parametrize(
    ("part", "y", "z", "expected"),
    [
        ("tyre_fl", 0.0, 0.45, set()),
        ("hull_top", 0.0, 0.45, {(InfractionKind.COLLISION, "road")}),
        ("tyre_fl", 3.0, 0.65, {(InfractionKind.KERB, "kerb")}),
        ("hull_low", 3.0, 0.65, {(InfractionKind.COLLISION, "kerb")}),
        ("hull_low", 7.6, 2.0, {(InfractionKind.COLLISION, "building_2")}),
        ("tyre_fl", 7.6, 2.0, {(InfractionKind.COLLISION, "building_2")}),
        ("hull_low", -7.6, 1.0, {(InfractionKind.COLLISION, "newspaper_stand")}),
        ("tyre_fl", -7.6, 1.0, {(InfractionKind.COLLISION, "newspaper_stand")}),
        ("hull_low", 0.0, 5.0, set()),
    ],
)
def test_what_is_touched_is_named_by_what_touches_it(part, y, z, expected):
    assert hits(part, y=y, z=z) == expected


@pytest.mark.parametrize(
    ("part", "y", "z", "expected"),
    [
        ("hull_low", 7.6, 2.0, ["building_2"]),
        ("hull_low", 9.0, 2.0, ["building_2"]),  # right in the middle of it
        ("tyre_fl", 7.6, 2.0, ["building_2"]),
        ("hull_low", 3.0, 0.65, []),
        ("hull_low", 0.0, 0.45, []),
    ],
)
def test_obstacles_are_what_a_car_cannot_stand_in(
    part: str, y: float, z: float, expected: list[str]
) -> None:
    assert watch(part, y=y, z=z).obstacles() == expected
