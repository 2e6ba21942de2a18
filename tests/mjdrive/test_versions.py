import re

import mujoco

from mjdrive import versions


def test_versions_are_those_of_the_packages() -> None:
    found = versions.versions()
    assert found["mujoco"] == mujoco.__version__
    assert set(found) == {"mjdrive", "python", "mujoco", "numpy", "torch"}
    assert all(re.match(r"\d+\.\d+", version) for version in found.values())


def test_from_metadata_undoes_to_metadata() -> None:
    found = versions.versions()
    assert versions.from_metadata({**versions.to_metadata(found), "settings": "{}"}) == found
