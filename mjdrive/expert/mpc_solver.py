"""Solves the problem of the MPC expert with one of casadi's solvers, and says how that went."""

import time
from collections.abc import Callable, Mapping
from enum import Enum
from types import MappingProxyType
from typing import Any, NamedTuple

import casadi as ca
import numpy as np
from jaxtyping import Float

from mjdrive.config import MpcConfig
from mjdrive.errors import SolverError
from mjdrive.expert.mpc_problem import Bounds, MpcProblem
from mjdrive.expert.solves import SolveCounts


class SolveStatus(Enum):
    """How a solve ended."""

    SOLVED = "solved"
    MAX_ITERATIONS = "max_iterations"
    FAILED = "failed"


class Solution(NamedTuple):
    """What a solver found.

    Attributes:
        status: How the solve ended; only `SOLVED` is a plan.
        variables: In the order of the problem, shape (X,), mixed units.
        cost: Of the plan [-].
        iterations: Of the solver [-].
    """

    status: SolveStatus
    variables: Float[np.ndarray, " X"]
    cost: float
    iterations: int


class Recipe(NamedTuple):
    """How one solver is made.

    Attributes:
        plugins: casadi's plug-ins that it needs, as (kind, name) with kind "nlpsol" or "conic".
        options: Its options for a problem and settings.
    """

    plugins: tuple[tuple[str, str], ...]
    options: Callable[[MpcProblem, MpcConfig], dict[str, Any]]


def _fatrop(problem: MpcProblem, config: MpcConfig) -> dict[str, Any]:
    return {
        "structure_detection": "auto",
        "equality": problem.equality,
        "fatrop": {
            "print_level": 0,
            "tol": config.tolerance,
            "max_iter": config.max_iterations,
        },
    }


def _ipopt(problem: MpcProblem, config: MpcConfig) -> dict[str, Any]:
    del problem
    return {
        "ipopt": {
            "print_level": 0,
            "sb": "yes",
            "tol": config.tolerance,
            "max_iter": config.max_iterations,
        }
    }


def _sqp(qpsol: str, qpsol_options: dict[str, Any]) -> Recipe:
    """Sequential quadratic programming with the Gauss-Newton Hessian, which is constant here."""

    def options(problem: MpcProblem, config: MpcConfig) -> dict[str, Any]:
        return {
            "qpsol": qpsol,
            "qpsol_options": {"error_on_fail": False, **qpsol_options},
            "hess_lag": _gauss_newton(problem),
            "max_iter": config.max_iterations,
            "tol_pr": config.tolerance,
            "tol_du": 10 * config.tolerance,
            "print_header": False,
            "print_iteration": False,
            "print_status": False,
        }

    return Recipe((("nlpsol", "sqpmethod"), ("conic", qpsol)), options)


def _gauss_newton(problem: MpcProblem) -> ca.Function:
    x, g, p = (problem.symbols[name] for name in "xgp")
    scale, multipliers = ca.SX.sym("scale"), ca.SX.sym("multipliers", g.numel())
    hessian, _ = ca.hessian(problem.symbols["f"], x)
    return ca.Function(
        "hess_lag",
        [x, p, scale, multipliers],
        [scale * hessian],
        ["x", "p", "lam_f", "lam_g"],
        ["hess_gamma_x_x"],
    )


_QUIET_QRQP = {"print_header": False, "print_iter": False, "print_info": False}
_EXACT_OSQP = {"osqp": {"verbose": False, "eps_abs": 1e-5, "eps_rel": 1e-5}}

SOLVERS: Mapping[str, Recipe] = MappingProxyType(
    {
        "fatrop": Recipe((("nlpsol", "fatrop"),), _fatrop),
        "ipopt": Recipe((("nlpsol", "ipopt"),), _ipopt),
        "sqpmethod+osqp": _sqp("osqp", _EXACT_OSQP),
        "sqpmethod+qrqp": _sqp("qrqp", _QUIET_QRQP),
        "sqpmethod+piqp": _sqp("piqp", {}),
    }
)
"""Solvers that `MpcConfig.solver` can name; scripts/bench/mpc_solvers.py times them."""


def is_available(name: str) -> bool:
    """Whether this casadi has every plug-in that a solver of `SOLVERS` needs."""
    return not _missing(name)


def _missing(name: str) -> list[str]:
    return [
        f"{kind} '{plugin}'"
        for kind, plugin in SOLVERS[name].plugins
        if not (ca.has_nlpsol(plugin) if kind == "nlpsol" else ca.has_conic(plugin))
    ]


def choose(config: MpcConfig) -> str:
    """Name of the solver to use: the wanted one, or its stand-in where the settings name one.

    Raises:
        SolverError: If casadi lacks a plug-in, or no solver has that name.
    """
    wanted = (config.solver, *filter(None, [config.fallback_solver]))
    available = ", ".join(name for name in SOLVERS if is_available(name)) or "none"
    for name in wanted:
        if name not in SOLVERS:
            raise SolverError(
                f"Unknown solver '{name}' for the MPC expert. Known: {', '.join(SOLVERS)}; "
                f"available here: {available}."
            )
    for name in wanted:
        if is_available(name):
            return name
    lacking = "; ".join(f"'{name}' needs {', '.join(_missing(name))}" for name in wanted)
    raise SolverError(
        f"This casadi lacks plug-ins for the MPC expert: {lacking}. Available here: "
        f"{available}. Install casadi from PyPI, or set solver or fallback_solver to one of these."
    )


class MpcSolver:
    """A solver made for one problem; iterations limit it, never the clock, so equal problems get equal plans.

    Attributes:
        name: Of the solver, one of `SOLVERS`.
        counts: How its solves have ended.

    Args:
        problem: What to solve.
        config: Solver, its limits and tolerance.

    Raises:
        SolverError: If casadi lacks a plug-in and the settings name no stand-in that is there.
    """

    def __init__(self, problem: MpcProblem, config: MpcConfig) -> None:
        self.name = choose(config)
        self.counts = SolveCounts()
        self._config = config
        recipe = SOLVERS[self.name]
        quiet = {"print_time": False, "error_on_fail": False}
        self._solver = ca.nlpsol(
            "mpc",
            recipe.plugins[0][1],
            problem.symbols,
            {**quiet, **recipe.options(problem, config)},
        )

    def solve(
        self,
        guess: Float[np.ndarray, " X"],
        parameters: Float[np.ndarray, " P"],
        bounds: Bounds,
    ) -> Solution:
        """Solve one instance.

        Args:
            guess: Variables to begin with.
            parameters: From `MpcProblem.parameters`.
            bounds: From `MpcProblem.bounds`.

        Returns:
            The plan, or how the solve failed.
        """
        begin = time.thread_time()
        result = self._solver(x0=guess, p=parameters, **bounds._asdict())
        spent = time.thread_time() - begin
        statistics = self._solver.stats()
        variables = np.asarray(result["x"].full()).ravel()
        iterations = int(statistics.get("iter_count", 0))
        if statistics["success"] and np.isfinite(variables).all():
            status = SolveStatus.SOLVED
        elif iterations >= self._config.max_iterations:
            status = SolveStatus.MAX_ITERATIONS
        else:
            status = SolveStatus.FAILED
        counts = self.counts
        setattr(counts, status.value, getattr(counts, status.value) + 1)
        counts.times.append(spent)
        return Solution(status, variables, float(result["f"]), iterations)
