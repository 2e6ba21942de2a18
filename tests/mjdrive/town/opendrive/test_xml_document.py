import re
import sys
from pathlib import Path

import pytest

from mjdrive.errors import TownFormatError
from mjdrive.town import opendrive
from mjdrive.town.opendrive import xml_document

BOMB = b"""<?xml version="1.0"?><!DOCTYPE OpenDRIVE [
<!ENTITY a "ha ha ha ha ha ha ha ha ha ha"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">
<!ENTITY c "&b;&b;&b;&b;&b;&b;&b;&b;&b;&b;"><!ENTITY d "&c;&c;&c;&c;&c;&c;&c;&c;&c;&c;">
<!ENTITY e "&d;&d;&d;&d;&d;&d;&d;&d;&d;&d;"><!ENTITY f "&e;&e;&e;&e;&e;&e;&e;&e;&e;&e;">]>
<OpenDRIVE>%s</OpenDRIVE>"""


@pytest.mark.parametrize("place", [b"&f;", b'<header name="&f;" revMajor="1" revMinor="4"/>'])
def test_entities_never_grow(place: bytes) -> None:
    with pytest.raises(TownFormatError, match=r"'bomb' (has a DOCTYPE|is no XML that)"):
        opendrive.parse(BOMB % place, source="bomb")


def test_files_of_the_machine_are_not_read(map_bytes: bytes, tmp_path: Path) -> None:
    secret = tmp_path / "secret"
    secret.write_text("stolen")
    doctype = (
        f'<!DOCTYPE OpenDRIVE [<!ENTITY e SYSTEM "{secret.as_uri()}">]><OpenDRIVE>&e;'.encode()
    )
    with pytest.raises(TownFormatError, match="has a DOCTYPE") as caught:
        opendrive.parse(map_bytes.replace(b"<OpenDRIVE>", doctype, 1), source="entity")
    assert "stolen" not in str(caught.value)


@pytest.mark.parametrize("encoding", ["utf-16", "iso-8859-1"])
def test_other_encodings_are_read_like_utf_8(map_bytes: bytes, encoding: str) -> None:
    text = re.sub(r"encoding='[^']*'", f"encoding='{encoding}'", map_bytes.decode())
    assert opendrive.parse(text.encode(encoding), source="ladder") == opendrive.parse(
        map_bytes, source="ladder"
    )


def test_a_doctype_hides_in_no_encoding() -> None:
    text = "<?xml version='1.0' encoding='utf-16'?><!DOCTYPE OpenDRIVE []><OpenDRIVE/>"
    with pytest.raises(TownFormatError, match="DOCTYPE"):
        opendrive.parse(text.encode("utf-16"), source="hidden")


@pytest.mark.parametrize("depth", [xml_document.LARGEST_DEPTH, 100, 10_000])
def test_deep_nesting_is_refused(depth: int) -> None:
    document = b"<OpenDRIVE>" + b"<a>" * depth + b"</a>" * depth + b"</OpenDRIVE>"
    with pytest.raises(TownFormatError, match=r"deeper than 32|[Dd]epth"):
        opendrive.parse(document, source="deep")


def test_a_file_over_the_limit_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "huge.xodr"
    with path.open("wb") as file:
        file.truncate(1_000_000_000)
    with pytest.raises(TownFormatError, match=r"huge\.xodr' has 1000 MB; expected at most 100 MB"):
        opendrive.read(path)


def test_bytes_over_the_limit_are_not_parsed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(xml_document, "LARGEST_FILE", 10)
    with pytest.raises(TownFormatError, match="expected at most"):
        opendrive.parse(b"<OpenDRIVE/>", source="large")


@pytest.mark.skipif(sys.platform == "win32", reason="there is no /dev/zero")
def test_what_is_no_file_is_refused(tmp_path: Path) -> None:
    for path in (tmp_path, Path("/dev/zero")):
        with pytest.raises(TownFormatError, match="is no file"):
            opendrive.read(path)


@pytest.mark.parametrize("version", xml_document.VERSIONS)
def test_versions_are_told(map_bytes: bytes, version: str) -> None:
    minor = version.split(".")[1].encode()
    data = re.sub(rb'revMinor="\d"', b'revMinor="%s"' % minor, map_bytes)
    assert opendrive.parse_with_report(data, source="ladder")[1].version == version


def test_a_namespace_changes_nothing(map_bytes: bytes) -> None:
    named = map_bytes.replace(b"<OpenDRIVE>", b'<OpenDRIVE xmlns="http://any.org/schema">', 1)
    assert opendrive.parse(named, source="ladder") == opendrive.parse(map_bytes, source="ladder")
