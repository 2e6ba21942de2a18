"""Write the tables of docs/experts.md from what was measured.

Before: `python scripts/check_experts.py --expert pid --expert mpc --out docs/experts/checks.json` and
`python scripts/steering_bound.py --pace 1 --pace 0.9 --pace 0.8 --out docs/experts/steering_bound.json`.
"""

from pathlib import Path

from mjdrive.cli import expert_tables
from mjdrive.config import read_json
from mjdrive.evaluation.expert_bars import bars
from mjdrive.evaluation.expert_drives import Checks
from mjdrive.evaluation.steering_bound import Bounds

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "experts.md"
CHECKS = ROOT / "docs" / "experts" / "checks.json"
BOUNDS = ROOT / "docs" / "experts" / "steering_bound.json"


def tables() -> dict[str, str]:
    """Every table in Markdown, by the mark that it stands at."""
    checks = read_json(Checks, CHECKS)
    return {
        "drives": expert_tables.provenance(checks),
        "laps": expert_tables.laps_table(checks.drives),
        "bars": expert_tables.bars_table(bars(checks.drives)),
        "times": expert_tables.times_table(checks.drives),
        "comfort": expert_tables.comfort_table(checks.drives),
        "bound": expert_tables.bounds_table(read_json(Bounds, BOUNDS).bounds),
    }


def with_tables(text: str) -> str:
    """Put the tables between their marks in the page."""
    for mark, table in tables().items():
        begin, end = f"<!-- {mark}: begin -->\n", f"<!-- {mark}: end -->"
        head, _, rest = text.partition(begin)
        _, _, tail = rest.partition(end)
        text = f"{head}{begin}{table}\n{end}{tail}"
    return text


if __name__ == "__main__":
    PAGE.write_text(with_tables(PAGE.read_text()))
