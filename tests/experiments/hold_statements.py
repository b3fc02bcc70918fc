"""What docs/hold-results.md, and README.md at its top, say of published tables, written from notebooks-data/*.csv.

One function per section yields sentences and rows of tables, each as it must stand in the page.
"""

from results_statements import percent
from scipy import stats

HANDS = {"gripper": "gripper", "barrett": "Barrett", "barrett_ends": "Barrett with end pads", "human": "human hand", "allegro": "Allegro", "shadow": "Shadow"}
KINDS = {"precision": "precision", "power": "power", "four": "precision, four fingers"}
OBJECTS = {"buddha_head": "Buddha's head", "max_planck": "Max Planck"}
OUTCOMES = {
    "no_stable_pair": "no stable pair", "no_way_in": "no way in", "no_target_set": "no target set", "gap_left": "a gap left",
    "missed_contact": "a contact missed", "blocked_finger": "a finger blocked", "self_collision": "self-collision",
    "initial_collision": "initial collision", "iteration_limit": "iteration limit", "poor_shape": "poor shape",
    "weak_features_only": "weak features only", "usable_but_not_valid": "usable but not valid",
}  # fmt: skip
PROTOCOLS = {"normal": "dexgraspbench-100g", "hard": "dexonomy-hard", "multidex": "gendexgrasp"}
CHOICES = ("first", "balanced", "strongest_4", "strongest_24")


def grip_name(grip):
    hand, kind = grip.split("_")
    return f"{HANDS[hand]}, {KINDS[kind]}"


def object_name(name):
    return OBJECTS.get(name, name.replace("_", " "))


def interval(held, attempts):
    """Returns the 95 % interval of Clopper and Pearson, in percent."""
    low = stats.beta.ppf(0.025, held, attempts - held + 1) if held > 0 else 0.0
    high = stats.beta.ppf(0.975, held + 1, attempts - held) if held < attempts else 1.0
    return f"{100 * low:.0f} to {100 * high:.0f}"


def quartiles(row, quantity, decimals):
    return ", ".join(f"{row[f'{which}_margin_{quantity}']:.{decimals}f}" for which in ("lower_quartile", "median", "upper_quartile"))


# These functions are about grasps that hold.


def held_cell(held, attempts, grasps):
    return f"{held} ({100 * held / attempts:.0f}, {100 * held / grasps:.0f})"


def hold_rates(tables):
    rows = tables.table("hold_rates")
    summary = tables.table("hold_rates.summary").set_index("grip")
    groups = dict(list(rows.groupby("grip", sort=False)))
    for grip, group in groups.items():
        attempts, valid = int(group["attempts"].sum()), int(group["valid"].sum())
        held = " | ".join(held_cell(int(group[f"{protocol}_held"].sum()), attempts, valid) for protocol in PROTOCOLS)
        yield (f"| {grip_name(grip)} | {attempts} | {valid} | {held} "
               f"| {quartiles(summary.loc[grip], 'force_n', 1)} | {quartiles(summary.loc[grip], 'torque_nm', 2)} |")

    def rate(grip, protocol):
        held, attempts = int(groups[grip][f"{protocol}_held"].sum()), int(groups[grip]["attempts"].sum())
        return f"{percent(held / attempts)} ({interval(held, attempts)})"

    for hand in ("allegro_precision", "shadow_power"):
        yield f"{rate(hand, 'normal')} |"
        yield f"{rate(hand, 'hard')} |"
    for hand in ("barrett", "allegro", "shadow"):
        yield f"precision {rate(hand + '_precision', 'multidex')}, power {rate(hand + '_power', 'multidex')} |"
    yield from lowest_and_highest(rows)
    yield from lost_attempts(rows)
    lost = {stage: int(rows[f"hard_{stage}"].sum()) for stage in ("rejected", "lost_before_load", "lost_under_load")}
    yield (f"In hard mode {sum(lost.values())} of {int(rows['valid'].sum())} grasps are lost: {lost['lost_under_load']} under load, "
           f"{lost['lost_before_load']} before it")


def least_held(rows, held, name):
    """Yields for each hand the cells in which at most half of the attempts are held, fewest first."""
    for grip, group in rows.groupby("grip", sort=False):
        few = group[group[held] <= group["attempts"] / 2].sort_values(held, kind="stable")
        named = ", ".join(f"{name(row)} {int(row[held])}" for _, row in few.iterrows())
        yield f"{HANDS[grip]}: {named or 'none'}"


