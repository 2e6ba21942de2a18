"""The colours of a scene: matt, muted and few, as on an architect's model."""

import mujoco

Rgb = tuple[float, float, float]

GLASS: Rgb = (0.36, 0.43, 0.49)
WALLS: tuple[Rgb, ...] = (
    (0.90, 0.88, 0.84),
    (0.86, 0.79, 0.70),
    (0.79, 0.68, 0.59),
    (0.71, 0.57, 0.49),
    (0.74, 0.77, 0.78),
    (0.82, 0.80, 0.70),
)
STONE: Rgb = (0.60, 0.57, 0.53)
STONE_WINDOWS = len(WALLS)  # number of the window bands of ground floors of stone
PLAIN: dict[str, Rgb] = {
    "land": (0.61, 0.67, 0.50),
    "grass": (0.53, 0.63, 0.42),
    "asphalt": (0.35, 0.36, 0.38),
    "kerbstone": (0.83, 0.82, 0.79),
    "white_paint": (0.95, 0.95, 0.94),
    "yellow_paint": (0.93, 0.74, 0.25),
    "blue_paint": (0.27, 0.45, 0.70),
    "red_paint": (0.74, 0.26, 0.22),
    "green_paint": (0.35, 0.60, 0.38),
    "orange_paint": (0.91, 0.55, 0.22),
    "stone": STONE,
    "door": (0.33, 0.27, 0.24),
    "tiles": (0.66, 0.43, 0.35),
    "slate": (0.44, 0.45, 0.49),
    "gravel": (0.72, 0.71, 0.69),
    "trunk": (0.42, 0.35, 0.29),
    "leaves": (0.42, 0.55, 0.33),
    "young_leaves": (0.52, 0.62, 0.37),
    "metal": (0.25, 0.27, 0.29),
    "zinc": (0.66, 0.68, 0.69),
    "sign_white": (0.97, 0.97, 0.96),
    "sign_red": (0.80, 0.13, 0.12),
    "sign_black": (0.08, 0.08, 0.09),
    "concrete": (0.77, 0.76, 0.74),
}
RARE_PAINT: dict[str, Rgb] = {
    "black_paint": (0.16, 0.16, 0.17),
    "violet_paint": (0.55, 0.37, 0.66),
}
"""Paint that few maps use; only their scenes hold it."""
PAVING: Rgb = (0.77, 0.75, 0.72)
PAVING_JOINT: Rgb = (0.70, 0.68, 0.65)
PAVING_SIZE = 1.0  # of a slab [m]


def wall(number: int) -> str:
    """Name the material of plain walls of a colour."""
    return f"wall_{number}"


def windows(number: int) -> str:
    """Name the material of window bands: glass for the first half of each unit of texture, wall for the second."""
    return f"windows_{number}"


def paint(spec: mujoco.MjSpec, color: str) -> str:
    """Name the material of a road mark's paint.

    Args:
        spec: Scene; a rare paint is added to it.
        color: One of OpenDRIVE's colours, "standard" aside.

    Returns:
        Its name.
    """
    name = f"{color}_paint"
    if name in RARE_PAINT and spec.material(name) is None:
        _add(spec, name, RARE_PAINT[name])
    return name


def add_materials(spec: mujoco.MjSpec) -> None:
    """Add every material of a scene.

    Args:
        spec: Scene to add to.
    """
    for name, rgb in PLAIN.items():
        _add(spec, name, rgb)
    for number, rgb in enumerate(WALLS):
        _add(spec, wall(number), rgb)
    for number, rgb in enumerate((*WALLS, STONE)):
        spec.add_texture(
            name=windows(number),
            type=mujoco.mjtTexture.mjTEXTURE_2D,
            builtin=mujoco.mjtBuiltin.mjBUILTIN_CHECKER,
            rgb1=GLASS,
            rgb2=rgb,
            width=64,
            height=64,
        )
        _add(spec, windows(number), (1.0, 1.0, 1.0), texture=windows(number))
    spec.add_texture(
        name="paving",
        type=mujoco.mjtTexture.mjTEXTURE_2D,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_FLAT,
        mark=mujoco.mjtMark.mjMARK_EDGE,
        rgb1=PAVING,
        markrgb=PAVING_JOINT,
        width=48,
        height=48,
    )
    _add(spec, "paving", (1.0, 1.0, 1.0), texture="paving")
    spec.add_material(name="lamp", emission=0.8, specular=0.2)


def _add(spec: mujoco.MjSpec, name: str, rgb: Rgb, *, texture: str | None = None) -> None:
    material = spec.add_material(name=name, rgba=[*rgb, 1.0], specular=0.0, shininess=0.0)
    if texture:
        material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = texture
