"""Several processes that train one network together, as `torchrun` starts them.

Every process holds all data and weights. For each minibatch all draw the same order and the same negatives, each takes
its part, and the gradients are summed: what comes out is the minibatch of one process, but for rounding.
"""

import datetime
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Literal

import torch
from torch import Tensor, distributed
from torch.distributed.rendezvous import rendezvous

from models.errors import HardwareError

VARIABLES = ("RANK", "LOCAL_RANK", "WORLD_SIZE", "MASTER_ADDR", "MASTER_PORT")
"""What torchrun tells each process in its environment."""

LARGEST_PORT = 65_535

JOINING = datetime.timedelta(minutes=1)
"""How long a process waits for the others to come."""

PATIENCE = datetime.timedelta(minutes=10)
"""How long it waits for them later on; views are drawn, checkpoints written meanwhile."""


@dataclass(frozen=True, slots=True)
class Team:
    """Which of several processes this is.

    Attributes:
        rank: Number of the process among all, from 0.
        size: Number of processes.
        local_rank: Number of the process among those of its machine, from 0.
    """

    rank: int = 0
    size: int = 1
    local_rank: int = 0

    @property
    def leads(self) -> bool:
        """Whether this process writes files and shows progress."""
        return self.rank == 0

    def part(self, num: int) -> slice:
        """The rows of this process among `num`; sizes differ by one at most and may be zero."""
        return slice(self.rank * num // self.size, (self.rank + 1) * num // self.size)

    def device(self, chosen: torch.device) -> torch.device:
        """Where this process computes: on a GPU of its own where GPUs were chosen.

        Raises:
            HardwareError: If one GPU is chosen for all, or the machine has fewer GPUs than processes.
        """
        if self.size == 1 or chosen.type != "cuda":
            return chosen
        if chosen.index is not None:
            raise HardwareError(
                f"Device '{chosen}' is one GPU, and {self.size} processes take one each. Give --device cuda; which GPUs "
                f"there are to take is for CUDA_VISIBLE_DEVICES to say."
            )
        if self.local_rank >= torch.cuda.device_count():
            raise HardwareError(
                f"Process {self.local_rank + 1} of this machine has no GPU: there are {torch.cuda.device_count()}. "
                f"Start as many processes as GPUs (--nproc-per-node), or train with --device cpu."
            )
        return torch.device("cuda", self.local_rank)


ALONE = Team()


def team_of(environment: Mapping[str, str]) -> Team:
    """Read what torchrun tells a process.

    Args:
        environment: Variables of the process, `os.environ`.

    Returns:
        The team; `ALONE` where torchrun did not start the process.

    Raises:
        HardwareError: If some of the variables are missing, or are no numbers that fit together.
    """
    if not any(name in environment for name in VARIABLES[:3]):
        return ALONE
    missing = [name for name in VARIABLES if name not in environment]
    if missing:
        raise HardwareError(
            f"The environment is half of torchrun's: {', '.join(missing)} missing. Start with "
            f"`torchrun --nproc-per-node 2 -m mjdrive train ...`, or unset {', '.join(VARIABLES[:3])}."
        )
    try:
        rank, local_rank, size = (int(environment[name]) for name in VARIABLES[:3])
    except ValueError as error:
        raise HardwareError(
            f"{', '.join(VARIABLES[:3])} are to be whole numbers: {error}."
        ) from error
    if not (0 <= local_rank <= rank < size):
        raise HardwareError(
            f"RANK is {rank}, LOCAL_RANK {local_rank} and WORLD_SIZE {size}; expected "
            f"0 <= LOCAL_RANK <= RANK < WORLD_SIZE. Leave them to torchrun."
        )
    port = environment["MASTER_PORT"]
    if not (port.isdecimal() and 0 < int(port) <= LARGEST_PORT):
        raise HardwareError(
            f"MASTER_PORT is '{port}'; expected a whole number from 1 to {LARGEST_PORT}. Leave it to torchrun."
        )
    return Team(rank, size, local_rank)


def backend(device: torch.device) -> Literal["nccl", "gloo"]:
    """What carries the messages of processes that compute on such a device."""
    return "nccl" if device.type == "cuda" else "gloo"


@contextmanager
def joined(team: Team, device: torch.device) -> Iterator[None]:
    """Within it, the processes of a team can talk to each other.

    Args:
        team: From `team_of`.
        device: Where this process computes.

    Raises:
        HardwareError: If the others do not come within a minute.
    """
    if team.size == 1:
        yield
        return
    if device.type == "cuda":
        torch.cuda.set_device(device)
    try:
        meeting = rendezvous("env://", team.rank, team.size, timeout=JOINING)
        store, _, _ = next(meeting)
        distributed.init_process_group(
            backend(device),
            store=store,
            rank=team.rank,
            world_size=team.size,
            timeout=PATIENCE,
        )
    except (RuntimeError, OSError) as error:
        raise HardwareError(
            f"Process {team.rank} of {team.size} cannot reach the others: {_first_line(error)} Check that all of them "
            f"were started, and the address given to torchrun."
        ) from error
    try:
        yield
    finally:
        distributed.destroy_process_group()


def sum_over(team: Team, tensors: Sequence[Tensor]) -> None:
    """Replace tensors by their sums over all processes, in one message.

    Args:
        team: From `team_of`.
        tensors: Float tensors on one device, of the same shapes everywhere.

    Raises:
        HardwareError: If another process is lost.
    """
    if team.size == 1:
        return
    message = torch.cat([tensor.flatten() for tensor in tensors])
    with told_of_losses(team):
        distributed.all_reduce(message)
    for tensor, total in zip(
        tensors, message.split([tensor.numel() for tensor in tensors]), strict=True
    ):
        tensor.copy_(total.view_as(tensor))


@contextmanager
def told_of_losses(team: Team) -> Iterator[None]:
    """Say what it means when a message to the others, sent within it, fails.

    Raises:
        HardwareError: If it does.
    """
    try:
        yield
    except RuntimeError as error:
        raise HardwareError(
            f"Process {team.rank} of {team.size} has lost another: {_first_line(error)} What that one said stands above "
            f"or in its log. Start all of them again with --resume; that goes on from the last complete epoch."
        ) from error


def _first_line(error: Exception) -> str:
    """What went wrong, without the stack of torch."""
    return str(error).strip().partition("\n")[0].removesuffix(".") + "."
