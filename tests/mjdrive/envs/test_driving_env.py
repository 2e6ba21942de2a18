import re
import subprocess
import sys
import tomllib
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import mjdrive  # noqa: F401  (registers the environments)
from mjdrive.config import CameraConfig, EnvConfig, RewardConfig, from_dict
from mjdrive.datatypes import InfractionKind, Observation
from mjdrive.envs import registration
from mjdrive.envs.driving_env import DrivingEnv, observation_space
from mjdrive.errors import ConfigError, RenderError, RouteError, UnknownNameError
from mjdrive.simulation import front_cameras
from mjdrive.town import library

FULL = np.array([1.0, 0.0], np.float32)
LEFT = np.array([0.6, 1.0], np.float32)


@pytest.fixture(scope="module")
def env() -> DrivingEnv:
    """One world for all; whoever uses it resets it."""
    return DrivingEnv("town02", render_mode="rgb_array")


def test_every_shipped_town_has_an_id() -> None:
    assert library.shipped_names() == registration.TOWNS
    for town in registration.TOWNS:
        spec = gymnasium.spec(registration.id_of(town))
        assert (spec.kwargs["town"], spec.max_episode_steps) == (town, registration.TIME_LIMIT)
    assert registration.id_of("town02") == "mjdrive/Town02-v0"


