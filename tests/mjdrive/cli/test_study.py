"""`mjdrive study`: what it refuses before anything runs."""

from pathlib import Path

import pytest
from click.testing import CliRunner

from mjdrive.cli.main import main
from mjdrive.cli.study import study


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
