"""What REPRODUCTION.md and docs/paper-results.md say of published tables, written from notebooks-data/*.csv and adopted grasp files.

One function per section yields sentences and rows of tables, each as it must stand in the page.
"""

import json
import sys

import numpy
import pandas

OBJECTS = {"bowling_pin": "bowling pin", "bowling_ball": "bowling ball", "max_planck": "Max Planck", "kitten": "kitten"}
METHODS = ["gs-targets", "gs", "ma", "ma-full-retreat", "fitting", "fitting-reject-deviation", "fitting-reject-m"]
HEADLINE = "fitting-reject-deviation"
BASELINES = {"gs-targets": "GS by targets", "gs": "GS by approach", "ma": "MA as published", "ma-full-retreat": "MA with full retreat"}
AS_PUBLISHED = "ma"


def digits(value):
    """Returns two significant digits, as the page has them; "none" where there is no number."""
    if pandas.isna(value):
        return "none"
    return f"{value:.2f}" if abs(value) >= 0.1 or value == 0 else f"{value:.2g}" if abs(value) >= 1e-4 else f"{value:.1g}"


def percent(value):
    return f"{100 * value:.0f} %"


class Tables:
    """Published tables and adopted grasp files of a source tree, and the figures' modules that choose from them."""

    def __init__(self, root):
        sys.path[1:1] = [str(root / "paper-figures" / room) for room in ("drawing", "scenes", "charts")]
        from figure_data import Source

        self.source = Source(root / "notebooks-data", root / "paper-figures" / "data")
        self.folder = root / "notebooks-data"

    def table(self, name):
        return pandas.read_csv(self.folder / f"{name}.csv", dtype={"size": str})


# These functions are about tables of planning methods.


#: How a row's second label is written, by the axis that it is of.
LABELS = {"size": " | {} m", "reading": " | `{}`"}


def method_rows(tables, name, row, cell):
    """Yields one row per object and, if there is one, value of the axis `row`, with one cell per
    method that the table has."""
    summary = tables.table(f"{name}.summary")
    methods = [method for method in METHODS if method in set(summary["planner"])]
    labels = ["object", row] if row else ["object"]
    summary = summary.set_index([*labels, "planner"])
    for key in dict.fromkeys(index[:-1] for index in summary.index):
        cells = " | ".join(cell(summary.loc[(*key, method)]) for method in methods)
        second = LABELS[row].format(key[1]) if row else ""
        yield f"| {OBJECTS.get(key[0], key[0].replace('_', ' '))}{second} | {cells} |"


def quality(row):
    if row["grasps"] == 0:
        return "none"
    error = "" if pandas.isna(row["se_m"]) else f" ± {digits(row['se_m'])}"
    over_paper = "" if pandas.isna(row["m_over_paper"]) else f" ({digits(row['m_over_paper'])})"
    return f"{digits(row['mean_m'])}{error}{over_paper}"


def orders(tables, name, row, method, objects=None, seconds=None, measure="mean_m"):
    """Yields of how many rows with both a method is above each baseline."""
    summary = tables.table(f"{name}.summary")
    if objects:
        summary = summary[summary["object"].isin(objects)]
    if seconds:
        summary = summary[summary[row].isin(seconds)]
    means = summary.pivot(index=["object", row] if row else ["object"], columns="planner", values=measure)
    for baseline in BASELINES:
        both = means[[method, baseline]].dropna() if baseline in means else means.iloc[:0]
        yield baseline, int((both[method] > both[baseline]).sum()), len(both)


def order_sentence(tables, name, row, method, **subset):
    return ", ".join(f"above {BASELINES[baseline]} in {above} of {both}"
                     for baseline, above, both in orders(tables, name, row, method, **subset))


def state_rows(tables):
    """Yields what the hands of Table 1 are like, per method, over all rows."""
    details = tables.table("table1.details")
    cells = tables.table("table1")
    keys = ["object", "size", "run", "planner"]
    grasps = details.merge(cells[[*keys, "clip_thickness_m", "voxel_size_m"]], on=keys)
    for method in METHODS:
        own = grasps[grasps["planner"] == method]
        attempts = cells[cells["planner"] == method]["attempts"].sum()
        rejected = cells[cells["planner"] == method]["attempts_rejected"].sum()
        distance = own["target_distance_mean"].mean()
        yield (f"| {method} | {len(own)} | {percent(len(own) / attempts)} | {percent(rejected / attempts)} "
               f"| {digits(own['area_share_median'].median())} | {digits((own['gap_median_m'] / own['clip_thickness_m']).median())} "
               f"| {digits(own['d_min_voxels'].min())} | {1000 * own['penetration'].mean():.1f} | {1000 * own['penetration'].max():.1f} "
               f"| {digits((own['penetration'] / own['voxel_size_m']).max())} | {'–' if pandas.isna(distance) else f'{1000 * distance:.1f}'} |")


