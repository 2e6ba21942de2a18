"""Read an ASAM OpenDRIVE map (.xodr), version 1.4 to 1.8, into a `RoadMap`."""

from pathlib import Path

from mjdrive.town.opendrive import xml_document
from mjdrive.town.opendrive.flattening import HeightGauge
from mjdrive.town.opendrive.junction_reader import read_junction, with_ways_back
from mjdrive.town.opendrive.read_report import ReadReport, make_report
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.opendrive.road_reader import read_road
from mjdrive.town.opendrive.signal_reader import read_controller
from mjdrive.town.opendrive.unity import require_whole, unique_by_id
from mjdrive.town.opendrive.xml_fields import XmlFields


def read(path: Path, *, flatten: bool = False) -> RoadMap:
    """Read a map from a file.

    Args:
        path: OpenDRIVE file.
        flatten: Whether to read a map with slopes as its plan.

    Returns:
        The road network that it describes.

    Raises:
        TownFormatError: If the file is missing or too large, is no OpenDRIVE, or uses what mjdrive cannot drive on.
    """
    return read_with_report(path, flatten=flatten)[0]


def parse(data: bytes, *, source: str, flatten: bool = False) -> RoadMap:
    """Read a map from the bytes of an OpenDRIVE file.

    Args:
        data: The XML document.
        source: How errors call it.
        flatten: Whether to read a map with slopes as its plan.

    Returns:
        The road network that it describes.

    Raises:
        TownFormatError: If it is no OpenDRIVE, or uses what mjdrive cannot drive on.
    """
    return parse_with_report(data, source=source, flatten=flatten)[0]


def read_with_report(path: Path, *, flatten: bool = False) -> tuple[RoadMap, ReadReport]:
    """Read a map from a file, and tell what was read and what was not.

    Args:
        path: OpenDRIVE file.
        flatten: Whether to read a map with slopes as its plan.

    Returns:
        The road network that it describes, and the report.

    Raises:
        TownFormatError: If the file is missing or too large, is no OpenDRIVE, or uses what mjdrive cannot drive on.
    """
    return parse_with_report(xml_document.read_bytes(path), source=str(path), flatten=flatten)


def parse_with_report(
    data: bytes, *, source: str, flatten: bool = False
) -> tuple[RoadMap, ReadReport]:
    """Read a map from the bytes of an OpenDRIVE file, and tell what was read and what was not.

    Args:
        data: The XML document.
        source: How errors call it.
        flatten: Whether to read a map with slopes as its plan.

    Returns:
        The road network that it describes, and the report.

    Raises:
        TownFormatError: If it is no OpenDRIVE, or uses what mjdrive cannot drive on.
    """
    root, version = xml_document.open_document(data, source=source)
    fields = XmlFields(source)
    gauge = HeightGauge(fields, flatten=flatten)
    header = fields.some(root, "header")[0]
    # What else the header says (date, vendor, bounds) has no effect on driving.
    fields.asked["header"].update(header.attrib)
    roads = {
        id: read_road(fields, element, gauge)
        for id, element in unique_by_id(fields, fields.some(root, "road"))
    }
    junctions = {
        id: read_junction(fields, element)
        for id, element in unique_by_id(fields, fields.each(root, "junction"))
    }
    controllers = {
        id: read_controller(fields, element)
        for id, element in unique_by_id(fields, fields.each(root, "controller"))
    }
    require_whole(fields, root, roads, junctions)
    road_map = RoadMap(
        name=fields.optional(header, "name"),
        roads=roads,
        junctions=with_ways_back(root, roads, junctions),
        controllers=controllers,
    )
    return road_map, make_report(root, fields, version, road_map, gauge.result())