@pytest.mark.parametrize("order", ["mjdrive, gymnasium", "gymnasium, mjdrive"])
def test_ids_are_there_in_either_order_of_import_and_nothing_heavy_is(order: str) -> None:
    program = (
        f"import {order}, sys\n"
        "gymnasium.spec('mjdrive/Town02-v0')\n"
        "print([name for name in ('torch', 'mujoco', 'casadi', 'shapely') if name in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout == "[]\n"


def test_importing_mjdrive_imports_nothing_else() -> None:
    program = "import mjdrive, sys; print([n for n in ('gymnasium', 'numpy', 'torch', 'mujoco') if n in sys.modules])"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout == "[]\n"


def test_entry_point_registers() -> None:
    project = tomllib.loads((Path(__file__).parents[3] / "pyproject.toml").read_text())
    ((name, value),) = project["project"]["entry-points"]["gymnasium.envs"].items()
    assert EntryPoint(name, value, "gymnasium.envs").load() is registration.register


def test_gymnasium_finds_nothing_to_complain_about() -> None:
    env = gymnasium.make("mjdrive/Town02-v0", render_mode="rgb_array")
    check_env(env.unwrapped, skip_render_check=True)  # test_windows.py renders, too


def drive(env: DrivingEnv, seed: int, *, steps: int = 30) -> list[Any]:
    rng = np.random.default_rng(0)
    seen, told = env.reset(seed=seed)
    rows: list[Any] = [(seen["bev"].tobytes(), seen["state"].tobytes(), repr(told))]
    for _ in range(steps):
        seen, reward, *ends, told = env.step(rng.uniform(-1, 1, 2).astype(np.float32))
        rows.append((seen["bev"].tobytes(), seen["state"].tobytes(), reward, *ends, repr(told)))
    return rows


def test_same_seed_same_bytes(env: DrivingEnv) -> None:
    first = drive(env, 5)
    assert drive(env, 6) != first
    assert drive(env, 5) == first


def test_vector_environments_agree_with_single_ones() -> None:
    kinds = ("sync", "async")
    seen = {}
    for kind in kinds:
        envs = gymnasium.make_vec("mjdrive/Town02-v0", num_envs=2, vectorization_mode=kind)
        start, _ = envs.reset(seed=3)
        after, rewards, *_ = envs.step(np.tile(FULL, (2, 1)))
        seen[kind] = (start["bev"].tobytes(), after["state"].tobytes(), rewards.tobytes())
        envs.close()
        assert after["bev"].shape == (2, 5, 192, 192)
        assert not np.array_equal(start["bev"][0], start["bev"][1])
    assert seen["sync"] == seen["async"]


def test_observations_belong_to_who_asked(env: DrivingEnv) -> None:
    before, _ = env.reset(seed=0)
    kept = before["bev"].copy()
    before["bev"][:] = 7
    after, _ = env.reset(seed=0)
    assert np.array_equal(after["bev"], kept)


def test_time_limit_truncates() -> None:
    env = gymnasium.make("mjdrive/Town02-v0", max_episode_steps=3)
    env.reset(seed=0)
    ends = [env.step(np.zeros(2, np.float32))[2:4] for _ in range(3)]
    assert ends == [(False, False), (False, False), (False, True)]


def test_leaving_the_road_terminates_and_costs_what_is_named(env: DrivingEnv) -> None:
    env.reset(seed=0)
    for _ in range(200):
        _, reward, terminated, truncated, told = env.step(LEFT)
        assert reward == pytest.approx(sum(told["reward_terms"].values()))
        if terminated:
            break
    assert terminated
    assert not truncated
    ended = set(told["new_infractions"]) & {"collision", "off_road"}
    assert ended
    costs = RewardConfig()
    for name in ended:
        assert told["reward_terms"][name] == -getattr(costs, name)
        assert told["infractions"][name] == 1


def test_start_can_be_chosen(env: DrivingEnv) -> None:
    town = library.load("town02")
    lane = next(name for name, lane in town.lanes.items() if lane.junction is None)
    _, told = env.reset(seed=0, options={"lane": lane, "station": 2.0})
    assert told["distance"] == 0.0
    with pytest.raises(ConfigError, match="expected 'lane'"):
        env.reset(options={"x": 3.0})
    with pytest.raises(ConfigError, match="expected 'lane'"):
        env.reset(options={"station": 3.0})
    with pytest.raises(RouteError, match="no lane 'nowhere'"):
        env.reset(options={"lane": "nowhere"})


def test_pictures_show_the_view_and_the_way(env: DrivingEnv) -> None:
    env.reset(seed=3)
    first = env.render()
    for _ in range(20):
        env.step(FULL)
    second = env.render()
    assert first is not None
    assert second is not None
    assert second.shape == first.shape == (384, first.shape[1], 3)
    assert second.dtype == np.uint8
    assert not np.array_equal(first[:, :384], second[:, :384])
    assert not np.array_equal(first[:, 384:], second[:, 384:])


MISTAKES = {
    "town": ({"town": "town2"}, UnknownNameError, "Did you mean 'town02'"),
    "view": ({"view": "chas"}, UnknownNameError, "Did you mean 'chase'"),
    "mode": ({"render_mode": "rgb"}, UnknownNameError, "Known: human, rgb_array"),
}


@pytest.mark.parametrize(("settings", "kind", "words"), MISTAKES.values(), ids=MISTAKES.keys())
def test_mistakes_are_told(settings: dict[str, Any], kind: type[Exception], words: str) -> None:
    with pytest.raises(kind, match=re.escape(words)):
        DrivingEnv(**settings)


def test_window_without_a_display_is_refused_before_anything_runs(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("mjdrive.envs.window.glfw.init", lambda: False)
    with pytest.raises(RenderError, match="Expected a display"):
        DrivingEnv("town02", render_mode="human")


def test_human_mode_shows_every_step(monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[np.ndarray] = []

    class Screen:
        def __init__(self, title: str, **size: object) -> None: ...
        def show(self, picture: np.ndarray) -> None:
            shown.append(picture)

        def close(self) -> None:
            shown.clear()

    monkeypatch.setattr("mjdrive.envs.window.require_display", lambda: None)
    monkeypatch.setattr("mjdrive.envs.window.Window", Screen)
    env = DrivingEnv("town02", render_mode="human")
    env.reset(seed=0)
    env.step(FULL)
    assert len(shown) == 2
    assert env.render() is None
    env.close()
    assert shown == []


def test_settings_are_checked() -> None:
    with pytest.raises(ConfigError, match=r"collision of the reward is -1\.0; expected 0 or more"):
        RewardConfig(collision=-1.0)
    with pytest.raises(ConfigError, match="crash not in literal"):
        from_dict(EnvConfig, {"ends_on": ["crash"]})
    assert {kind.name.lower() for kind in InfractionKind} <= set(RewardConfig.__slots__)


def test_space_holds_what_a_policy_may_see() -> None:
    assert set(Observation.__slots__) == {"bev", "state"}


def test_front_cameras_are_part_of_what_is_seen_if_asked_for() -> None:
    small = CameraConfig(width_px=32, height_px=18)
    with gymnasium.make("mjdrive/Town02-v0", cameras=small) as env:
        first, _ = env.reset(seed=4)
        assert env.observation_space.contains(first)
        assert list(first) == ["bev", "state", *front_cameras.NAMES]
        again, _ = env.reset(seed=4)
        assert all(np.array_equal(first[name], again[name]) for name in first)
        for _ in range(12):
            driven, *_ = env.step(FULL)
    for name in front_cameras.NAMES:
        assert driven[name].shape == (18, 32, 3)
        assert np.any(driven[name] != first[name])
    assert observation_space(CameraConfig())["front"].shape == (144, 256, 3)


def test_cameras_need_opengl_and_say_so_before_anything_runs(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("MUJOCO_GL", "off")
    with pytest.raises(RenderError, match="MUJOCO_GL"):
        DrivingEnv("town02", cameras=True)
