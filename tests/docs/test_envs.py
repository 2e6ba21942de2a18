from pathlib import Path

import pytest
from mktestdocs import check_md_file

from mjdrive.config import RewardConfig

PAGE = Path(__file__).parents[2] / "docs" / "envs.md"


def test_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    check_md_file(PAGE, memory=True)


def test_page_tells_the_default_rewards() -> None:
    rows = [line.split("|") for line in PAGE.read_text().splitlines() if line.startswith("| `")]
    told = {
        name.strip(" `"): float(row[2])
        for row in rows
        if row[3].strip() in ("1/m", "s3/m2", "-") and row[2].strip().replace(".", "").isdigit()
        for name in row[1].split(",")
    }
    defaults = RewardConfig()
    assert told == {
        name: getattr(defaults, name) for name in RewardConfig.__slots__ if name != "rewarded_speed"
    }
