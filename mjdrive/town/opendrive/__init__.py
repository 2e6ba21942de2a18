"""OpenDRIVE maps: read, written, and where their lanes run."""

from mjdrive.town.opendrive.reader import parse, parse_with_report, read, read_with_report
from mjdrive.town.opendrive.writer import write

__all__ = ["parse", "parse_with_report", "read", "read_with_report", "write"]
