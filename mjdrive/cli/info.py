"""`mjdrive info`: what this machine has, and which paths mjdrive takes on it."""

import importlib.metadata
import importlib.util
import json
import os
import shutil

import rich_click as click

Facts = dict[str, str]
"""Names and values to show."""


@click.command()
@click.option("--json", "is_json", is_flag=True, help="Print JSON instead of tables.")
def info(*, is_json: bool) -> None:
    """Show what this machine has and which paths will be used on it.

    Put the output into a bug report.
    """
    facts = {
        "machine": machine_facts(),
        "networks": network_facts(),
        "pictures": picture_facts(),
        "MPC": solver_facts(),
        "several processes": executor_facts(),
        "towns": town_facts(),
        "plug-ins": plugin_facts(),
    }
    if is_json:
        click.echo(json.dumps(facts, indent=2))
        return
    from mjdrive.cli.console import sections_table

    sections_table(facts)


def machine_facts() -> Facts:
    """Processor, memory, and the versions that decide figures and bytes."""
    from mjdrive.benchmarks import machine

    here = machine.describe()
    return {
        "processor": f"{here.processor}, {here.num_cores} cores",
        "memory": f"{here.memory_gb:g} GB" if here.memory_gb > 0 else "unknown",
        "system": here.system,
        "compiler": "none needed",
        "versions": ", ".join(f"{name} {version}" for name, version in here.versions.items()),
    }


def network_facts() -> Facts:
    """Devices, and in which number format networks learn and act."""
    from models import distributed, hardware, presets
    from models.energy_scoring import resolved, resolved_for

    device = hardware.choose_device()
    settings = presets.preset("standard", "da-ibc")
    return {
        **hardware.describe(),
        "torchrun": f"{distributed.backend(device)} between processes on {device.type}",
        "trains in": resolved(settings.optimiser.precision, device),
        "scores actions in": f"{resolved_for(settings.sampler, device)}, sampler {settings.sampler.kind}",
    }


def picture_facts() -> Facts:
    """The OpenGL that draws without a display, tried."""
    from mjdrive.errors import RenderError
    from mjdrive.simulation import opengl

    try:
        opengl.open_context(16, 16).free()
    except RenderError as error:
        return {"cameras": f"none: {error}", "maps and bird's-eye views": "OpenCV, without OpenGL"}
    return {
        "cameras": f"OpenGL through {opengl.choose_backend()}",
        "maps and bird's-eye views": "OpenCV, without OpenGL",
    }


def solver_facts() -> Facts:
    """Which solver the MPC expert takes, and which it could."""
    from mjdrive.config import MpcConfig
    from mjdrive.errors import SolverError
    from mjdrive.expert import mpc_solver

    try:
        solver = mpc_solver.choose(MpcConfig())
    except SolverError as error:
        solver = f"none: {error}"
    available = [name for name in mpc_solver.SOLVERS if mpc_solver.is_available(name)]
    return {"solver": solver, "available": ", ".join(available) or "none"}


def executor_facts() -> Facts:
    """What `--jobs` and `--backend` can do here."""
    from mjdrive.execution.pool import THREADS, available_cores

    cores = available_cores()
    if THREADS in os.environ:
        threads = f"{os.environ[THREADS]} threads a process, as {THREADS} says"
    elif cores == 1:
        threads = "1 thread a process"
    else:
        threads = f"cores / N threads a process: {cores} with 1, 1 with {cores} and more"
    return {
        "cores available": f"{cores} of {os.cpu_count()}",
        "--jobs auto": "1 process" if cores == 1 else f"{cores} processes",
        "--jobs N": threads,
        "--backend ray": _package("ray", extra="ray"),
        "--backend slurm": _slurm(),
    }


def town_facts() -> Facts:
    """Which towns can be driven in."""
    from mjdrive.town import library

    return {"known": ", ".join(library.town_names())}


def plugin_facts() -> Facts:
    """What other packages bring along, and what is wrong with it."""
    from mjdrive import plugins

    found = {
        f"{it.kind} {it.name}": f"broken: {it.problem}" if it.problem else it.source
        for it in plugins.listing()
    }
    return found or {"of other packages": "none"}


def _package(name: str, *, extra: str) -> str:
    if importlib.util.find_spec(name) is None:
        return f'not installed: pip install --editable ".[{extra}]" in the checkout'
    return f"{name} {importlib.metadata.version(name)}"


def _slurm() -> str:
    found = _package("submitit", extra="slurm")
    return found if shutil.which("sbatch") else f"{found}; no command sbatch here"
