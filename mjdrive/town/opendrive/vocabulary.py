"""Which of OpenDRIVE's types mean something here."""

DRIVEN_LANE_TYPES = frozenset(
    {"driving", "entry", "exit", "onRamp", "offRamp", "connectingRamp", "slipLane"}
)
"""OpenDRIVE lane types that become lanes of a town; shoulders, parking, bus and bicycle lanes and others do not."""

SIDEWALK_LANE_TYPES = frozenset({"sidewalk", "walking"})
"""OpenDRIVE lane types that are sidewalks; the second name is that of OpenDRIVE 1.8."""

GROUND_LANE_TYPES = frozenset(
    {"shoulder", "border", "median", "curb", "stop", "restricted", "none"}
)
"""OpenDRIVE lane types that are only ground beside the road, where nobody drives or walks."""

TRAFFIC_LIGHT_TYPE = "1000001"
"""OpenDRIVE signal type of a three-colour light."""

LIGHT_TYPES = frozenset({TRAFFIC_LIGHT_TYPE, "1000009", "1000010", "1000011"})
"""OpenDRIVE signal types of lights that stop cars: three lamps, two lamps, two and three lamps with an arrow.

Lights for people on foot, bicycles and trams are other types.
"""

SPEED_LIMIT_TYPE = "274"
"""OpenDRIVE signal type of a speed limit, as in CARLA's maps and German law."""

OBJECT_TYPES = frozenset(
    [
        "barrier",
        "bike",
        "building",
        "bus",
        "car",
        "crosswalk",
        "gantry",
        "motorbike",
        "obstacle",
        "parkingSpace",
        "patch",
        "pedestrian",
        "pole",
        "railing",
        "roadMark",
        "roadSurface",
        "soundBarrier",
        "streetLamp",
        "trafficIsland",
        "trailer",
        "train",
        "tram",
        "tree",
        "van",
        "vegetation",
        "wind",
    ]
)
"""OpenDRIVE object types."""

PAINTED_LINES = {
    "solid": ("solid",),
    "broken": ("broken",),
    "solid solid": ("solid", "solid"),
    "solid broken": ("solid", "broken"),
    "broken solid": ("broken", "solid"),
    "broken broken": ("broken", "broken"),
}
"""The lines of each painted OpenDRIVE mark, from the inside out; along the middle of the road from left to right.

Kerbs, grass, dots and edges are no paint.
"""

MARK_COLORS = frozenset(
    {"standard", "white", "yellow", "blue", "red", "green", "orange", "black", "violet"}
)
"""OpenDRIVE colours of road marks; "standard" is white."""
