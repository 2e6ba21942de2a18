"""Open an OpenDRIVE document that may come from anywhere."""

from pathlib import Path

from lxml import etree

from mjdrive.errors import TownFormatError
from mjdrive.town.opendrive.xml_fields import Element

LARGEST_FILE = 100_000_000
"""Largest map that is read [byte]."""

LARGEST_DEPTH = 32
"""Deepest nesting of elements; OpenDRIVE itself needs about ten."""

VERSIONS = tuple(f"1.{minor}" for minor in range(4, 9))
"""Versions of OpenDRIVE that are read."""


def read_bytes(path: Path) -> bytes:
    """Read a map file, unless it is too large.

    Args:
        path: OpenDRIVE file.

    Returns:
        Its bytes.

    Raises:
        TownFormatError: If it is missing, no file, or larger than `LARGEST_FILE`.
    """
    try:
        if path.exists() and not path.is_file():
            raise TownFormatError(f"'{path}' is no file. Expected an OpenDRIVE file (.xodr).")
        _require_size(path.stat().st_size, str(path))
        with path.open("rb") as file:
            return file.read(LARGEST_FILE + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise TownFormatError(
            f"Cannot read the map '{path}': {reason}. Expected an OpenDRIVE file (.xodr)."
        ) from error


def open_document(data: bytes, *, source: str) -> tuple[Element, str]:
    """Parse the XML of a map and check that it is OpenDRIVE; nothing is expanded and nothing is fetched.

    Args:
        data: The XML document.
        source: How errors call it.

    Returns:
        The root element, its names without a namespace, and the version, for example "1.4".

    Raises:
        TownFormatError: If it is too large, no XML, no OpenDRIVE or of another version.
    """
    _require_size(len(data), source)
    parser = etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False, remove_pis=True
    )
    try:
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        raise TownFormatError(
            f"'{source}' is no XML that mjdrive reads: {error}. Expected an OpenDRIVE map."
        ) from error
    if root.getroottree().docinfo.internalDTD is not None:
        raise TownFormatError(
            f"'{source}' has a DOCTYPE, which could hide entities; maps have none. Delete it."
        )
    if root.xpath(f"boolean({'/*' * (LARGEST_DEPTH + 1)})"):
        raise TownFormatError(
            f"'{source}' nests elements deeper than {LARGEST_DEPTH}; OpenDRIVE needs about ten."
        )
    _drop_namespace(root)
    if root.tag != "OpenDRIVE":
        raise TownFormatError(
            f"{source}:{root.sourceline}: starts with <{root.tag}>; expected <OpenDRIVE>."
        )
    return root, _version(root, source)


def _require_size(size: int, source: str) -> None:
    if size > LARGEST_FILE:
        raise TownFormatError(
            f"The map '{source}' has {size / 1e6:.0f} MB; expected at most {LARGEST_FILE / 1e6:.0f} MB. "
            "Cut out the part that you want to drive in."
        )


def _drop_namespace(root: Element) -> None:
    """Take the namespace of the root, which newer maps have, off all names; extensions in others keep theirs."""
    namespace = etree.QName(root).namespace
    if namespace is not None:
        for element in root.iter(f"{{{namespace}}}*"):
            element.tag = etree.QName(element).localname


def _version(root: Element, source: str) -> str:
    header = next(root.iterchildren("header"), None)
    wanted = f"expected OpenDRIVE {VERSIONS[0]} to {VERSIONS[-1]}"
    if header is None:
        raise TownFormatError(
            f"{source}:{root.sourceline}: <OpenDRIVE> has no <header>, which says the version; {wanted}."
        )
    version = f"{header.get('revMajor')}.{header.get('revMinor')}"
    if version not in VERSIONS:
        raise TownFormatError(
            f"{source}:{header.sourceline}: <header> has revMajor='{header.get('revMajor')}' "
            f"revMinor='{header.get('revMinor')}'; {wanted}. Export the map in one of these."
        )
    return version
