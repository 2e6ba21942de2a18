"""Each export, read back by the reader of the project whose format it is."""

import base64
import io
import json
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium
import mcap.reader
import minari
import numpy as np
import pytest
from PIL import Image
from rerun.chunk import RrdReader

from mjdrive.config import BevConfig
from mjdrive.datatypes import Action
from mjdrive.envs.world import World
from mjdrive.episodes.views import states
from mjdrive.exchange.mcap import TOPICS, UNITS
from mjdrive.exchange.rewards import rewards_of
from mjdrive.exchange.sources import Recording
from mjdrive.exchange.views import ViewMaker
from mjdrive.recording.playback import Playback, car_of, town_of

Exported = Callable[[str], Path]


def test_minari_reads_observations_actions_and_the_environment(
    exported: Exported, recordings: list[Recording]
) -> None:
    dataset = minari.MinariDataset(exported("minari"))
    episode = recordings[0].episode
    steps = len(episode.time) - 1  # nobody saw what the last action led to
    assert (dataset.total_episodes, dataset.total_steps) == (2, 2 * steps)
    assert dataset.env_spec.id == "mjdrive/Town02-v0"
    assert gymnasium.spec(dataset.env_spec.id).kwargs == {"town": "town02"}  # as before
    read = dataset[0]
    views = ViewMaker(town_of(episode))
    seen = [views.bev(episode, step) for step in range(steps + 1)]
    np.testing.assert_array_equal(read.observations["bev"], seen)
    np.testing.assert_array_equal(read.observations["state"], states(episode))
    np.testing.assert_array_equal(read.actions, episode.actions[:-1].astype(np.float32))
    np.testing.assert_array_equal(read.infos["vehicle"], episode.vehicle)
    assert read.truncations.tolist() == [False] * (steps - 1) + [True]
    assert not read.terminations.any()
    for index in range(steps):
        first = {name: values[index] for name, values in read.observations.items()}
        assert dataset.observation_space.contains(first)
        assert dataset.action_space.contains(read.actions[index])


def test_the_rewards_are_those_that_the_environment_pays(recordings: list[Recording]) -> None:
    episode = recordings[1].episode
    world, playback = World("town02"), Playback(episode)
    world.simulation = playback.simulation
    playback.show(0)
    paid = []
    for acceleration, steering in episode.actions[:-1]:
        paid.append(world.step(Action(float(acceleration), float(steering))).reward)
    town, parameters = town_of(episode), car_of(episode).parameters
    clean = rewards_of(episode, town, parameters)
    np.testing.assert_allclose(clean, paid, atol=1e-9)
    cost = clean - rewards_of(recordings[0].episode, town, parameters)
    assert np.flatnonzero(cost).tolist() == [4]  # from 0.4 s to 0.5 s
    assert cost[4] == pytest.approx(10.0)


def test_mcap_reads_every_topic_at_its_time(
    exported: Exported, recordings: list[Recording]
) -> None:
    episode, told = recordings[0].episode, defaultdict(list)
    with (exported("mcap") / "bad.mcap").open("rb") as file:
        reader = mcap.reader.make_reader(file)
        for schema, channel, message in reader.iter_messages():
            content = json.loads(message.data)
            assert schema is not None
            assert (schema.name, schema.encoding) == (TOPICS[channel.topic], "jsonschema")
            assert set(content) == set(json.loads(schema.data)["properties"])
            told[channel.topic].append((message.log_time * 1e-9, content))
        about = {it.name: it.metadata for it in reader.iter_metadata()}
    assert about["episode"]["town"] == "town02"
    assert set(told) == set(TOPICS)
    cars = told["/car"]
    np.testing.assert_allclose([time for time, _ in cars], episode.time)
    expected = np.hstack([episode.vehicle[:, 3:], episode.actions, episode.labels])
    np.testing.assert_array_equal([[it[name] for name in UNITS] for _, it in cars], expected)
    places = [(it["translation"]["x"], it["translation"]["y"]) for _, it in told["/tf"]]
    np.testing.assert_array_equal(places, episode.vehicle[:, :2])
    ((time, said),) = told["/infractions"]
    assert (time, said["level"], "pole" in said["message"]) == (0.5, 4, True)
    picture = Image.open(io.BytesIO(base64.b64decode(told["/view"][0][1]["data"])))
    assert picture.size == (2 * BevConfig().size_px, 2 * BevConfig().size_px)


def test_rerun_reads_every_entity_over_time(
    exported: Exported, recordings: list[Recording]
) -> None:
    episode = recordings[0].episode
    columns: dict[str, Any] = {}
    rows: dict[str, int] = defaultdict(int)
    for chunk in RrdReader(exported("rerun") / "bad.rrd").stream():
        rows[str(chunk.entity_path)] += chunk.num_rows
        columns[str(chunk.entity_path)] = chunk.to_record_batch()
    steps = len(episode.time)
    assert {rows[name] for name in ("/speed", "/steering", "/car", "/view")} == {steps}
    assert {rows[name] for name in ("/path", "/town/lanes", "/infractions")} == {1}
    speeds = columns["/speed"].column("Scalars:scalars").to_pylist()
    np.testing.assert_allclose(np.ravel(speeds), episode.vehicle[:, 3])
    times = columns["/speed"].column("time").to_pylist()
    np.testing.assert_allclose([it.total_seconds() for it in times], episode.time)
