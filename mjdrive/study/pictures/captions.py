"""What the report writes below each picture and above each table."""

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
        "to right as in the view, acceleration upwards. The thin line is zero steering, white points are ten actions that the "
        "policy chose, red rings are separate ways to act (5 % or more) with their probability on a 128 x 128 grid. The first "
        "moment is the one at which a multimodal policy should see two ways.",
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
        "One seed says nothing of the chance of training.",
    ),
    "video": (
        "Turns from one moment",
        "The drives begin in the same state. Left: what the policy sees. Middle: energy of every action and, as a white point, "
        "the one chosen. Right: the way on the map. Ten frames a second, as fast as the car.",
    ),
}
"""Title and text of each kind of picture."""

TABLES = {
    "summary.md": (
        "In short",
        "What happened in all drives of an agent together, a number for each (for each walk of the expert); ratios with 95 % "
        "bootstrap intervals over training seeds and drives.",
    ),
    "ratios.md": (
        "The result to reach",
        "Policies beside the bars that were set; 95 % bootstrap intervals over training seeds and drives in brackets.",
    ),
    "paper.md": (
        "Distance, infraction penalty and score",
        "As the paper counts them: score is distance times 0.7 to the power of red lights run.",
    ),
    "multimodality.md": (
        "Multimodality",
        "What is chosen where the road forks, and how many ways to act a policy sees.",
    ),
    "ablations.md": ("Ablations", "Single changes below what they change, by the same seeds."),
    "demonstrations.md": (
        "Demonstrations",
        "What was learnt from, and how often it turns which way.",
    ),
}
"""Title and text of each table, by its file, in the order of the report."""
