"""ASAM's own checker of OpenDRIVE files finds nothing to complain about in the maps that mjdrive draws."""

import subprocess
import sys
from pathlib import Path

import pytest
from lxml import etree

from mjdrive.town import library, opendrive
from mjdrive.town.streets.generator import generate_plan
from mjdrive.town.streets.street_builder import build_map

CHECKER = Path(sys.prefix) / "checker" / "bin" / "qc_opendrive"
"""In an environment of its own, which `make install` sets up: it needs an older numpy."""

needs_checker = pytest.mark.skipif(
    not CHECKER.exists(), reason="ASAM's checker is not there; see `make install`"
)

NUM_RULES = 22
"""All but one, which is for versions before 1.8."""

CONFIGURATION = """
<Config>
  <Param name="InputFile" value="{map}"/>
  <CheckerBundle application="xodrBundle"><Param name="resultFile" value="{report}"/></CheckerBundle>
</Config>
"""


def check(road_map: Path, folder: Path) -> tuple[int, list[str]]:
    """Run the checker; returns how many rules it looked at and what it found."""
    configuration, report = folder / "configuration.xml", folder / "report.xml"
    configuration.write_text(CONFIGURATION.format(map=road_map, report=report))
    subprocess.run([CHECKER, "-c", configuration], check=True, cwd=folder, capture_output=True)
    rules = list(etree.parse(report).iterfind(".//Checker"))
    issues = [
        f"{rule.get('checkerId')}: {issue.get('description')}"
        for rule in rules
        for issue in rule.iterfind("Issue")
    ]
    return sum(rule.get("status") == "completed" for rule in rules), issues


@needs_checker
@pytest.mark.parametrize("name", library.shipped_names())
def test_committed_maps_pass_every_rule(name: str, tmp_path: Path) -> None:
    num_rules, issues = check(library.folder_of(name) / library.MAP_FILE, tmp_path)
    assert issues == []
    assert num_rules == NUM_RULES


@needs_checker
@pytest.mark.parametrize("seed", [0])
def test_generated_maps_pass_every_rule(seed: int, tmp_path: Path) -> None:
    plan = generate_plan(name="generated", num_junctions=5 + seed, seed=seed)
    (tmp_path / "map.xodr").write_bytes(opendrive.write(build_map(plan)))
    assert check(tmp_path / "map.xodr", tmp_path)[1] == []


@needs_checker
def test_the_checker_sees_what_is_wrong(tmp_path: Path) -> None:
    document = (library.folder_of("town02") / library.MAP_FILE).read_bytes()
    broken = document.replace(b"<line/>", b"<bow/>", 1)
    assert broken != document
    (tmp_path / "map.xodr").write_bytes(broken)
    assert any("schema" in issue for issue in check(tmp_path / "map.xodr", tmp_path)[1])
