from pathlib import Path

import pytest

from mjdrive.errors import UnknownNameError
from mjdrive.zoo import entries


@pytest.fixture
def zoo(tmp_path: Path) -> Path:
    for name in ("da-ibc", "bc-beta", ".unfinished"):
        (tmp_path / name).mkdir()
        (tmp_path / name / entries.CARD).write_text("{}")
    (tmp_path / "notes").mkdir()  # no card, no entry
    return tmp_path


def test_entries_are_the_folders_with_a_card_in_alphabetical_order(zoo: Path) -> None:
    assert entries.names(zoo) == ("bc-beta", "da-ibc")
    assert entries.full_names(zoo) == ("zoo:bc-beta", "zoo:da-ibc")
    assert entries.find("zoo:da-ibc", zoo) == zoo / "da-ibc"


@pytest.mark.parametrize("name", ["zoo:da-icb", "zoo:", "zoo:notes", "zoo:.unfinished"])
def test_other_names_are_refused_with_those_there_are(zoo: Path, name: str) -> None:
    message = "Unknown shipped policy '.*Known: zoo:bc-beta, zoo:da-ibc"
    with pytest.raises(UnknownNameError, match=message):
        entries.find(name, zoo)


def test_the_nearest_name_is_suggested(zoo: Path) -> None:
    with pytest.raises(UnknownNameError, match="Did you mean 'zoo:da-ibc'"):
        entries.find("zoo:da-icb", zoo)


def test_no_path_leads_out_of_the_zoo(zoo: Path) -> None:
    with pytest.raises(UnknownNameError):
        entries.find("zoo:../da-ibc", zoo / "da-ibc")
