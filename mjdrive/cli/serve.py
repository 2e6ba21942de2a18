"""`mjdrive serve`: a live page to watch policies and to drive."""

from pathlib import Path
from typing import TYPE_CHECKING

import rich_click as click

from mjdrive.errors import ConfigError, MissingPackageError

if TYPE_CHECKING:
    from mjdrive.web.guard import Access

LOOPBACK_HOST = "127.0.0.1"
ALL_HOSTS = ("0.0.0.0", "::")
"""Every address of this machine, so that it is called by names of its own."""

LONGEST_MESSAGE = 2**16
"""Of a page [bytes]."""

GRACE = 5
"""Pages that have not closed so long after Ctrl-C are left [s]."""


@click.command()
@click.option(
    "--town",
    "town_name",
    default="town01",
    show_default=True,
    metavar="NAME",
    help="Town to begin with.",
)
@click.option(
    "--policy",
    "policy_name",
    default="zoo:da-ibc",
    show_default=True,
    metavar="RUN|pid|mpc|zoo:NAME",
    help="Who drives at first: a run in --runs, an expert, or a policy that comes with mjdrive.",
)
@click.option(
    "--seed",
    default=0,
    show_default=True,
    type=click.IntRange(0, 2**32 - 1),
    help="Where and how the drive begins.",
)
@click.option(
    "--host",
    default=LOOPBACK_HOST,
    show_default=True,
    help="Address to listen at; others than this machine need --token.",
)
@click.option(
    "--port",
    default=8123,
    show_default=True,
    type=click.IntRange(1, 65535),
    help="Port to listen at.",
)
@click.option(
    "--token", default=None, metavar="TEXT|auto", help="What others must know; auto makes one up."
)
@click.option(
    "--allow-origin",
    "origins",
    multiple=True,
    metavar="URL",
    help="Origin of a tunnel or proxy before this server, as https://host. May be given again.",
)
@click.option(
    "--frame-ancestors",
    "frames",
    multiple=True,
    metavar="URL",
    help="Origin of a page, such as a notebook's, that may show this one in a frame. May be given again.",
)
@click.option(
    "--runs",
    default=Path("runs"),
    show_default=True,
    type=click.Path(path_type=Path),
    help="Folder of training runs.",
)
@click.option(
    "--drives",
    default=Path("drives"),
    show_default=True,
    type=click.Path(path_type=Path),
    help="Folder of drives.",
)
@click.option(
    "--data",
    default=Path("data"),
    show_default=True,
    type=click.Path(path_type=Path),
    help="Folder of data sets; what you drive goes to human-<town> in it.",
)
def serve(
    *,
    town_name: str,
    policy_name: str,
    seed: int,
    host: str,
    port: int,
    token: str | None,
    origins: tuple[str, ...],
    frames: tuple[str, ...],
    runs: Path,
    drives: Path,
    data: Path,
) -> None:
    """Open a page to watch a policy drive, to look into it, and to drive by hand."""
    try:
        import uvicorn

        from mjdrive.web.server import make_app
    except ImportError as error:
        raise MissingPackageError(
            error.name or "uvicorn", wanted_for="`mjdrive serve`", extra="web"
        ) from error
    from mjdrive.web.browsing import Shelf
    from mjdrive.web.guard import LOOPBACK
    from mjdrive.web.session import Choice, Session

    access = _access(host, token, origins, frames)
    _require_free(host, port)
    session = Session(
        Choice(town_name, policy_name, seed),
        runs=runs,
        data=data,
        on_progress=lambda line: click.echo(f"{line} ...", err=True),
    )
    app = make_app(session, shelf=Shelf(runs, drives, data), access=access)
    if host not in LOOPBACK:
        click.echo(
            "Other machines can reach this one, and whoever has the token drives. Traffic is not encrypted; an SSH tunnel is.",
            err=True,
        )
    click.echo(f"Open {_address(host, port, access)} in a browser; Ctrl-C ends it.", err=True)
    uvicorn.run(
        app,
        host=host,
        port=port,
        log_level="warning",
        ws_max_size=LONGEST_MESSAGE,
        timeout_graceful_shutdown=GRACE,
        ws_per_message_deflate=False,
    )


def _address(host: str, port: int, access: "Access") -> str:
    """What to open; a token is in it once, then in a cookie."""
    import socket

    name = socket.gethostname() if host in ALL_HOSTS else f"[{host}]" if ":" in host else host
    return f"http://{name}:{port}/" + (f"?token={access.token}" if access.token else "")


def _access(
    host: str, token: str | None, origins: tuple[str, ...], frames: tuple[str, ...]
) -> "Access":
    """Decide who may talk to the server.

    Raises:
        ConfigError: If other machines could without a token, or an origin is none.
    """
    import secrets

    from mjdrive.web.guard import LOOPBACK, Access

    if host not in LOOPBACK and not token:
        raise ConfigError(
            f"--host {host} lets other machines in; expected --token with it. Give --token auto, or reach this machine "
            f"through an SSH tunnel: ssh -L 8123:127.0.0.1:8123."
        )
    for option, given in (("--allow-origin", origins), ("--frame-ancestors", frames)):
        bad = [it for it in given if not _is_origin(it)]
        if bad:
            raise ConfigError(
                f"{option} {bad[0]} is no origin; expected one as https://host or http://host:port."
            )
    if token == "auto":
        token = secrets.token_urlsafe(16)
    return Access(
        hosts=LOOPBACK | _names(host),
        origins=frozenset(origins),
        token=token or "",
        frames=frozenset(frames),
    )


def _is_origin(text: str) -> bool:
    from urllib.parse import urlsplit

    parts = urlsplit(text)
    is_bare = text == f"{parts.scheme}://{parts.netloc}" and not set(text) & set(" ;,'\"*")
    return is_bare and parts.scheme in ("http", "https") and bool(parts.hostname)


def _names(host: str) -> frozenset[str]:
    """What the server is called by, in lower case."""
    import socket

    if host not in ALL_HOSTS:
        return frozenset({host.lower()})
    own = socket.gethostname()
    try:
        name, others, addresses = socket.gethostbyname_ex(own)
    except OSError:  # its name has no address: then it is called by --allow-origin or by that name
        name, others, addresses = own, [], []
    return frozenset(it.lower() for it in (own, name, *others, *addresses))


def _require_free(host: str, port: int) -> None:
    """Refuse a port in use before anything is loaded.

    Raises:
        ConfigError: If nobody can listen there.
    """
    import socket

    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.socket(family) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((host, port))
        except OSError as error:
            raise ConfigError(
                f"Cannot listen at {host}:{port}: {error.strerror}. Expected a free port; give another with --port."
            ) from error
