"""The built page: what a server hands out, and the same in one file with a drive inside."""

import html
import json
from pathlib import Path
from typing import Any

from mjdrive.errors import RenderError

FOLDER = Path(__file__).parent / "static"
"""`npm run build` makes it of the sources in browser/."""

SCRIPT = '<script type="module" crossorigin src="./page.js"></script>'
STYLE = '<link rel="stylesheet" crossorigin href="./page.css">'
"""How the document asks for the rest of the page."""

POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; form-action 'none'"
"""What a page in a file may load: nothing that is not in it."""


def require_built(folder: Path = FOLDER) -> None:
    """Make sure that there is a page.

    Args:
        folder: The built page.

    Raises:
        RenderError: If it was never built.
    """
    if not (folder / "index.html").is_file():
        raise RenderError(
            f"There is no built page in '{folder}'. Build it with Node: npm ci && npm run build in {folder.parent / 'browser'}."
        )


def with_drive(drive: dict[str, Any]) -> str:
    """The page as one file that asks for nothing, with a drive inside.

    Args:
        drive: Title, and what `Recording` in browser/src/source.ts has besides; JSON values.

    Raises:
        RenderError: If the page was never built.
    """
    require_built()
    document, script, style = (
        (FOLDER / name).read_text(encoding="utf-8")
        for name in ("index.html", "page.js", "page.css")
    )
    # "<" must not end the element that holds the data.
    data = json.dumps(drive, separators=(",", ":")).replace("<", "\\u003c")
    parts = {
        "<title>mjdrive</title>": f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">'
        f"<title>{html.escape(drive['title'])}</title>",
        SCRIPT: "",
        STYLE: f"<style>{style}</style>",
        "</body>": f'<script type="application/json" id="drive">{data}</script>\n'
        f'<script type="module">{script}</script>\n</body>',
    }
    for place, content in parts.items():
        before, found, after = document.partition(place)
        assert found, f"the built page has no {place}"
        document = f"{before}{content}{after}"
    return document