def hold_default(tables):
    rows = tables.table("hold_default")
    details = tables.table("hold_default.details")
    seconds = tables.table("hold_default.timing").groupby("grip")["plan_s"].sum()
    for grip, group in rows.groupby("grip", sort=False):
        attempts = int(group["attempts"].sum())
        closed = int((details[details["grip"] == grip]["force_closure"] == 1).sum())
        held = (int(group[f"{protocol}_held"].sum()) for protocol in PROTOCOLS)
        cells = " | ".join(f"{number} ({percent(number / attempts)}, {interval(number, attempts)})" for number in held)
        yield (f"| {HANDS[grip]} | {attempts} | {int(group['valid'].sum())} | {closed} | {cells} "
               f"| {seconds[grip] / attempts:.2f} |")
    yield from least_held(rows, "normal_held", lambda row: object_name(row["object"]))
    yield from lost_attempts(rows)


LEAST_HEIGHT = 0.03  # of objects that count [m]


def cells_from_table(tables):
    """Returns the cells that were planned, with what of each is held in both tests, and those that were not."""
    table = tables.table("from_table")
    table["plan_s"] = tables.table("from_table.timing")["plan_s"]
    key = ["object", "rest_pose", "grip"]
    details = tables.table("from_table.details")
    details["both"] = (details["normal_stage"] == "held") & (details["lift_stage"] == "held")
    details["closed"] = details["force_closure"] == 1
    table = table.merge(details.groupby(key)[["both", "closed"]].sum().reset_index(), on=key, how="left")
    return table[table["status"] == "ok"].fillna({"both": 0, "closed": 0}), table[table["status"] != "ok"]


def from_table(tables):
    table, refused = cells_from_table(tables)
    counted = table[table["height_m"] >= LEAST_HEIGHT]
    for grip, group in counted.groupby("grip", sort=False):
        attempts = int(group["attempts"].sum())
        both = int(group["both"].sum())
        sums = " | ".join(str(int(group[name].sum())) for name in ("valid", "closed", "lift_held", "normal_held"))
        yield (f"| {HANDS[grip]} | {len(group)} | {attempts} | {sums} | {both} ({percent(both / attempts)}, {interval(both, attempts)}) "
               f"| {group['plan_s'].sum() / attempts:.2f} |")
    for line in least_held(counted, "both", table_object):
        yield f"- {line}"
    low = table[table["height_m"] < LEAST_HEIGHT]
    for (name, pose), group in low.groupby(["object", "rest_pose"], sort=False):
        held = ", ".join(f"{HANDS[row['grip']]} {int(row['both'])}" for _, row in group.iterrows())
        yield f"{table_object({'object': name, 'rest_pose': pose})} ({1000 * group['height_m'].iloc[0]:.0f} mm): {held}"
    for (name, grip), group in refused.groupby(["object", "grip"], sort=False):
        yield f"{object_name(name)} and {HANDS[grip]}, {len(group)} poses"
    multidex = counted[counted["object"].str.startswith("multidex_")].groupby("grip", sort=False)[["both", "attempts"]].sum()
    yield ", ".join(f"{HANDS[grip]} {percent(row['both'] / row['attempts'])}" for grip, row in multidex.iterrows())
    yield from lost_attempts(table)


MULTIDEX_PROTOCOLS = ("dro", "normal", "hard")


def held_of(group, protocol, attempts):
    held = int(group[f"{protocol}_held"].sum())
    return f"{held} ({100 * held / attempts:.1f} %, {interval(held, attempts)})"


