"""Compiled scene -> one message with all that the page needs to draw it.

Meshes are sent as they are; boxes, cylinders, spheres and ellipsoids of the town as instances of one shape each, so that a
town of a thousand geoms takes some forty draw calls. Lamps come apart: their colours change.

    meshes     in the head: body, material; blobs vertices_<n> (V, 3) [m] and faces_<n> (F, 3), or, where the material has a
               texture, triangles one by one with uv_<n> (3 F, 2)
    instances  blobs box, cylinder, sphere of (N, 13): position [m], quaternion, half extents [m], red, green, blue
    parts      in the head: what moves: body, shape, position, quaternion, size, color
    footprint  in the head, of the car in the view: width, and how far nose and tail are above the lower edge [px]
    lamps      blob (3 L, 4): position and radius [m]; green, yellow and red of each light in turn, radius 0 if unseen
    lanes      blobs lane_points (P, 2) [m], lane_ends (K,) and lane_widths (K,) [m]; light_places (L, 2) [m]
"""

from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float

from mjdrive.config import BevConfig
from mjdrive.datatypes import Signal, Town
from mjdrive.page import wire
from mjdrive.simulation.blocks import UNSEEN_GROUP
from mjdrive.vehicle.parameters import VehicleParameters

_SHAPES = {
    int(mujoco.mjtGeom.mjGEOM_BOX): "box",
    int(mujoco.mjtGeom.mjGEOM_CYLINDER): "cylinder",
    int(mujoco.mjtGeom.mjGEOM_SPHERE): "sphere",
    int(mujoco.mjtGeom.mjGEOM_ELLIPSOID): "sphere",
}
_MESH = int(mujoco.mjtGeom.mjGEOM_MESH)
_GREY = (0.5, 0.5, 0.5, 1.0)
"""Colour of a geom that has none of its own."""


def scene_message(town: Town, model: mujoco.MjModel) -> bytes:
    """Describe a scene to the page.

    Args:
        town: The road network.
        model: Its compiled scene, with the car.
    """
    shown = [
        it
        for it in range(model.ngeom)
        if model.geom_group[it] < UNSEEN_GROUP and not model.geom(it).name.startswith("lamp_")
    ]
    meshes, blobs = _meshes(model, [it for it in shown if model.geom_type[it] == _MESH])
    simple = [it for it in shown if int(model.geom_type[it]) in _SHAPES]
    standing = [it for it in simple if not model.geom_bodyid[it]]
    for shape in sorted(set(_SHAPES.values())):
        rows = [_row(model, it) for it in standing if _SHAPES[int(model.geom_type[it])] == shape]
        blobs[shape] = np.array(rows, np.float32).reshape(-1, 13)
    textures, texture_blobs = _textures(model)
    head = {
        "town": town.name,
        "bounds": town.bounds.round(2).tolist(),
        "footprint": _footprint(VehicleParameters.of(model)),
        "bodies": model.nbody - 1,
        "materials": [_color(model.mat_rgba[it]) for it in range(model.nmat)],
        "textures": textures,
        "meshes": meshes,
        "parts": [_part(model, it) for it in simple if model.geom_bodyid[it]],
        "land": _color(model.mat("land").rgba),
    }
    return wire.pack("scene", head, {**blobs, **texture_blobs, **_lamps(town, model), **_map(town)})


def _meshes(
    model: mujoco.MjModel, geoms: list[int]
) -> tuple[list[dict[str, Any]], dict[str, np.ndarray]]:
    """Meshes with the geoms that show them; a mesh that several geoms share is sent once."""
    placed: list[dict[str, Any]] = []
    blobs: dict[str, np.ndarray] = {}
    for geom in geoms:
        mesh, material = int(model.geom_dataid[geom]), int(model.geom_matid[geom])
        placed.append({**_place(model, geom), "mesh": mesh, "material": material})
        if f"vertices_{mesh}" not in blobs:
            blobs |= _mesh(model, mesh)
    return placed, blobs


def _mesh(model: mujoco.MjModel, mesh: int) -> dict[str, np.ndarray]:
    start, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
    first, num_faces = model.mesh_faceadr[mesh], model.mesh_facenum[mesh]
    vertices = model.mesh_vert[start : start + count].astype(np.float32)
    faces = model.mesh_face[first : first + num_faces].astype(np.uint32)
    if model.mesh_texcoordadr[mesh] < 0:
        return {f"vertices_{mesh}": vertices, f"faces_{mesh}": faces}
    corners = model.mesh_facetexcoord[first : first + num_faces].reshape(-1)
    uv = model.mesh_texcoord[model.mesh_texcoordadr[mesh] + corners].astype(np.float32)
    return {f"vertices_{mesh}": vertices[faces.reshape(-1)], f"uv_{mesh}": uv}


