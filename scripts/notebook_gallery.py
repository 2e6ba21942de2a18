"""Run the notebooks and show them on one page: text, code and pictures.

Example: python scripts/notebook_gallery.py --out gallery --covers docs/notebooks

The page needs nothing beside it. With --covers, the picture of each notebook whose cell has the tag "cover" is written into a folder.
"""

import base64
import io
from pathlib import Path

import click
import jinja2
import nbformat
from markdown_it import MarkdownIt
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError
from nbformat import NotebookNode
from PIL import Image

from mjdrive.cli.main import Script
from mjdrive.errors import MjdriveError
from mjdrive.files import write_atomically

NOTEBOOKS = Path(__file__).resolve().parents[1] / "notebooks"
PAGE = "index.html"
TIMEOUT_S = 600  # for one cell, on any machine
COVER_WIDTH_PX = 1100
COVER_COLOURS = 256  # curves and flat fields need no more: a third of the bytes

TEMPLATE = """<!doctype html>
<html lang="en"><meta charset="utf-8"><title>mjdrive: notebooks</title>
<style>
  body { font: 16px/1.5 system-ui, sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; color: #1f2328 }
  img { max-width: 100% }  pre { background: #f6f8fa; padding: .8rem; overflow-x: auto; font-size: 13px }
  p, li { max-width: 46rem }  summary { color: #57606a; cursor: pointer }  article + article { border-top: 2px solid #d0d7de }
</style>
{% for cells in notebooks %}<article>{% for cell in cells %}
{% if cell.text %}{{ cell.text | safe }}{% else %}<details><summary>code</summary><pre>{{ cell.code }}</pre></details>
{% for said in cell.said %}<pre>{{ said }}</pre>{% endfor %}
{% for picture in cell.pictures %}<img alt="" src="data:image/png;base64,{{ picture }}">{% endfor %}{% endif %}
{% endfor %}</article>{% endfor %}
</html>
"""


class NotebookError(MjdriveError):
    """A notebook does not run through."""


def execute(path: Path) -> NotebookNode:
    """Run a notebook from its first cell to its last, in its own folder.

    Args:
        path: Of the notebook, which is not changed.

    Returns:
        The notebook with what its cells have put out.

    Raises:
        NotebookError: If a cell fails.
    """
    notebook = nbformat.read(path, as_version=4)
    client = NotebookClient(
        notebook,
        timeout=TIMEOUT_S,
        kernel_name="python3",
        resources={"metadata": {"path": str(path.parent)}},
    )
    try:
        return client.execute()
    except CellExecutionError as error:
        raise NotebookError(
            f"'{path}' does not run through: {error.ename}: {error.evalue}. Expected every cell to run; open the notebook, "
            f"or run `pytest --nbmake '{path}'`, to see where."
        ) from error


def pictures_of(cell: NotebookNode) -> list[str]:
    """The pictures that a cell has put out, as PNG in base 64."""
    found = (output.get("data", {}).get("image/png") for output in cell.get("outputs", ()))
    return [picture for picture in found if picture is not None]


def page(notebooks: list[NotebookNode]) -> str:
    """Show notebooks that have been run as HTML."""
    markdown = MarkdownIt("commonmark").enable("table")
    articles = [
        [
            {"text": markdown.render(cell.source)}
            if cell.cell_type == "markdown"
            else {
                "code": cell.source,
                "said": [output.text for output in cell.outputs if "text" in output],
                "pictures": pictures_of(cell),
            }
            for cell in notebook.cells
        ]
        for notebook in notebooks
    ]
    return jinja2.Environment(autoescape=True).from_string(TEMPLATE).render(notebooks=articles)


def cover(notebook: NotebookNode) -> bytes | None:
    """The picture of the cell with the tag "cover" as a small PNG; None where there is none."""
    for cell in notebook.cells:
        if "cover" in cell.metadata.get("tags", ()) and (found := pictures_of(cell)):
            picture = Image.open(io.BytesIO(base64.b64decode(found[0]))).convert("RGB")
            height = round(picture.height * COVER_WIDTH_PX / picture.width)
            small = picture.resize((COVER_WIDTH_PX, height), Image.Resampling.LANCZOS)
            content = io.BytesIO()
            small.quantize(COVER_COLOURS).save(content, format="png", optimize=True)
            return content.getvalue()
    return None


@click.command(cls=Script)
@click.argument("paths", nargs=-1, type=click.Path(path_type=Path, exists=True, dir_okay=False))
@click.option("--out", type=click.Path(path_type=Path), default=Path("gallery"), show_default=True)
@click.option("--covers", type=click.Path(path_type=Path), help="Folder for one picture of each.")
def main(*, paths: tuple[Path, ...], out: Path, covers: Path | None) -> None:
    """Run notebooks, all of them if none is given, and show them on one page."""
    run = []
    for path in paths or sorted(NOTEBOOKS.glob("*.ipynb")):
        click.echo(f"running {path.name}")
        run.append(execute(path))
        picture = cover(run[-1])
        if covers is not None and picture is not None:
            write_atomically(covers / f"{path.stem}.png", picture)
    write_atomically(out / PAGE, page(run).encode())
    click.echo(f"Page: {out / PAGE}")


if __name__ == "__main__":
    main()