def multidex_objects(tables):
    table = tables.table("multidex_objects")
    table["plan_s"] = tables.table("multidex_objects.timing")["plan_s"]
    details = tables.table("multidex_objects.details")
    rates = {protocol: [] for protocol in MULTIDEX_PROTOCOLS}
    for grip, group in table.groupby("grip", sort=False):
        attempts = int(group["attempts"].sum())
        closed = int((details[details["grip"] == grip]["force_closure"] == 1).sum())
        held = " | ".join(held_of(group, protocol, attempts) for protocol in MULTIDEX_PROTOCOLS)
        for protocol, of_hands in rates.items():
            of_hands.append(group[f"{protocol}_held"].sum() / attempts)
        yield (f"| {HANDS[grip]} | {attempts} | {int(group['valid'].sum())} | {closed} | {held} | {group['plan_s'].sum() / attempts:.2f} "
               f"| {group['clusters'].sum() / len(group):.0f} |")
    yield ", ".join(f"{100 * sum(of_hands) / len(of_hands):.1f} % under `{name}`" for of_hands, name in
                    zip(rates.values(), ("dro", "dexgraspbench-100g", "dexonomy-hard")))
    for protocol, least in (("dro", 0.948), ("normal", 0.85)):
        low = table[table[f"{protocol}_held"] < least * table["attempts"]]
        named = ", ".join(f"{object_name(row['object'].removeprefix('multidex_'))} and {HANDS[row['grip']]} {int(row[f'{protocol}_held'])}"
                          for _, row in low.sort_values(f"{protocol}_held", kind="stable").iterrows())
        yield f"{100 * least:g} %: {named or 'none'}"
    yield from lost_attempts(table)


def table_object(row):
    return f"{object_name(row['object'].removeprefix('multidex_'))} in pose {row['rest_pose']}"


def lowest_and_highest(rows):
    """Yields the objects with the lowest two rates under the first protocol and those with the highest."""
    sums = rows.groupby("object", sort=False)[["normal_held", "attempts"]].sum()
    rates = (sums["normal_held"] / sums["attempts"]).map(percent)
    ordered = sorted(set(rates), key=lambda rate: int(rate.split()[0]))

    def named(rate):
        return f"{rate} ({', '.join(object_name(name) for name in rates[rates == rate].index)})"

    yield f"Per object from {named(ordered[0])}, {named(ordered[1])} to {named(ordered[-1])} of all attempts"


def lost_attempts(rows):
    attempts = int(rows["attempts"].sum())
    counts = {name: int(rows[f"attempts_{outcome}"].sum()) for outcome, name in OUTCOMES.items()}
    named = ", ".join(f"{name} {count}" for name, count in sorted(counts.items(), key=lambda item: -item[1]) if count)
    yield f"Of the {attempts} attempts {sum(counts.values())} are not valid: {named}"


# These functions are about what predicts that a grasp holds.


MEASURES = {"m": "M", "m1": "M1", "m2": "M2", "m3": "M3", "epsilon": "ε (μ 0.4)", "volume": "volume of the wrench space",
            "min_weight": "min-weight (three and more contacts)"}  # fmt: skip
TARGETS = ("normal_held", "hard_held", "margin_force_n", "margin_torque_nm")


def signed(value):
    return f"{value:.2f}".replace("-", "−")


def hold_prediction(tables):
    rows = tables.table("hold_prediction")
    details = tables.table("hold_prediction.details")
    summary = tables.table("hold_prediction.summary").set_index(["grip", "target", "measure", "scope"])
    held = {protocol: int(rows[f"{protocol}_held"].sum()) for protocol in PROTOCOLS}
    grasps = len(details)
    easy = "all" if held["multidex"] == grasps else held["multidex"]
    yield (f"{grasps} valid grasps of {int(rows['attempts'].sum())} attempts, {held['normal']} of which hold under "
           f"`dexgraspbench-100g`, {held['hard']} under `dexonomy-hard` and {easy} under `gendexgrasp`")
    margins = details[details["margin_force_n"].notna()]
    force, torque = (margins[column].quantile([0.25, 0.5, 0.75]) for column in ("margin_force_n", "margin_torque_nm"))
    yield (f"Margins of the first grasp of each cell ({len(margins)}): quartiles {force.iloc[0]:.1f}, {force.iloc[1]:.1f} and "
           f"{force.iloc[2]:.1f} N, {torque.iloc[0]:.2f}, {torque.iloc[1]:.2f} and {torque.iloc[2]:.2f} N m")
    for measure, name in MEASURES.items():
        cells = (summary.loc[("all", target, measure, "all")] for target in TARGETS)
        yield f"| {name} | " + " | ".join(f"{signed(c['value'])} [{signed(c['low'])}, {signed(c['high'])}]" for c in cells) + " |"
    is_held = details["normal_stage"] == "held"
    area = stats.mannwhitneyu(-details[is_held]["squeeze_residual"], -details[~is_held]["squeeze_residual"]).statistic
    yield f"computed from `hold_prediction.details.csv`) | {area / (is_held.sum() * (~is_held).sum()):.2f} | | | |"
    within = (summary.loc[("all", "normal_held", measure, "cell")] for measure in ("m", "epsilon"))
    m, epsilon = (f"{percent(cell['value'])} [{100 * cell['low']:.0f}, {100 * cell['high']:.0f}]" for cell in within)
    yield f"the larger M in {m} and the larger ε in {epsilon}"
    sizes = details.groupby("grip").size()
    yield f"Per grip ({sizes.min()} to {sizes.max()} grasps each, in the summary)"