HEADLINE_SUBSET = {"objects": ("bowling_ball", "max_planck", "kitten"), "seconds": ("0.15", "0.20")}


def table1(tables):
    yield from method_rows(tables, "table1", "size", quality)
    yield from method_rows(tables, "table1", "size", lambda row: digits(row["m_per_attempt"]))
    yield from state_rows(tables)
    yield f"With rejection by deviation, as in its settings, fitting is {order_sentence(tables, 'table1', 'size', HEADLINE)} rows"
    yield f"without rejection {order_sentence(tables, 'table1', 'size', 'fitting')}"
    yield f"with rejection by M, which selects what is averaged, {order_sentence(tables, 'table1', 'size', 'fitting-reject-m')}"
    yield ("For ball, Max Planck and kitten at 0.15 and 0.20 m it is "
           + order_sentence(tables, "table1", "size", HEADLINE, **HEADLINE_SUBSET))
    yield f"Per attempt fitting without rejection is {order_sentence(tables, 'table1', 'size', 'fitting', measure='m_per_attempt')}"
    ma = tables.table("table1.details")[lambda grasps: grasps["planner"] == AS_PUBLISHED]
    yield f"{percent((ma['d_min_voxels'] < 0).mean())} of its grasps have links in full voxels"


def table1_readings(tables):
    yield from method_rows(tables, "table1_readings", "reading", quality)
    for reading in ("7dof", "recommended"):
        yield f"`{reading}` {order_sentence(tables, 'table1_readings', 'reading', HEADLINE, seconds=(reading,))}"


def table1_refined(tables):
    yield from method_rows(tables, "table1_refined", "size", quality)
    yield f"fitting with rejection by deviation is {order_sentence(tables, 'table1_refined', 'size', HEADLINE)} rows"


def table1_all_objects(tables):
    yield from method_rows(tables, "table1_all_objects", None, quality)
    yield f"fitting with rejection by deviation is {order_sentence(tables, 'table1_all_objects', None, HEADLINE)} objects"
    yield f"without rejection {order_sentence(tables, 'table1_all_objects', None, 'fitting')}"
    yield f"per attempt it is {order_sentence(tables, 'table1_all_objects', None, 'fitting', measure='m_per_attempt')}"


# These functions are about the special cases.


def seeds_of(tables, case):
    """Returns, as "17 of 20", how many seeds of a case have a best grasp as the paper shows it."""
    rows = tables.table("special_cases")
    rows = rows[rows["case"] == case]
    return f"{int((rows['satisfied'] == True).sum())} of {len(rows)}"  # noqa: E712


def special_cases(tables):
    rows = tables.table("special_cases")
    for case, group in rows.groupby("case", sort=False):
        share = group["satisfying_grasps"].sum() / group["grasps"].sum()
        yield (f"| `{case}` | {seeds_of(tables, case)} | {percent(group['valid'].sum() / group['attempts'].sum())} "
               f"| {percent(share)} |")
    for case, width in (("bunny_9cm", 9), ("bunny_15cm", 15), ("bunny_30cm", 30)):
        group = rows[rows["case"] == case]
        best = [group[f"best_m_{mode}"] for mode in ("pinch", "grip", "power")]
        cells = " | ".join(f"{digits(values.mean())} ({values.notna().sum()})" for values in best)
        yield f"| {width} cm | {cells} |"


def force_closure(tables):
    rows = tables.table("force_closure").merge(tables.table("force_closure.timing")[["grip", "grasps_cpu_s", "prepare_s"]], on="grip")
    rows["closed"] = (rows["closed_share"] * rows["grasps"]).round().astype(int)
    for row in rows.itertuples():
        yield (f"| `{row.grip}` | {row.attempts} | {row.grasps} | {percent(row.closed_share)} "
               f"| {max(row.median_epsilon, 0.0):.3f} | {row.grasps_cpu_s / row.closed:.2f} |")
    reach = rows.set_index("grip").loc["auto_reach"]
    yield (f"{reach['grasps_cpu_s'] / reach['closed']:.2f} s of processor time per closed grasp, {reach['grasps_cpu_s']:.2f} s for "
           f"{reach['closed']} in {reach['attempts']} attempts")
    yield f"preparing the object took {reach['prepare_s']:.2f} s"


