"""Whether a Ray cluster answers at an address. Ray itself asks a dead address for two minutes."""

import socket
import subprocess
import sys

from mjdrive.errors import ClusterError

CONNECT_WITHIN = 3.0
"""Time for a machine to answer [s]."""

JOIN_WITHIN = 30.0
"""Time for a cluster that answers to take us in; without load it takes about 3 [s]."""

_JOIN = (
    "import sys, ray; ray.init(address=sys.argv[1], logging_level='CRITICAL', log_to_driver=False); "
    "print(ray.cluster_resources().get('CPU', 0))"
)


def require_cluster(address: str) -> None:
    """Refuse an address where no cluster answers within seconds.

    Args:
        address: HOST:PORT, or "auto" for the cluster that this machine is part of.

    Raises:
        ClusterError: If it is no address, nobody answers, or who answers is no Ray cluster that takes us in and has a
            core for us.
    """
    if address != "auto":
        _require_listener(address)
    try:
        # In a process of its own, because Ray cannot be told how long to try.
        joined = subprocess.run(
            [sys.executable, "-c", _JOIN, address],
            check=True,
            capture_output=True,
            text=True,
            timeout=JOIN_WITHIN,
        )
    except subprocess.TimeoutExpired as error:
        raise ClusterError(
            f"What listens at '{address}' did not answer as a Ray cluster within {JOIN_WITHIN:.0f} s. {_EXPECTED}"
        ) from error
    except subprocess.CalledProcessError as error:
        lines = error.stderr.strip().splitlines() or ["no reason given"]
        raise ClusterError(
            f"Cannot join a Ray cluster at '{address}': {lines[-1]} {_EXPECTED}"
        ) from error
    if float(joined.stdout.split()[-1]) < 1:
        raise ClusterError(
            f"The Ray cluster at '{address}' has no core. Expected machines that can work: `ray start "
            f"--address=HOST:PORT --num-cpus=N` on each of them joins it."
        )


_EXPECTED = (
    "Expected the head of a running cluster that this machine is part of: `ray start --head` starts one, "
    "`ray start --address=HOST:PORT` joins it."
)


def _require_listener(address: str) -> None:
    host, _, port = address.rpartition(":")
    no_address = ClusterError(
        f"--address '{address}' is no HOST:PORT such as 10.0.0.7:6379. {_EXPECTED}"
    )
    # isdigit alone lets through digits that int does not read.
    is_number = port.isascii() and port.isdigit()
    if not host or not is_number or int(port) > 65535 or "/" in host:
        raise no_address
    try:
        socket.create_connection((host, int(port)), timeout=CONNECT_WITHIN).close()
    except UnicodeError as error:  # a name with an empty part, or one that is too long
        raise no_address from error
    except OSError as error:
        raise ClusterError(
            f"Nobody answers at '{address}' within {CONNECT_WITHIN:.0f} s ({error.strerror or error}). {_EXPECTED}"
        ) from error
