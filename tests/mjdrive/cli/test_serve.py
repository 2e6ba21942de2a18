"""`mjdrive serve` says what is wrong before it loads anything, and lets nobody in who was not asked."""

import socket
from collections.abc import Iterator
from typing import Any

import pytest
import uvicorn
from click.testing import CliRunner, Result

from mjdrive.cli.main import main
from mjdrive.web import server, session
from mjdrive.web.guard import LOOPBACK, Access


class Served:
    """What would have been served."""

    access: Access
    options: dict[str, Any]


@pytest.fixture
def served(monkeypatch: pytest.MonkeyPatch) -> Served:
    """Serve nothing, but note what would be."""
    found = Served()

    def make_app(session: object, *, shelf: object, access: Access) -> None:
        found.access = access

    monkeypatch.setattr(session, "Session", lambda *args, **kwargs: None)
    monkeypatch.setattr(server, "make_app", make_app)
    monkeypatch.setattr(uvicorn, "run", lambda app, **options: setattr(found, "options", options))
    return found


@pytest.fixture
def busy() -> Iterator[int]:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        yield other.getsockname()[1]


def serve(*words: str) -> Result:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        free = str(probe.getsockname()[1])
    return CliRunner().invoke(
        main, ["serve", *([] if "--port" in words else ["--port", free]), *words]
    )


def test_it_listens_to_this_machine_alone_unless_told_otherwise(served: Served) -> None:
    done = serve()
    assert done.exit_code == 0
    assert served.options["host"] == "127.0.0.1"
    assert served.access == Access(hosts=LOOPBACK)
    assert f"Open http://127.0.0.1:{served.options['port']}/ in a browser" in done.stderr
    assert "Other machines" not in done.stderr


def test_messages_are_bounded_and_not_deflated_by_the_socket(served: Served) -> None:
    serve()
    assert served.options["ws_max_size"] == 2**16
    assert served.options["ws_per_message_deflate"] is False


def test_a_port_in_use_is_named(served: Served, busy: int) -> None:
    done = serve("--port", str(busy))
    assert done.exit_code == 2
    assert f"Cannot listen at 127.0.0.1:{busy}: Address already in use" in done.stderr
    assert "give another with --port" in done.stderr


def test_another_host_needs_a_token(served: Served) -> None:
    done = serve("--host", "0.0.0.0")
    assert done.exit_code == 2
    assert "lets other machines in; expected --token" in done.stderr
    assert not hasattr(served, "access")


def test_another_host_with_a_token_is_warned_of_and_called_by_the_names_of_this_machine(
    served: Served,
) -> None:
    done = serve("--host", "0.0.0.0", "--token", "auto")
    assert done.exit_code == 0
    assert "Other machines can reach this one" in done.stderr
    assert len(served.access.token) >= 20
    assert f"?token={served.access.token}" in done.stderr
    name = socket.gethostname().lower()
    assert name in served.access.hosts
    assert "0.0.0.0" not in served.access.hosts


@pytest.mark.parametrize("option", ["--allow-origin", "--frame-ancestors"])
@pytest.mark.parametrize(
    "text", ["example.com", "https://a/b", "ftp://a", "https://a; script-src *", "https://"]
)
def test_what_is_no_origin_is_refused(served: Served, option: str, text: str) -> None:
    done = serve(option, text)
    assert done.exit_code == 2
    assert f"{option} {text} is no origin" in " ".join(done.stderr.split())


def test_origins_and_frames_are_let_in(served: Served) -> None:
    serve("--allow-origin", "https://tunnel.example", "--frame-ancestors", "http://localhost:8888")
    assert served.access.origins == {"https://tunnel.example"}
    assert served.access.headers["content-security-policy"].endswith(
        "frame-ancestors http://localhost:8888"
    )


@pytest.mark.parametrize(
    ("option", "name", "known"), [("--town", "twon01", "town01"), ("--policy", "pidd", "pid")]
)
def test_an_unknown_town_or_policy_is_refused_before_a_town_is_built(
    option: str, name: str, known: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(session, "Simulation", None)
    done = serve(option, name)
    assert done.exit_code == 2
    assert f"Did you mean '{known}'?" in " ".join(done.stderr.split())
