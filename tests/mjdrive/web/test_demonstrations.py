"""What a person drives in the page is what `mjdrive train --data` learns from."""

from typing import Any

from click.testing import CliRunner

from mjdrive.cli.main import main
from mjdrive.episodes import dataset
from mjdrive.web.recording import HUMAN, SOURCE
from models import checkpoint

TINY = ["--preset", "quick", "--set", "optimiser.epochs=1"]


def test_training_accepts_what_a_person_drove(desk: Any) -> None:
    desk.say("first", "wheel", on=True)
    for seq in range(1, 41):
        desk.say("first", "keys", down=frozenset({"up", "left"}), seq=seq)
    desk.say("first", "keep")
    desk.turn(12)
    desk.say("first", "reset")
    folder = desk.kept[0].parent
    manifest, episodes = dataset.read_dataset(folder)
    assert manifest.settings[SOURCE] == HUMAN
    assert [it.metadata[SOURCE] for it in episodes] == [HUMAN, HUMAN]
    assert episodes[0].actions[-1].tolist() == [1.0, 1.0]
    run = folder.parent / "run"
    words = ["train", "bc-beta", "--data", str(folder), "--out", str(run), *TINY]
    done = CliRunner().invoke(main, words, catch_exceptions=False)
    assert done.exit_code == 0, done.stderr
    assert checkpoint.load_state(run).epoch == 1
