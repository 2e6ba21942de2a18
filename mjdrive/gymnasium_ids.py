"""Lets `gymnasium.make("mjdrive/Town02-v0")` work once mjdrive and Gymnasium are imported, in whichever order.

Gymnasium 1.0 and later find no environments by entry points, and importing Gymnasium here would make `import mjdrive`
and `mjdrive --help` slow for all who do not use it. So an import of Gymnasium that comes later is awaited.
"""

import importlib
import sys
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any

_GYMNASIUM = "gymnasium"


def offer() -> None:
    """Register our environments with Gymnasium: now if it is imported, else when it will be."""
    if _GYMNASIUM in sys.modules:
        _register()
    elif not any(isinstance(finder, _Await) for finder in sys.meta_path):
        sys.meta_path.insert(0, _Await())


def _register() -> None:
    importlib.import_module("mjdrive.envs.registration").register()


class _Await:
    """Finds Gymnasium as everybody else does, and registers our environments when it has been loaded."""

    # Of namespace packages, such as matplotlib's mpl_toolkits, the path is no Sequence, whatever typeshed says.
    def find_spec(
        self, name: str, path: Any, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if name != _GYMNASIUM:
            return None
        others = (finder for finder in sys.meta_path if finder is not self)
        found = (finder.find_spec(name, path, target) for finder in others)
        spec = next((spec for spec in found if spec is not None), None)
        if spec is not None and spec.loader is not None:
            self._follow(spec.loader)
        return spec

    def _follow(self, loader: object) -> None:
        load = loader.exec_module  # type: ignore[attr-defined]

        def load_and_register(module: ModuleType) -> None:
            load(module)
            if self in sys.meta_path:
                sys.meta_path.remove(self)
            _register()

        loader.exec_module = load_and_register  # type: ignore[attr-defined]
