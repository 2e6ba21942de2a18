"""`mjdrive study`: what it refuses before anything runs, and the quick one as it is typed, to its report."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from mjdrive.cli.main import main
from mjdrive.cli.study import study
from mjdrive.study.records.reading import read_study
from mjdrive.study.settings.overrides import chosen
from mjdrive.study.tables import tables


def refused(tmp_path: Path, *options: str) -> str:
    out = tmp_path / "study"
    result = CliRunner().invoke(main, ["study", "--preset", "quick", "--out", str(out), *options])
    assert result.exit_code == 2
    assert not out.exists(), "nothing was begun"
    return " ".join(result.output.split())


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--preset", "slow"), "Unknown study preset 'slow'"),
        (("--methods", "bc-beta,da-ibb"), "Did you mean 'da-ibc'"),
        (("--seeds", "one"), "'one' is no seed"),
        (("--set", "long_step=3"), "Did you mean 'long_steps'"),
        (("--set", "optimiser.epochs=0"), "epochs is 0"),
        (("--data", "nowhere"), "Data folder 'nowhere' does not exist"),
        (("--runs", "nowhere"), "There is no folder 'nowhere'"),
        (("--jobs", "0"), "0 is too small; expected at least 1, or auto"),
        (("--backend", "rey"), "Did you mean 'ray'"),
        (("--address", "10.0.0.7:6379"), "no effect with --backend local"),
        (("--backend", "ray", "--address", "127.0.0.1:1"), "Nobody answers at '127.0.0.1:1'"),
    ],
)
def test_mistakes_are_refused_before_anything_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, options: tuple[str, ...], said: str
) -> None:
    monkeypatch.chdir(tmp_path)
    assert said in refused(tmp_path, *options)


def test_the_command_is_kept_with_every_option(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun = []

    class Begun(Exception):  # noqa: N818
        pass

    def begin(self: object, stage: object) -> None:
        begun.append(self)
        raise Begun

    monkeypatch.setattr("mjdrive.study.study.Study.run", begin)
    options = ["--preset", "quick", "--set", "long_steps=0", "--out", str(tmp_path / "my study")]
    monkeypatch.setattr("sys.argv", ["/usr/bin/mjdrive", "study", *options])
    with pytest.raises(Begun):
        study.main(options, standalone_mode=False)
    assert [it.command for it in begun] == [
        f"mjdrive study --preset quick --set long_steps=0 --out '{tmp_path}/my study'"
    ]


@pytest.mark.slow
@pytest.mark.timeout(900)  # a minute of a core, on a machine that may be busy
def test_the_quick_study_runs_as_it_is_typed_to_its_report(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "mjdrive", "study", "--preset", "quick", "--out", "quick"]
    told = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr
    assert "quick/report.html" in told.stdout
    folder, config = tmp_path / "quick", chosen("quick")
    found = read_study(folder)
    assert found.record.settings == config
    assert found.record.command.endswith("study --preset quick --out quick")
    assert [it.arm for it in found.results.arms] == [it.name for it in config.arms]
    walks = [it.arm for it in found.results.references]
    assert walks == ["expert"] * config.expert_walks + ["right-walker"]
    for it in (*found.results.references, *found.results.arms):
        assert [drive.steps for drive in it.drives] == [config.steps] * config.episodes
    for it in found.results.arms:
        assert it.long_drive is not None
        assert it.long_drive.steps == config.long_steps
        assert [fork.rollouts for fork in it.forks] == [config.fork_rollouts] * config.forks
        assert it.likelihood is not None
        assert it.likelihood.frames == config.held_out_frames
    epochs = {(it.arm, it.epoch) for it in found.results.progress}
    assert epochs == {(it.name, epoch) for it in config.arms for epoch in (1, 2)}
    drawn = {(it.arm, it.drawn_by, len(it.draws)) for it in found.landscapes}
    assert drawn == {("bc-beta-mode", "own", 10), ("da-ibc-committed", "dfo", 10)}
    report = (folder / "report.html").read_text()
    kept = {it.name for it in (folder / tables.TABLES).iterdir()}
    assert kept == {
        "summary.md",
        "paper.md",
        "ratios.md",
        "multimodality.md",
        "ablations.md",
        "demonstrations.md",
    }
    pictures = {it.stem for it in (folder / "pictures").iterdir()}
    assert {"recall", "turns", "trajectories", "landscapes-1", "fans", "progress"} <= pictures
    assert pictures <= set(re.findall(r'id="pictures-([^"]+)"', report))
    for arm in config.arms:
        assert arm.label in report
