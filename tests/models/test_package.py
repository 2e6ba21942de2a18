from pathlib import Path

import models


def test_the_imported_models_is_the_package_of_this_project():
    root = Path(__file__).parents[2]
    assert Path(models.__file__) == root / "models" / "__init__.py"
