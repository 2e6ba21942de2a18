"""Write a `RoadMap` as ASAM OpenDRIVE 1.8; `opendrive.parse` reads it back unchanged."""

import numpy as np
from lxml import etree

from mjdrive.town.opendrive.cross_section import LaneOfRoad
from mjdrive.town.opendrive.lane_geometry import lane_centres
from mjdrive.town.opendrive.road_map import Junction, RoadMap
from mjdrive.town.opendrive.road_writer import add, add_road
from mjdrive.town.opendrive.xml_fields import Element


def write(road_map: RoadMap) -> bytes:
    """Write a map; the same map gives the same bytes.

    Args:
        road_map: The road network.

    Returns:
        The XML document.
    """
    root = etree.Element("OpenDRIVE")
    _add_header(root, road_map)
    for road in road_map.roads.values():
        add_road(root, road)
    for order, (controller, signals) in enumerate(road_map.controllers.items()):
        element = add(
            root, "controller", id=controller, name=f"Controller {controller}", sequence=order
        )
        for signal in signals:
            add(element, "control", signalId=signal, type="")
    for junction in road_map.junctions.values():
        _add_junction(root, road_map, junction)
    etree.indent(root, space=" ")
    document: bytes = etree.tostring(root, xml_declaration=True, encoding="UTF-8")
    return document + b"\n"


def _add_header(root: Element, road_map: RoadMap) -> None:
    lanes = [
        LaneOfRoad(road, index, lane.id)
        for road in road_map.roads.values()
        for index, section in enumerate(road.sections)
        for lane in section.lanes
        if lane.id
    ]
    points = np.concatenate([centre for centre, _ in lane_centres(lanes)])
    (west, south), (east, north) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    add(
        root,
        "header",
        revMajor="1",
        revMinor="8",
        name=road_map.name,
        version="1.00",
        north=round(north, 3),
        south=round(south, 3),
        east=round(east, 3),
        west=round(west, 3),
        vendor="mjdrive",
    )


def _add_junction(root: Element, road_map: RoadMap, junction: Junction) -> None:
    # In a direct junction roads follow each other at once, without a road of the junction in between.
    is_direct = any(
        road_map.roads[connection.connecting].junction != junction.id
        for connection in junction.connections
    )
    kind, follows = ("direct", "linkedRoad") if is_direct else ("default", "connectingRoad")
    element = add(root, "junction", id=junction.id, name=junction.name, type=kind)
    for connection in junction.connections:
        child = add(
            element,
            "connection",
            id=connection.id,
            incomingRoad=connection.incoming,
            **{follows: connection.connecting},
            contactPoint=connection.contact,
        )
        for here, there in connection.lane_links:
            add(child, "laneLink", **{"from": here, "to": there})
    for order, controller in enumerate(junction.controllers):
        add(element, "controller", id=controller, type="0", sequence=order)
