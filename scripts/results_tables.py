"""Write the tables of docs/results.md and README.md that have marks from the results of the studies in docs/results.

Example: python scripts/results_tables.py
"""

from pathlib import Path

from mjdrive.config import read_json
from mjdrive.study.records.results import RESULTS, STUDY, StudyRecord, StudyResults
from mjdrive.study.tables.ablation_table import ablation_table
from mjdrive.study.tables.ratio_table import ratio_table
from mjdrive.study.tables.summary_table import summary_table

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs" / "results"
STUDIES = {"seeds": DOCS, "methods": DOCS / "methods", "ablations": DOCS / "ablations"}
"""Where each study is kept, by how its tables are called."""

PAGES = (ROOT / "docs" / "results.md", ROOT / "README.md")


def tables() -> dict[str, str]:
    """Every table in Markdown, by the mark that it stands at."""
    found = {}
    for name, folder in STUDIES.items():
        config = read_json(StudyRecord, folder / STUDY).settings
        results = read_json(StudyResults, folder / RESULTS)
        if name == "ablations":
            found[name] = ablation_table(config, results)
            continue
        found[f"{name}, in short"] = summary_table(config, results)
        if name == "seeds":
            found[f"{name}, beside the bars"] = ratio_table(config, results)
    return found


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