# These functions are about what an attempt gains by choosing.


def hold_choices(tables):
    rows = tables.table("hold_choices")
    seconds = tables.table("hold_choices.timing").groupby(["grip", "choice"])["plan_s"].sum()
    sums = rows.groupby(["grip", "choice"])[["attempts", "valid", "normal_held", "hard_held", "attempts_no_stable_pair"]].sum()
    for grip in dict.fromkeys(rows["grip"]):
        cells = (sums.loc[(grip, choice)] for choice in CHOICES)
        times = (seconds.loc[(grip, choice)] / sums.loc[(grip, choice), "attempts"] for choice in CHOICES)
        yield f"| {grip_name(grip)} | " + " | ".join(
            f"{counts(cell)} ({time:.1f} s)" for cell, time in zip(cells, times, strict=True)) + " |"
    first, balanced, of_4, of_24 = (sums.xs(choice, level="choice").sum() for choice in CHOICES)
    yield f"| all | {counts(first)} of {first['attempts']} | {counts(balanced)} | {counts(of_4)} | {counts(of_24)} |"
    yield f"({balanced['normal_held']} held against {first['normal_held']})"
    yield f"without a stable pair ({balanced['attempts_no_stable_pair']} against {first['attempts_no_stable_pair']})"
    yield f"{of_4['valid']} of {of_4['attempts']} attempts are valid, against {first['valid']} (first accepted) and {balanced['valid']} (balanced)"
    three, four = (sums.loc[(grip, "strongest_24"), "hard_held"] for grip in ("allegro_precision", "allegro_four"))
    yield f"({four} of {sums.loc[('allegro_four', 'strongest_24'), 'attempts']} attempts against {three})"


def counts(cell):
    return f"{cell['valid']}, {cell['normal_held']}, {cell['hard_held']}"


def at_a_glance(tables):
    """Yields what README.md says."""
    for name, sentence in (("planner_paper_objects", "{} of {} attempts end in a valid grasp"), ("planner_everyday", "({} of {}:")):
        rows = tables.table(name)
        yield sentence.format(percent(rows["valid"].sum() / rows["attempts"].sum()), int(rows["attempts"].sum()))
    rows = tables.table("hold_default")
    closed = int((tables.table("hold_default.details")["force_closure"] == 1).sum())
    attempts = int(rows["attempts"].sum())
    yield f"{percent(closed / attempts)} of {attempts} attempts without flags end in a grasp that closes"
    sums = rows.groupby("grip", sort=False)[["normal_held", "hard_held", "attempts"]].sum()
    for protocol in ("normal", "hard"):
        yield ", ".join(f"{HANDS[grip]} {percent(row[f'{protocol}_held'] / row['attempts'])}" for grip, row in sums.iterrows())
    table, _ = cells_from_table(tables)
    sums = table[table["height_m"] >= LEAST_HEIGHT].groupby("grip", sort=False)[["both", "attempts"]].sum()
    yield ", ".join(f"{HANDS[grip]} {percent(row['both'] / row['attempts'])}" for grip, row in sums.iterrows())
    yield f"of {int(sums['attempts'].sum())} attempts at objects at their own sizes"
    rows = tables.table("hold_rates")[lambda table: table["grip"] == "allegro_precision"]
    attempts = int(rows["attempts"].sum())
    yield f"{percent(rows['normal_held'].sum() / attempts)} of {attempts} attempts end in a fingertip grasp of the Allegro hand"
    yield f"{percent(rows['hard_held'].sum() / attempts)} under Dexonomy's hard mode"
    summary = tables.table("hold_prediction.summary").set_index(["grip", "target", "scope", "measure"])["value"].sort_index()
    area = summary.loc[("all", "normal_held", "all")]
    yield f"an area under the ROC curve of {area['m']:.2f}, ε with {area['epsilon']:.2f}"