def _textures(model: mujoco.MjModel) -> tuple[dict[int, int], dict[str, np.ndarray]]:
    """Number of the texture of each material that has one, and their pixels, (H, W, 3)."""
    role = int(mujoco.mjtTextureRole.mjTEXROLE_RGB)
    of_material = {it: int(model.mat_texid[it, role]) for it in range(model.nmat)}
    textures = {material: number for material, number in of_material.items() if number >= 0}
    blobs = {}
    for number in sorted(set(textures.values())):
        height, width = int(model.tex_height[number]), int(model.tex_width[number])
        channels, start = int(model.tex_nchannel[number]), int(model.tex_adr[number])
        pixels = model.tex_data[start : start + height * width * channels]
        blobs[f"texture_{number}"] = pixels.reshape(height, width, channels)[..., :3]
    return textures, blobs


def _place(model: mujoco.MjModel, geom: int) -> dict[str, Any]:
    """Where a geom is in its body; bodies are counted without the world, which is -1."""
    return {
        "body": int(model.geom_bodyid[geom]) - 1,
        "position": model.geom_pos[geom].round(4).tolist(),
        "quaternion": model.geom_quat[geom].round(5).tolist(),
        "color": _color(_rgba(model, geom)),
    }


def _part(model: mujoco.MjModel, geom: int) -> dict[str, Any]:
    shape = _SHAPES[int(model.geom_type[geom])]
    size = _half_extents(model, geom).round(4).tolist()
    return {**_place(model, geom), "shape": shape, "size": size}


def _row(model: mujoco.MjModel, geom: int) -> list[float]:
    """One instance, 13 numbers."""
    place = [*model.geom_pos[geom], *model.geom_quat[geom], *_half_extents(model, geom)]
    return [*place, *_color(_rgba(model, geom))]


def _half_extents(model: mujoco.MjModel, geom: int) -> Float[np.ndarray, "3"]:
    """Half of the length along each axis [m]."""
    size = model.geom_size[geom]
    shape = int(model.geom_type[geom])
    if shape == int(mujoco.mjtGeom.mjGEOM_CYLINDER):
        return np.array([size[0], size[0], size[1]])
    if shape == int(mujoco.mjtGeom.mjGEOM_SPHERE):
        return np.full(3, size[0])
    return np.array(size)


def _rgba(model: mujoco.MjModel, geom: int) -> np.ndarray:
    material = int(model.geom_matid[geom])
    own = model.geom_rgba[geom]
    is_plain = material >= 0 and np.allclose(own, _GREY)
    return np.array(model.mat_rgba[material] if is_plain else own)


def _color(rgba: np.ndarray) -> list[float]:
    return [round(float(it), 3) for it in rgba[:3]]


def _footprint(car: VehicleParameters) -> list[float]:
    """Where the car is in its bird's-eye view: width, and how far nose and tail are above the lower edge [px]."""
    view = BevConfig()
    rear_axle = view.ego_above_bottom_px - view.pixels_per_metre * view.origin_ahead_of_rear_axle
    tail = rear_axle - view.pixels_per_metre * car.rear_overhang
    length, width = view.pixels_per_metre * car.length, view.pixels_per_metre * car.width
    return [round(it, 2) for it in (width, tail + length, tail)]


def _lamps(town: Town, model: mujoco.MjModel) -> dict[str, np.ndarray]:
    rows = []
    for light in town.lights:
        for signal in Signal:
            geom = model.geom(f"lamp_{light}_{signal.name.lower()}").id
            seen = model.geom_group[geom] < UNSEEN_GROUP
            rows.append([*model.geom_pos[geom], model.geom_size[geom, 0] * seen])
    return {"lamps": np.array(rows, np.float32).reshape(-1, 4)}


def _map(town: Town) -> dict[str, np.ndarray]:
    lines = [lane.centerline for lane in town.lanes.values()]
    places = [light.stop_line.mean(axis=0) for light in town.lights.values()]
    return {
        "lane_points": np.concatenate(lines).astype(np.float32),
        "lane_ends": np.cumsum([len(line) for line in lines]).astype(np.uint32),
        "lane_widths": np.array([lane.width for lane in town.lanes.values()], np.float32),
        "light_places": np.array(places, np.float32).reshape(-1, 2),
    }