#: What is known of a candidate before it is fitted, as columns of candidate_prediction end.
PREDICTORS = ("targets", "posture", "reach")
#: Stages of an attempt, as columns of the timings and in words.
STAGES = {
    "targets_s": "target contacts took", "fitting_s": "the adjustment loop", "refinement_s": "refinement",
    "measure_s": "contacts, measures and exact tests", "pre_grasp_s": "ways in and squeezes",
}
#: Ends of the classes of distances between contacts and their targets [m].
NEARNESS = (0.008, 0.015, 0.030)


def median_and_range(values, form):
    """Returns a median, in brackets smallest and largest, each as `form` writes it, without a zero's sign."""
    middle, least, most = (format(round(value, 4) + 0.0, form) for value in (values.median(), values.min(), values.max()))
    return f"{middle} ({least} to {most})"


def candidate_rows(cells):
    """Yields a row per hand, size and object, and one of all cells: medians and ranges over cells."""
    groups = [("all", cells)]
    for axis in ("hand", "size", "object"):
        groups += [(str(value).replace("_", " "), group) for value, group in cells.groupby(axis, sort=False)]
    for name, group in groups:
        correlations = " | ".join(median_and_range(group[f"rank_correlation_by_{by}"], ".2f") for by in PREDICTORS)
        yield (f"| {name} | {median_and_range(group['valid'], 'g')} | {median_and_range(group['closed'], 'g')} "
               f"| {median_and_range(1000 * group['distance'], '.1f')} | {median_and_range(100 * group['reach_square_share'], '.1f')} | {correlations} |")


def candidate_prediction(tables):
    keys = ["object", "size", "hand"]
    details = tables.table("candidate_prediction.details")
    valid = details[details["closed"].notna()]
    cells = tables.table("candidate_prediction").merge(
        valid.groupby(keys)["target_distance_m"].median().rename("distance").reset_index(), on=keys)
    manifest = json.loads((tables.folder / "candidate_prediction.manifest.json").read_text(encoding="utf-8"))
    yield f"the program is {manifest['commit'][:7]}"
    attempts, candidates = cells["attempts"].unique().item(), cells["candidates"].unique().item()
    yield (f"{len(cells)} cells of {attempts} attempts, each of which fits {candidates // attempts} candidates: {len(details)} in all, "
           f"of which {len(valid)} are valid and {int(valid['closed'].sum())} close")
    yield from candidate_rows(cells)

    with_both = cells[[f"auc_by_{by}" for by in PREDICTORS]].dropna()
    yield ("{:.2f} for targets, {:.2f} for posture, {:.2f} for reach".format(*with_both.median())
           + f" in the median of the {len(with_both)} cells with both kinds")
    shares = [percent(cells[f"best_quarter_closed_by_{by}"].mean()) for by in PREDICTORS]
    yield "{}, {} and {} close in the quarter that is best by each".format(*shares) + f", {percent(valid['closed'].sum() / len(details))} of all"
    by_hand = 1000 * valid.groupby("hand")["target_distance_m"].median()
    yield f"{1000 * valid['target_distance_m'].median():.0f} mm in the median ({by_hand.min():.0f} to {by_hand.max():.0f} mm by hand)"
    classes = valid.groupby(numpy.digitize(valid["target_distance_m"], NEARNESS))
    ranks = [round(group["targets_epsilon"].corr(group["epsilon"], method="spearman"), 2) + 0.0 for _, group in classes]
    closures = [percent(group["closed"].mean()) for _, group in classes]
    ends = [f"{1000 * end:.0f} mm" for end in NEARNESS]
    yield (f"is {ranks[0]:.2f} where contacts are less than {ends[0]} from them ({len(classes.get_group(0))} candidates, {closures[0]} closed), "
           f"{ranks[1]:.2f} up to {ends[1]}, {ranks[2]:.2f} up to {ends[2]} and {ranks[3]:.2f} beyond ({closures[3]} closed)")

    sides = cells["reach_sides"].unique().item()
    square = cells["reach_square_share"] * sides
    yield (f"{square.sum():.0f} of {sides * len(cells)} are reached squarely, none in {(square == 0).sum()} of {len(cells)} cells")
    yield f"{square[cells['hand'] == 'human'].sum():.0f} by the human hand, {square[cells['hand'] == 'barrett'].sum():.0f} by the Barrett hand"
    yield (f"misses by {1000 * cells['reach_median_miss_m'].median():.1f} mm and leans by "
           f"{numpy.degrees(cells['reach_median_lean_rad'].median()):.0f}°")

    timing = tables.table("candidate_prediction.timing")
    total = timing["plan_s"].sum()
    shares = {stage: timing[stage].sum() / total for stage in STAGES}
    yield (f"Of the {total:.0f} s that the planner took, " + ", ".join(f"{words} {100 * shares[stage]:.1f} %" for stage, words in STAGES.items()))
    yield f"The other {100 * (1 - sum(shares.values())):.1f} %"
    loop = timing.groupby("size", sort=False)[["fitting_s", "plan_s"]].sum()
    loop = (100 * loop["fitting_s"] / loop["plan_s"]).round()
    yield f"the loop's share falls from {loop.iloc[0]:.0f} % at 0.08 m to {loop.iloc[-1]:.0f} % at 0.20 m"


