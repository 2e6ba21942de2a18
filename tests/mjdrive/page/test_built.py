"""The page in one file; tests/mjdrive/web/browser/test_exported_page.py opens one."""

import re
from pathlib import Path

import pytest

from mjdrive.errors import RenderError
from mjdrive.page import built


def test_words_of_a_drive_cannot_become_markup() -> None:
    text = built.with_drive({"title": "</title><script>1</script>", "note": "</script><!--"})
    assert re.findall(r"<title>(.*?)</title>", text) == [
        "&lt;/title&gt;&lt;script&gt;1&lt;/script&gt;"
    ]
    assert text.count("</script>") == 2


def test_nothing_of_the_built_page_ends_the_element_that_it_is_put_into() -> None:
    script, style = ((built.FOLDER / name).read_text() for name in ("page.js", "page.css"))
    assert not re.search(r"</script|<!--", script, flags=re.IGNORECASE)
    assert "</style" not in style.lower()


def test_a_page_that_was_never_built_is_missed_with_what_to_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(built, "FOLDER", tmp_path / "static")
    with pytest.raises(RenderError, match="npm ci"):
        built.require_built(built.FOLDER)
