from types import SimpleNamespace

import pytest
import torch

from models import hardware
from models.errors import HardwareError


@pytest.fixture
def one_gpu(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """Torch as it answers on a machine with one GPU, whose generation a test may change."""
    card = SimpleNamespace(name="Card", total_memory=24e9, capability=(8, 6))
    monkeypatch.setattr(torch.cuda, "is_available", lambda: True)
    monkeypatch.setattr(torch.cuda, "device_count", lambda: 1)
    monkeypatch.setattr(torch.cuda, "get_device_properties", lambda device: card)
    monkeypatch.setattr(torch.cuda, "get_device_capability", lambda device: card.capability)
    return card


@pytest.fixture
def no_gpu(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)


def have(monkeypatch: pytest.MonkeyPatch, **units: bool) -> None:
    monkeypatch.setattr(torch.cpu, "get_capabilities", lambda: units, raising=False)
    monkeypatch.setattr(torch.backends.mkldnn, "is_available", lambda: True)


def test_auto_takes_the_gpu_where_there_is_one(one_gpu: SimpleNamespace) -> None:
    assert hardware.choose_device("auto") == torch.device("cuda")
    assert hardware.choose_device("cuda:0") == torch.device("cuda:0")
    assert hardware.choose_device("cpu") == torch.device("cpu")


@pytest.mark.usefixtures("no_gpu")
@pytest.mark.parametrize("name", ["cuda", "cuda:0", "gpu"])
def test_a_device_that_is_not_there_is_refused_in_one_line(name: str) -> None:
    assert hardware.choose_device("auto") == torch.device("cpu")
    with pytest.raises(HardwareError, match=f"no device '{name}' here. Expected auto or one of"):
        hardware.choose_device(name)


def test_a_second_gpu_that_is_not_there_is_refused(one_gpu: SimpleNamespace) -> None:
    with pytest.raises(HardwareError, match="Expected auto or one of: cpu, cuda:0"):
        hardware.choose_device("cuda:1")


@pytest.mark.parametrize(("capability", "fast"), [((7, 5), False), ((8, 0), True), ((9, 0), True)])
def test_bfloat16_is_fast_from_ampere_on(
    one_gpu: SimpleNamespace, capability: tuple[int, int], fast: bool
) -> None:
    one_gpu.capability = capability
    assert hardware.bfloat16_is_fast("cuda") is fast
    assert ("bfloat16 fast" in hardware.describe()["cuda:0"]) is fast


@pytest.mark.parametrize(
    ("units", "fast"),
    [
        ({}, False),
        ({"avx512_f": True}, False),
        ({"avx512_bf16": True}, True),
        ({"amx_bf16": True, "avx512_bf16": False}, True),
    ],
)
def test_bfloat16_is_fast_with_the_units_for_it(
    monkeypatch: pytest.MonkeyPatch, units: dict[str, bool], fast: bool
) -> None:
    have(monkeypatch, **units)
    assert hardware.bfloat16_is_fast("cpu") is fast


def test_bfloat16_is_slow_where_torch_has_no_kernels_for_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    have(monkeypatch, amx_bf16=True)
    monkeypatch.setattr(torch.backends.mkldnn, "is_available", lambda: False)
    assert not hardware.bfloat16_is_fast("cpu")


@pytest.mark.usefixtures("no_gpu")
def test_the_description_names_what_would_be_used() -> None:
    facts = hardware.describe()
    assert facts["torch"] == torch.__version__
    assert facts["device used"] == "cpu"
    assert facts["cuda"] == "none"
    assert facts["threads"] == str(torch.get_num_threads())
