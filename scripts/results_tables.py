"""Write the tables of docs/results.md and README.md that have marks from the results of the studies in docs/results.

Example: python scripts/results_tables.py
"""

from pathlib import Path

from mjdrive.config import read_json
from mjdrive.study.records.results import RESULTS, STUDY, StudyRecord, StudyResults
from mjdrive.study.tables.tables import (
    ABLATIONS,
    DATA,
    MULTIMODALITY,
    PAPER,
    RATIOS,
    SUMMARY,
    study_tables,
)

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs" / "results"
STUDIES = {"seeds": DOCS, "methods": DOCS / "methods", "ablations": DOCS / "ablations"}
"""Where each study is kept, by how its tables are called."""

PAGES = (ROOT / "docs" / "results.md", ROOT / "README.md")


MARKS = {
    "seeds, in short": ("seeds", SUMMARY),
    "seeds, beside the bars": ("seeds", RATIOS),
    "seeds, as the paper counts": ("seeds", PAPER),
    "seeds, multimodality": ("seeds", MULTIMODALITY),
    "seeds, demonstrations": ("seeds", DATA),
    "methods, in short": ("methods", SUMMARY),
    "ablations": ("ablations", ABLATIONS),
}
"""Study and table that stand at each mark."""


def tables() -> dict[str, str]:
    """Every table in Markdown, by the mark that it stands at."""
    made = {
        name: study_tables(
            read_json(StudyRecord, folder / STUDY).settings,
            read_json(StudyResults, folder / RESULTS),
        )
        for name, folder in STUDIES.items()
    }
    return {mark: made[study][table] for mark, (study, table) in MARKS.items()}


def with_tables(text: str) -> str:
    """Put the tables between their marks in a page; it need not have all.

    Raises:
        ValueError: If a mark begins and does not end.
    """
    for mark, table in tables().items():
        begin, end = f"<!-- {mark}: begin -->\n", f"<!-- {mark}: end -->"
        if begin not in text:
            continue
        head, _, rest = text.partition(begin)
        if end not in rest:
            raise ValueError(f"A page has '{begin.strip()}' and no '{end}' after it; put it back.")
        _, _, tail = rest.partition(end)
        text = f"{head}{begin}\n{table}\n{end}{tail}"
    return text


if __name__ == "__main__":
    for page in PAGES:
        page.write_text(with_tables(page.read_text("utf-8")), "utf-8")