def reach_grasps(tables):
    table = tables.table("reach_grasps")
    table["closed"] = (table["force_closed_share"] * table["grasps"]).round().astype(int)
    yield (f"{table['closed'].sum()} of {table['grasps'].sum()} valid grasps close, found in {table['attempts'].sum()} attempts; at least 80 % "
           f"in {(table['force_closed_share'] >= 0.8 - 1e-9).sum()} of {len(table)} cells")
    yield (f"{table['palm_grasps'].sum()} press on the palm, {table['behind_tip_grasps'].sum()} with pads behind fingertips")
    yield f"{table['num_penetrating'].sum()} grasps penetrate, no contact is farther than {1000 * table['largest_gap_m'].max():.1f} mm from the surface"
    bunny = table[table["object"] == "bunny"]
    closed, attempts, grasps = bunny["closed"].sum(), bunny["attempts"].sum(), bunny["grasps"].sum()
    yield (f"In the {len(bunny)} cells of the bunny {percent(closed / attempts)} of the attempts end with a closed grasp ({closed} of {attempts}), and "
           f"{percent(closed / grasps)} of the valid grasps close ({closed} of {grasps})")
    timed = table.merge(tables.table("reach_grasps.timing")[["object", "size", "hand", "plan_s"]], on=["object", "size", "hand"])
    for hand, group in timed.groupby("hand", sort=False):
        closed, attempts = group["closed"].sum(), group["attempts"].sum()
        yield (f"| {hand} | {closed} ({attempts}) | {percent(closed / attempts)} | {group['median_epsilon'].median():.3f} "
               f"| {1000 * group['median_target_distance_m'].median():.1f} | {1000 * group['plan_s'].sum() / closed:.0f} |")
    for (name, hand), group in table.groupby(["object", "hand"], sort=False):
        cells = " | ".join(f"{row.closed} ({row.attempts}), {1000 * row.median_target_distance_m:.1f}, {max(row.median_epsilon, 0.0):.3f}"
                           for row in group.itertuples())
        yield f"| {name} | {hand} | {cells} |"


def table_tidying(tables):
    paper = tables.table("table_tidying").set_index("scene").loc["paper"]
    moves = tables.table("table_tidying.details")[lambda rows: rows["scene"] == "paper"]
    yield (f"{int(paper['at_goal'])} of {int(paper['objects'])} objects reach their goals in {int(paper['moves'])} moves, in the paper's order "
           f"({paper['order'].replace('_', ' ')})")
    yield (f"mean M {paper['mean_m']:.2f}, smallest {paper['least_m']:.2f} ({moves.loc[moves['grasp_m'].idxmin(), 'object'].replace('_', ' ')})")
    yield f"{int(paper['overlaps'])} overlaps on {int(paper['frames'])} frames"
    yield (f"{1000 * paper['hand_clearance_m']:.1f} mm from hand and {1000 * paper['object_clearance_m']:.1f} mm from object to anything else at the nearest")


# These functions are about the paper's figures, tables and claims, row by row.


def terms_of_voxels(tables):
    """Yields C_d and C_a of the voxels that the figure chooses (Fig. 8)."""
    from score_terms import PLACES, representative
    from voxel_data import Voxels

    rows = {}
    for kind, (name, _) in PLACES.items():
        voxels = Voxels(tables.source, name)
        rows[kind] = voxels.partial.loc[representative(kind, voxels)]
    distances = ", ".join(f"{rows[kind]['plane_distance_voxels']:.2f} ({kind})" for kind in PLACES)
    angles = ", ".join(f"{rows[kind]['normal_angle_deg']:.0f}" for kind in PLACES)
    yield f"C_d {distances} voxels; C_a {angles} degrees"


