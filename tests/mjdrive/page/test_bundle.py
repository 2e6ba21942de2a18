"""The committed page is what its source gives: nobody has to trust a bundle that cannot be read."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from mjdrive.page import built

BUILT = built.FOLDER
SOURCE = BUILT.parent / "browser"
NPM = shutil.which("npm")


def run(*command: str, folder: Path) -> None:
    found = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert found.returncode == 0, found.stdout + found.stderr


@pytest.mark.slow
@pytest.mark.skipif(NPM is None, reason="no npm on this machine")  # in CI a skipped test fails
@pytest.mark.timeout(600)
def test_the_committed_page_is_a_fresh_build_of_its_source(tmp_path: Path) -> None:
    page = shutil.copytree(SOURCE, tmp_path / "page", ignore=shutil.ignore_patterns("node_modules"))
    assert NPM is not None
    run(NPM, "ci", "--no-audit", "--no-fund", folder=page)
    run(NPM, "run", "build", folder=page)
    fresh = {it.name: it.read_bytes() for it in (tmp_path / "static").iterdir()}
    committed = {it.name: it.read_bytes() for it in BUILT.iterdir()}
    assert fresh.keys() == committed.keys()
    different = [name for name in fresh if fresh[name] != committed[name]]
    assert not different, "run `npm ci && npm run build` in mjdrive/page/browser, and commit"


def test_every_locked_package_has_a_digest_and_no_address() -> None:
    lock = json.loads((SOURCE / "package-lock.json").read_text())
    packages = {name: it for name, it in lock["packages"].items() if name}
    assert len(packages) > 10
    for name, package in packages.items():
        assert package["integrity"].startswith("sha512-"), name
        assert "resolved" not in package, name
