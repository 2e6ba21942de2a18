"""What the commands show while they work and when they are done."""

import signal
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

from rich.console import Console
from rich.markup import escape
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    SpinnerColumn,
    Task,
    TaskID,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.table import Table
from rich.text import Text

_MOST_BARS = 16
"""Bars that a terminal has room for [-]."""


class RateColumn(ProgressColumn):
    """How fast a task goes, in its own unit a second."""

    def render(self, task: Task) -> Text:
        """Show the rate, or nothing before there is one."""
        elapsed = task.finished_time or task.elapsed  # `elapsed` runs on after the task is done
        if not elapsed:
            return Text("")
        unit = task.fields.get("unit", "steps")
        rate = task.completed / elapsed
        return Text(f"{rate:,.{0 if rate >= 10 else 2}f} {unit}/s", style="progress.data.speed")


def progress_bars(*, visible: bool = True) -> Progress:
    """Bars with count, rate and time left, on stderr so that stdout stays clean; use it as a context.

    Args:
        visible: Whether they are shown; of several processes one should.
    """
    return Progress(
        SpinnerColumn(finished_text="[green]✓"),
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        RateColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        disable=not visible,
    )


@contextmanager
def stages(name: str, count: int) -> Iterator[Callable[[str], None]]:
    """A bar for work of a few stages, each of which takes a while.

    Args:
        name: What is worked on.
        count: Number of stages [-].

    Yields:
        To be called with the name of each stage when it begins.
    """
    with progress_bars() as bars:
        task = bars.add_task(escape(name), total=count, unit="stages")
        begun = 0

        def begin(stage: str) -> None:
            nonlocal begun
            bars.update(task, description=escape(f"{name}: {stage}"), completed=begun)
            begun += 1

        yield begin
        bars.update(task, description=escape(name), completed=count)


@contextmanager
def episode_bars(name: str, *, total: int) -> Iterator[Callable[[str, int, int], None]]:
    """A bar for a number of episodes and one for each that is driven; finished ones go when there are many.

    Args:
        name: What is collected.
        total: Number of episodes [-].

    Yields:
        To be called with the name of an episode, its steps so far and its steps in all.
    """
    with progress_bars() as bars:
        whole = bars.add_task(escape(name), total=total, unit="episodes")
        tasks: dict[str, TaskID] = {}

        def report(episode: str, done: int, expected: int) -> None:
            if episode not in tasks:
                tasks[episode] = bars.add_task(escape(episode))
            bars.update(tasks[episode], completed=done, total=expected)
            if done == expected:
                bars.advance(whole)
                if total > _MOST_BARS:
                    bars.remove_task(tasks.pop(episode))

        yield report


@contextmanager
def stage_bars() -> Iterator[Callable[[str, int], Callable[[str, int, int], None]]]:
    """A bar for each stage of long work, and below them one for each thing that is worked on until it is done.

    Yields:
        To be called with the name of a stage and the number of things in it; what comes back is to be called with the
        name of a thing, how much of it is done and how much there is.
    """
    with progress_bars() as bars:

        def begin(stage: str, count: int) -> Callable[[str, int, int], None]:
            whole = bars.add_task(escape(stage), total=count, unit="items", visible=count > 0)
            tasks: dict[str, TaskID] = {}

            def report(thing: str, done: int, expected: int) -> None:
                if done == expected:
                    bars.advance(whole)
                    if thing in tasks:
                        bars.remove_task(tasks.pop(thing))
                    return
                if thing not in tasks:
                    tasks[thing] = bars.add_task(escape(f"  {thing}"))
                bars.update(tasks[thing], completed=done, total=expected)

            return report

        yield begin


@contextmanager
def ended_by_sigterm() -> Iterator[None]:
    """Let SIGTERM end the work inside as Ctrl-C does: what is unfinished is cleaned up."""

    def leave(number: int, frame: object) -> None:
        sys.exit(128 + number)

    before = signal.signal(signal.SIGTERM, leave)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def closing_table(title: str, rows: Mapping[str, object], *, next_command: str) -> None:
    """Say what a command made and what to do with it.

    Args:
        title: What the command did.
        rows: Names and values of what was made.
        next_command: The command that the user is likely to want next.
    """
    console = Console()
    # Names and paths are shown as they are: no markup of rich is read in them.
    table = Table(title=Text(title), title_justify="left", show_header=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    for name, value in rows.items():
        table.add_row(name, Text(str(value)))
    console.print(table)
    console.print("Next: ", end="")
    console.print(next_command, style="bold cyan", markup=False, highlight=False, soft_wrap=True)


def sections_table(sections: Mapping[str, Mapping[str, str]]) -> None:
    """Show facts by subject.

    Args:
        sections: Names and values of each subject.
    """
    table = Table(show_header=False)
    table.add_column(style="bold cyan", no_wrap=True)
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    for subject, facts in sections.items():
        for index, (name, value) in enumerate(facts.items()):
            table.add_row("" if index else subject, name, Text(value))
        table.add_section()
    Console().print(table)