def unselected_squirrel(tables):
    """Yields the extremes of the first grasps of the squirrel (Figs. 5 and 11)."""
    from contact_triangles import by_shape
    from good_and_bad_grasp import largest_miss

    record = tables.source.grasp_file("paper_grasps", "squirrel_sets")
    grasps = record["grasps"]
    worst, best = (grasps[index]["m3"] for index in by_shape(record))
    yield f"M3 {worst:.2f} against {best:.2f}"
    bad, good = max(grasps, key=largest_miss), min(grasps, key=largest_miss)
    yield (f"farthest contact {1000 * largest_miss(bad):.0f} mm from its target: M {bad['m']:.2f}; "
           f"{1000 * largest_miss(good):.0f} mm: M {good['m']:.2f}")
    rank = numpy.corrcoef(*(pandas.Series(values).rank() for values in
                            ([largest_miss(grasp) for grasp in grasps], [grasp["m"] for grasp in grasps])))[0, 1]
    yield f"rank correlation over the {len(grasps)} grasps {rank:.2f}"


def gallery(tables):
    from object_names import GALLERY

    cells = [f"gallery_{name}" for names in GALLERY.values() for name in names]
    rows = tables.table("paper_grasps").set_index("case").loc[cells]
    cpu = tables.table("paper_grasps.timing").set_index("case").loc[cells, "cpu_s"]
    yield f"{(rows['valid'] > 0).sum()} of {len(rows)} have valid grasps in {rows['attempts'].max()} attempts"
    per_grasp = (cpu / rows["valid"]).replace(numpy.inf, numpy.nan)
    yield f"{per_grasp.median():.2f} s of processor time per valid grasp in the median, {per_grasp.max():.2f} s at most"


#: Grips of contacts_and_time, in words.
GRIPS = {
    "barrett_3": "Barrett with three fingers",
    "barrett_3_palm": "with the palm too",
    "human_5": "human hand with five fingers",
}
LEAST_GRASPS = 5  # The page gives no mean of fewer grasps.


def means_by_contacts(tables):
    """Yields mean M by the number of contacts, where there are enough grasps (Fig. 13)."""
    details = tables.table("contacts_and_time.details")
    for grip, words in GRIPS.items():
        means = details[details["grip"] == grip].groupby("num_contacts")["m"].agg(["mean", "count"])
        means = means[means["count"] >= LEAST_GRASPS]
        yield f"{words} " + ", ".join(f"{row['mean']:.2f} at N' {count}" for count, row in means.iterrows())
    barrett = details[details["grip"].isin(("barrett_3", "barrett_3_palm"))]
    most = barrett[barrett["num_contacts"] >= 6].groupby("num_contacts")["m"].agg(["mean", "count"])
    yield "six and seven contacts of the Barrett hand: " + ", ".join(
        f"{row['mean']:.2f} at N' {count} ({int(row['count'])} grasps)" for count, row in most.iterrows())
    yield f"{len(details)} usable grasps"


def times_by_contacts(tables):
    """Yields the processor time per valid grasp by grip, failures included (Fig. 13)."""
    rows = tables.table("planner_paper_objects")
    rows = rows.merge(tables.table("planner_paper_objects.timing")[["object", "grip", "cpu_s"]], on=["object", "grip"])
    rows = rows[rows["status"] == "ok"]
    times = {grip: group["cpu_s"].sum() / group["valid"].sum() for grip, group in rows.groupby("grip")}
    yield (f"processor time per valid grasp: {times['barrett_3']:.2f} s with three Barrett fingers, "
           f"{times['barrett_power']:.2f} s with the palm too; human hand {times['human_3']:.2f} s with three, {times['human_5']:.2f} s with five")


def branches_and_frames(tables):
    """Yields the objects on which the paper's method fails, by number of contacts asked for
    (Fig. 21)."""
    rows = tables.table("planner_paper_objects")
    names = {"barrett_3": "Barrett, three", "human_3": "human hand, three", "barrett_power": "Barrett with the palm", "human_5": "human hand, five"}
    for name in ("octopus", "cage"):
        shares = []
        for grip, words in names.items():
            of_grip = rows[rows["grip"] == grip]
            own = of_grip[of_grip["object"] == name].iloc[0]
            shares.append(f"{words} {percent(own['valid_rate'])} ({percent(of_grip['valid_rate'].median())})")
        yield f"of the attempts at the {name} valid, in brackets the median of all objects: {', '.join(shares)}"


