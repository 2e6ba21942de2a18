"""OpenDRIVE maps: read, written, and where their lanes run."""

from mjdrive.town.opendrive.moving import moved, near_origin
from mjdrive.town.opendrive.reader import parse, parse_with_report, read, read_with_report
from mjdrive.town.opendrive.writer import write
from mjdrive.town.opendrive.xml_document import read_bytes

__all__ = [
    "moved",
    "near_origin",
    "parse",
    "parse_with_report",
    "read",
    "read_bytes",
    "read_with_report",
    "write",
]
