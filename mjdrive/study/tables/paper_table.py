"""The paper's table: distance, infraction penalty and score, beside what the paper itself printed."""

import numpy as np
from jaxtyping import Float

from mjdrive.config import StudyConfig
from mjdrive.evaluation import bootstrap
from mjdrive.evaluation.metrics import RED_LIGHT_FACTOR
from mjdrive.study.records.results import StudyResults
from mjdrive.study.tables.rows import (
    NOTHING,
    Column,
    agents_table,
    drive_column,
    duration,
    has_size_of_the_paper,
)

PRINTED = {
    "BC": ("9,074 ± 593", "0.97 ± 0.09", "8,807 ± 1,040"),
    "IBC": ("4,855 ± 4,706", "0.68 ± 0.25", "2,937 ± 2,976"),
    "DA-IBC": ("12,741 ± 209", "0.66 ± 0.18", "8,456 ± 2,322"),
}
"""Distance, infraction penalty and score of the paper's agents, as the source of the paper has them in a table that it
does not show; the distances stand in its text, too."""

PRINTED_LABEL = "{}: CARLA, as printed in the paper"
"""What the rows of the paper are called."""

PRINTED_NOTE = (
    "Rows of the paper stand where their figures can belong. Its penalty and score are said to be those of episodes of 300 s, "
    "but nothing drives 12,741 m in 300 s, which is 42 m/s: in 3,000 s, ten such episodes, it is 4.2 m/s. The score is about "
    "distance times penalty, so it stands with ten scores of 300 s added up. Were the paper's episodes 3,000 s long, its "
    "penalties and scores would be those of 3,000 s. Its ± is a standard deviation, and the paper does not say of what: 0.97 ± "
    "0.09 is what one red light in ten episodes gives. Not to be compared to the digit: CARLA's car, lights and Town02 are "
    "others than these, and how the paper measured distance, from which starts, and after how many epochs is not published."
)
"""What the rows of the paper mean, and what they do not."""


def paper_table(config: StudyConfig, found: StudyResults) -> str:
    """Distance, infraction penalty and score, as the paper counts them, and what else went wrong.

    All have bootstrap intervals over seeds and episodes. What is counted in all episodes of an agent is their sum, rates
    are sums over sums. What the paper printed stands below where episodes are as many and as long as its own.

    Args:
        config: Settings of the study.
        found: Its results.
    """
    episode, all_drives = duration(config.steps), duration(config.steps * config.episodes)
    added_up = f"{config.episodes} scores [m] of {episode} added up"
    distances, penalties = f"distance [m] per {all_drives}", f"penalty 0.7^n per {episode}"
    total = bootstrap.total
    columns: tuple[Column, ...] = (
        (f"distance [m] per {episode}", drive_column(lambda it: it.distance_m)),
        (distances, drive_column(lambda it: it.distance_m, statistic=total)),
        (penalties, drive_column(lambda it: it.penalty)),
        (
            f"penalty 0.7^n per {all_drives}",
            drive_column(lambda it: it.red_lights, statistic=long_penalty),
        ),
        (f"score [m] per {episode}", drive_column(lambda it: it.score)),
        (added_up, drive_column(lambda it: it.score, statistic=total)),
        (
            f"score [m] per {all_drives}",
            drive_column(lambda it: it.distance_m, lambda it: it.red_lights, statistic=long_score),
        ),
        (
            "red lights per km",
            drive_column(
                lambda it: it.red_lights, lambda it: it.distance_m / 1000, statistic=bootstrap.rate
            ),
        ),
        (
            "red lights run per light met",
            drive_column(
                lambda it: it.red_lights, lambda it: it.lights_met, statistic=bootstrap.rate
            ),
        ),
        (f"collisions per {all_drives}", drive_column(lambda it: it.collisions, statistic=total)),
        (f"off road [s] per {all_drives}", drive_column(lambda it: it.off_road_s, statistic=total)),
        (f"stuck [s] per {all_drives}", drive_column(lambda it: it.stuck_s, statistic=total)),
        ("jerk [m/s³]", drive_column(lambda it: it.jerk_rms)),
        ("steering whiteness [1/s]", drive_column(lambda it: it.steering_whiteness)),
    )
    if not has_size_of_the_paper(config):
        return agents_table(config, found, columns)
    printed = [
        [
            PRINTED_LABEL.format(name),
            *_printed(columns, {distances: distance, penalties: penalty, added_up: score}),
        ]
        for name, (distance, penalty, score) in PRINTED.items()
    ]
    return f"{agents_table(config, found, columns, printed)}\n{PRINTED_NOTE}\n"


def long_penalty(reds: Float[np.ndarray, "*B S E"]) -> Float[np.ndarray, "*B"]:
    """0.7 to the power of all red lights of an agent, mean over seeds [-]."""
    return np.asarray((RED_LIGHT_FACTOR ** reds.sum(axis=-1)).mean(axis=-1))


def long_score(
    distance: Float[np.ndarray, "*B S E"], reds: Float[np.ndarray, "*B S E"]
) -> Float[np.ndarray, "*B"]:
    """Distance of all episodes of an agent times 0.7 to the power of all its red lights, mean over seeds [m]."""
    scores = distance.sum(axis=-1) * RED_LIGHT_FACTOR ** reds.sum(axis=-1)
    return np.asarray(scores.mean(axis=-1))


def _printed(columns: tuple[Column, ...], shown: dict[str, str]) -> list[str]:
    """A row of figures that are known as text, with nothing for training seeds and all other columns."""
    return [NOTHING, *(shown.get(title, NOTHING) for title, _ in columns)]
