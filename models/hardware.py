"""What this machine gives to networks: devices, threads, and whether bfloat16 is fast on it."""

import platform

import torch

from models.errors import HardwareError

# The first NVIDIA generation with bfloat16 in its tensor cores.
AMPERE = (8, 0)


def choose_device(name: str = "auto") -> torch.device:
    """Find the device that a name asks for.

    Args:
        name: "auto" for a CUDA device where there is one and the CPU elsewhere, or "cpu", "cuda" or "cuda:1".

    Returns:
        The device; it is there.

    Raises:
        HardwareError: If there is no such device here.
    """
    if name == "auto":
        return torch.device("cuda" if torch.cuda.is_available() else "cpu")
    known = ["cpu", *_cuda_names()]
    if name not in known and not (name == "cuda" and len(known) > 1):
        raise HardwareError(
            f"There is no device '{name}' here. Expected auto or one of: {', '.join(known)}. "
            f"For a GPU, install torch with CUDA; `mjdrive info` shows what torch sees."
        )
    return torch.device(name)


def bfloat16_is_fast(device: torch.device | str = "cpu") -> bool:
    """Whether products in bfloat16 are quicker than in float32, and not only emulated.

    Args:
        device: Where they would be computed.

    Returns:
        True on CPUs with AMX-BF16 or AVX512-BF16, and on CUDA devices of compute capability 8.0 and above.
    """
    device = torch.device(device)
    if device.type == "cuda":
        return torch.cuda.is_available() and torch.cuda.get_device_capability(device) >= AMPERE
    if device.type != "cpu" or not torch.backends.mkldnn.is_available():
        return False
    return any(_cpu_bfloat16_units().values())


def describe() -> dict[str, str]:
    """What torch finds on this machine, as pairs of a name and its value to show."""
    units = [name for name, is_there in _cpu_bfloat16_units().items() if is_there]
    facts = {
        "torch": torch.__version__,
        "threads": f"{torch.get_num_threads()}",
        "processor": f"{platform.machine()}, {torch.backends.cpu.get_cpu_capability()}",
        "bfloat16 on the processor": ", ".join(units) if bfloat16_is_fast() else "slow, not used",
    }
    for name in _cuda_names():
        properties = torch.cuda.get_device_properties(name)
        speed = "fast" if bfloat16_is_fast(name) else "slow, not used"
        memory_gb = properties.total_memory / 1e9
        facts[name] = f"{properties.name}, {memory_gb:.0f} GB, bfloat16 {speed}"
    if len(_cuda_names()) == 0:
        facts["cuda"] = "none"
    return facts | {"device used": str(choose_device())}


def _cuda_names() -> list[str]:
    count = torch.cuda.device_count() if torch.cuda.is_available() else 0
    return [f"cuda:{index}" for index in range(count)]


def _cpu_bfloat16_units() -> dict[str, bool]:
    """The instruction sets that multiply in bfloat16, and whether this CPU has them."""
    if hasattr(torch.cpu, "get_capabilities"):  # since torch 2.10
        found = torch.cpu.get_capabilities()
        return {"AMX": found.get("amx_bf16", False), "AVX512": found.get("avx512_bf16", False)}
    return {
        "AMX": torch.cpu._is_amx_tile_supported(),
        "AVX512": torch.cpu._is_avx512_bf16_supported(),
    }
