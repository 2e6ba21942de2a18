"""What stands beside the roads, as plain geometry: houses, trees, sidewalks and verges."""

from mjdrive.town.scenery.layout import Scenery, ground_of, lay_out, standing

__all__ = ["Scenery", "ground_of", "lay_out", "standing"]
