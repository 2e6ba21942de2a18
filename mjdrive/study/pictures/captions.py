"""What the report writes below each picture and each table."""

from mjdrive.study.tables.paper_table import PRINTED_NOTE

_OVER_DRIVES = (
    "95 % bootstrap intervals over training seeds and drives, by draws of whole seeds and, for all of them, of the same "
    "drives; one seed is drawn by its drives alone, which says nothing of training, and what never happened has [0, 0]"
)
_OVER_SEEDS = (
    "intervals over training seeds alone, and none where there is one: they are figures of all drives of an agent together, "
    "and drives drawn with some of them twice and others not at all would take fewer ways and look less even"
)

CAPTIONS = {
    "recall": (
        "What is seen of the town",
        "Left: share of all ways through junctions (approach and exit) that were driven at least once, over the time of all "
        "drives of an agent, one after the other. Right: share of the directed lanes that were visited, over distance. Lines "
        "are means over training seeds, as far as all of them drove; faint lines are single seeds, and one goes on where its "
        "agent made the long drive. Who always turns the same way levels off early, however well it drives.",
    ),
    "turns": (
        "Turns beside the expert's",
        "How often each policy turned left, went straight on and turned right where there was a choice, mean over training "
        "seeds. Dashed lines carry the shares of the first row, the expert on a random walk, through all others. The "
        "demonstrations were driven in another town with other junctions; their own balance is shown last.",
    ),
    "trajectories": (
        "Trajectories of BC and DA-IBC",
        "The first 3,000 s of each agent's long drive through a town that it has never seen, without a route. The darker a line, the more often the "
        "street was driven; crosses and stars are infractions. The paper's figure shows the same.",
    ),
    "all-trajectories": (
        "Trajectories of all methods and references",
        "Long drives as above, one map each.",
    ),
    "landscapes": (
        "Energy landscapes",
        "Top: what the policy sees, the car in blue, lights in the colour that they show. Below: the energy of every action, "
        "that is its negative log density above the lowest [nats], dark where the action is likely; steering runs from left "
        "to right as in the view, acceleration upwards. The thin line is zero steering, red rings are separate ways to act (5 % or "
        "more) with their probability on a 128 x 128 grid, white points are {draws}. The first moment is the one at which a "
        "multimodal policy should see two ways.",
    ),
    "fans": (
        "One moment, lived many times",
        "The same state before a junction was restored again and again, and only the policy's own chance differed. Each line is "
        "one drive, coloured by the exit that it took. One colour alone is a policy that does not choose.",
    ),
    "progress": (
        "Training progress",
        "Checkpoints of each method driving in the unseen town: distance, infraction penalty, their product, and branch recall "
        "over the drives of a checkpoint. Lines are means over training seeds, bands one standard deviation of the seeds.",
    ),
    "ablation": (
        "What single changes are worth",
        "One row a change: dot and 95 % bootstrap interval over training seeds and, where a figure belongs to single drives, "
        "over drives, by the training seeds that all rows of a group have. The first row of each group, in bold, is what the others change; its value is drawn on as a dotted line. "
        "The last row is the expert on a random walk, and dashed lines carry its values through all others. One seed says nothing of the chance of training.",
    ),
    "video": (
        "Turns from one moment",
        "The drives begin in the same state. Left: what the policy sees. Middle: energy of every action and, as a white point, "
        "the one chosen. Right: the way on the map. Ten frames a second, as fast as the car.",
    ),
}
"""Title and text of each kind of picture; that of landscapes says at {draws} whose they are."""

DRAWS = {
    "dfo": "ten draws, each made anew, so without commitment: by the paper's search (DFO) from energies, whatever they drive by, and "
    "by its own sampler from any other policy",
    "own": "ten draws of the policy's own sampler, each made anew, so without commitment",
}
"""Whose draws landscapes show."""

TABLES = {
    "summary.md": (
        "In short",
        "What happened in all drives of an agent together, a number for each (for each walk of the expert). Distances by the "
        f"expert's, which is drawn with them, have {_OVER_DRIVES}. Ways by the mean of the expert's walks, and JS of turns, have "
        f"{_OVER_SEEDS}.",
    ),
    "ratios.md": (
        "The result to reach",
        "Policies beside the bars that were set. Penalty, distance by the expert's, which is drawn with it, collisions and "
        f"time off the road (sums over sums of time) have {_OVER_DRIVES}. Recall, by the mean of the expert's walks or by itself, "
        f"and JS of turns have {_OVER_SEEDS}. JS of exits is that of the passes of all seeds together, without an interval: beside "
        "it is what as many passes of a perfect policy would show, which for one agent alone may be above the bar. The bar is "
        "for exits at each approach; turns of the whole town, where wrong ones here and there make up for each other, reach it "
        "more easily.",
    ),
    "paper.md": (
        "Distance, infraction penalty and score",
        "As the paper counts them: score is distance times 0.7 to the power of red lights run. Distance and score of all drives "
        "are sums over drives, each from another start; the last score is their distance times 0.7 to the power of all of their "
        f"red lights. Rates are sums over sums. All have {_OVER_DRIVES}. {PRINTED_NOTE}",
    ),
    "multimodality.md": (
        "Multimodality",
        "What is chosen where the road forks, and how many ways to act a policy sees: modes are separate ways to act of 5 % or "
        "more at held-out moments before junctions, of which few show a choice. All have "
        f"{_OVER_SEEDS}.",
    ),
    "ablations.md": (
        "Ablations",
        "Single changes below what they change, by the same seeds, and the references. Distances by the expert's, which is drawn "
        f"with them, have {_OVER_DRIVES}. Ways, JS of turns, mode precision and likelihood have {_OVER_SEEDS}.",
    ),
    "demonstrations.md": (
        "Demonstrations",
        "What was learnt from, and how often it turns which way.",
    ),
}
"""Title and text of each table, by its file, in the order of the report."""
