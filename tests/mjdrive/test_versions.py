import re
from pathlib import Path

import mujoco
import pytest

from mjdrive import versions
from mjdrive.errors import WorkerError


def test_versions_are_those_of_the_packages() -> None:
    found = versions.versions()
    assert found["mujoco"] == mujoco.__version__
    assert set(found) == {"mjdrive", "python", "mujoco", "numpy", "torch"}
    assert all(re.match(r"\d+\.\d+", version) for version in found.values())


def test_from_metadata_undoes_to_metadata() -> None:
    found = versions.versions()
    assert versions.from_metadata({**versions.to_metadata(found), "settings": "{}"}) == found


def test_machines_that_work_together_compare_more_than_episodes_hold() -> None:
    found = versions.all_versions()
    assert set(found) - set(versions.versions()) == {
        "casadi",
        "h5py",
        "matplotlib",
        "opencv",
        "shapely",
    }
    assert "unknown" not in found.values()
    versions.require_same(found)
    for package in ("casadi", "shapely", "opencv"):
        with pytest.raises(WorkerError, match=f"expected {package} 0.1"):
            versions.require_same(found | {package: "0.1"})


def test_package_under_another_name_is_found_and_a_missing_one_is_unknown() -> None:
    assert versions.version_of("no-such-package", "mujoco") == mujoco.__version__
    assert versions.version_of("no-such-package") == "unknown"


def test_code_is_known_by_names_and_content_of_its_files_wherever_it_is(tmp_path: Path) -> None:
    def digest(place: str, **files: str) -> str:
        package = tmp_path / place / "package"
        (package / "room").mkdir(parents=True)
        for name, content in files.items():
            (package / "room" / name.replace("_", ".")).write_text(content)
        return versions.digest_of_sources(package)

    here = digest("here", a_py="x = 1", page_jinja="{{ x }}")
    assert here == digest("there", a_py="x = 1", page_jinja="{{ x }}", notes_txt="not code")
    changed = (
        digest("content", a_py="x = 2", page_jinja="{{ x }}"),
        digest("page", a_py="x = 1", page_jinja="{{ y }}"),
        digest("name", b_py="x = 1", page_jinja="{{ x }}"),
    )
    assert len({here, *changed}) == 4
    assert re.fullmatch(r"[0-9a-f]{64}", versions.code_digest())