def works_for(tables):
    rows = tables.table("planner_paper_objects")
    fitting = rows[rows["status"] == "ok"]
    yield f"{(fitting['valid'] > 0).sum()} of {len(fitting)} pairs of object and grip that fit have valid grasps"


def table1_times(tables):
    timing = tables.table("table1.timing").merge(
        tables.table("table1")[["object", "size", "run", "planner", "grasps"]].rename(columns={"grasps": "found"}),
        on=["object", "size", "run", "planner"])
    own = timing[timing["planner"].isin((HEADLINE, "fitting"))]["per_found_grasp_s"]
    others = timing[timing["planner"].isin(BASELINES)]["per_found_grasp_s"]
    yield (f"{own.min():.2f} to {own.max():.2f} s for fitting (median {own.median():.2f}), "
           f"{others.min():.2f} to {others.max():.2f} s for the others (median {others.median():.2f})")


def claims(tables):
    voxels = tables.table("object_voxels").set_index("object")
    measured = tables.table("measured_contacts").set_index("set")["m"]
    stages = tables.table("fitting_stages").set_index("object")
    yield f"{100 * voxels.loc['horse', 'weak_share']:.1f} % of the horse's voxels are fragile"
    yield (f"M falls from {measured['good']:.2f} to {measured['fragile_part']:.2f} (fragile), {measured['finger_edge']:.2f} (edge), "
           f"{measured['no_stable_pair']:.0f} (no pair); the irregular triangle keeps {measured['irregular']:.2f}")
    yield f"{voxels.loc['squirrel', 'partial']} partial voxels"
    yield f"{percent(voxels.loc['squirrel', 'eligible_share'])} pass the threshold"
    yield from terms_of_voxels(tables)
    yield from unselected_squirrel(tables)
    yield f"contacts lie {1000 * stages.loc['squirrel', 'mean_target_distance_m']:.0f} mm from their targets on average"
    yield f"four or more in {seeds_of(tables, 'mug_four_contacts')} seeds"
    yield from gallery(tables)
    yield f"at 30 cm the best grasp has six or more in {seeds_of(tables, 'teddy_six_contacts')} seeds"
    yield from means_by_contacts(tables)
    yield from times_by_contacts(tables)
    yield "from the top, the side and the front {}, {} and {} seeds".format(
        *(seeds_of(tables, f"squirrel_from_{side}") for side in ("top", "side", "front")))
    yield "pinch, three fingers and power come out in {}, {} and {} seeds".format(
        *(seeds_of(tables, f"bunny_{width}cm") for width in (9, 15, 30)))
    yield "as shown in {} and {} seeds".format(*(seeds_of(tables, f"torus_{width}cm") for width in (7, 16)))
    yield "every finger asked for touches in {}, {}, {} and {} seeds".format(
        *(seeds_of(tables, f"ball_{mode}") for mode in ("pinch_2", "grip_3", "power_4", "power_5")))
    yield f"With rejection by deviation, as in its settings, fitting is {order_sentence(tables, 'table1', 'size', HEADLINE)} rows"
    yield from table1_times(tables)
    paper = tables.table("table_tidying").set_index("scene").loc["paper"]
    yield f"{int(paper['at_goal'])} of {int(paper['objects'])} at their goals, {int(paper['overlaps'])} overlaps on {int(paper['frames'])} frames"
    yield from branches_and_frames(tables)
    yield "{} seeds with the score asked of contacts too, {} with far contacts rejected instead".format(
        *(seeds_of(tables, case) for case in ("horse_legs", "horse_legs_rejection")))
    yield f"{seeds_of(tables, 'shark_fins')} seeds with the human hand"
    yield from works_for(tables)


def made_by(tables):
    """Yields which commit's program made which table."""
    made = {}
    for path in sorted(tables.folder.glob("*.manifest.json")):
        made.setdefault(json.loads(path.read_text(encoding="utf-8"))["commit"][:7], []).append(path.name.split(".")[0])
    for commit, slugs in sorted(made.items(), key=lambda item: item[1]):
        yield f"| {commit} | {', '.join(f'`{slug}`' for slug in slugs)} |"
