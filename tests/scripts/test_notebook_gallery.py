"""The page of notebooks: what cells put out is on it, and a cell that fails is told."""

import base64
import io

import nbformat
import pytest
from click.testing import CliRunner
from PIL import Image

DRAWS = """import io
from IPython.display import Image as Shown, display
from PIL import Image
print("<b> is bold")
content = io.BytesIO()
Image.new("RGB", (40, 20), (9, 105, 218)).save(content, format="png")
display(Shown(content.getvalue()))
"""


@pytest.fixture
def script(load_script):
    return load_script("notebook_gallery")


def notebook(path, code):
    cells = [
        nbformat.v4.new_markdown_cell("# A blue field"),
        nbformat.v4.new_code_cell(code, metadata={"tags": ["cover"]}),
    ]
    nbformat.write(nbformat.v4.new_notebook(cells=cells), path)
    return path


def test_text_code_and_pictures_are_on_the_page_and_the_cover_beside_it(script, tmp_path):
    path = notebook(tmp_path / "blue.ipynb", DRAWS)
    before = path.read_bytes()
    out, covers = tmp_path / "gallery", tmp_path / "covers"
    arguments = [str(path), "--out", str(out), "--covers", str(covers)]
    result = CliRunner().invoke(script.main, arguments, catch_exceptions=False)
    assert result.exit_code == 0, result.output
    page = (out / "index.html").read_text()
    assert "<h1>A blue field</h1>" in page
    assert "&lt;b&gt; is bold" in page
    assert "<b>" not in page
    picture = page.partition("data:image/png;base64,")[2].partition('"')[0]
    shown = Image.open(io.BytesIO(base64.b64decode(picture)))
    assert shown.size == (40, 20)
    assert shown.convert("RGB").getpixel((0, 0)) == (9, 105, 218)
    with Image.open(covers / "blue.png") as small:
        assert small.size == (1100, 550)
    assert path.read_bytes() == before


def test_a_cell_that_fails_is_told_in_one_line_and_leaves_no_page(script, tmp_path):
    path = notebook(tmp_path / "broken.ipynb", "1 / 0")
    result = CliRunner().invoke(script.main, [str(path), "--out", str(tmp_path / "gallery")])
    assert result.exit_code == 2
    assert "broken.ipynb' does not run through: ZeroDivisionError" in result.output
    assert not (tmp_path / "gallery").exists()
