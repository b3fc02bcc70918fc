"""What M1 is made of: distance d from the pad's outline, contact area A, fragile features S."""

import numpy as np
from figure_data import rotation
from figure_style import BLUE, GREEN, ORANGE, SOFT, VERMILION, panels
from voxel_data import Voxels

CELL = "bunny_three_fingers"


def in_pad(point, grasp, pad):
    """A point of frame O in the pad's frame C."""
    for pose in (grasp["X_OL"][pad["link"]], pad["X_LC"]):
        point = rotation(pose["rotation_wxyz"]).T @ (np.asarray(point) - np.asarray(pose["translation_m"]))
    return point


def nearest_on_outline(point, outline):
    """The point of a polygon's border nearest to a point inside."""
    best = None
    for a, b in zip(outline, np.roll(outline, -1, axis=0)):
        along = np.clip((point - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        at = a + along * (b - a)
        if best is None or np.linalg.norm(point - at) < np.linalg.norm(point - best):
            best = at
    return best


def draw_pad(ax, contact, grasp, pad):
    outline = 1000 * np.asarray(pad["outline_C_m"])
    ax.fill(*outline.T, color="#e4e8ec")
    ax.plot(*np.vstack([outline, outline[:1]]).T, color=SOFT, linewidth=1.0)
    point = 1000 * in_pad(contact["point_O_m"], grasp, pad)[:2]
    border = nearest_on_outline(point, outline)
    ax.plot(*np.array([point, border]).T, color=BLUE, linewidth=1.6)
    ax.plot(*point, "o", color=VERMILION)
    ax.set_aspect("equal")
    ax.set_xlim(-35, 35)
    ax.set_ylim(-35, 35)
    words = contact["pad"].removesuffix("_pad").replace("_", " ")
    ax.set_title(f"{words}\nd = {1000 * contact['pad_boundary_distance_m']:.1f} mm", fontsize=7.5)
    ax.set_xlabel("in the pad [mm]", labelpad=1)
    ax.tick_params(labelsize=6)


def draw(source):
    record = source.grasp_file("paper_grasps", CELL)
    grasp = record["grasps"][0]
    pads = {pad["name"]: pad for pad in record["hand"]["pads"]}
    shown = [(c, t) for c, t in zip(grasp["contacts"], grasp["sustainability_terms"])
             if len(pads[c["pad"]]["outline_C_m"]) and c["finger"] != "palm"][:3]  # fmt: skip
    horse = Voxels(source, "horse")
    figure, axes = panels(
        "What M1 adds up: (d + 2 A) S per contact", 1, 5, 10.4, 3.2,
        "Left: contacts of a Barrett grasp of the BUNNY on their pads; d (blue) to the outline. Middle: d and A as shares of the pad's largest.\n"
        "Right: partial voxels of the HORSE (15 cm); contacts on fragile ones (orange, thinner than 6 mm on a single neck) have S = 0.",
        left=0.045, right=0.99, head=0.78, foot=0.36, wspace=0.36, width_ratios=(1, 1, 1, 1.15, 1.5),
    )  # fmt: skip
    for ax, (contact, _) in zip(axes[0], shown):
        draw_pad(ax, contact, grasp, pads[contact["pad"]])
    for ax in axes[0][len(shown) : 3]:
        ax.set_axis_off()
    bars, side = axes[0][3], axes[0][4]
    x = np.arange(len(shown))
    bars.bar(x - 0.2, [t["boundary_distance"] for _, t in shown], width=0.38, color=BLUE, label="d")
    bars.bar(x + 0.2, [t["area"] for _, t in shown], width=0.38, color=GREEN, label="A")
    bars.set_xticks(x, [c["pad"].removesuffix("_pad").replace("_", "\n") for c, _ in shown])
    bars.set_ylim(0, 1)
    bars.set_title(f"shares; M1 = {grasp['m1']:.2f} over {len(grasp['contacts'])} contacts", fontsize=7.5)
    bars.legend(loc="upper right")
    bars.grid(axis="x", visible=False)
    part = horse.partial
    weak = part["weak"].astype(str).str.lower() == "true"
    for rows, color, words in ((part[~weak], "#9aa7b3", "sound"), (part[weak], ORANGE, f"fragile ({weak.mean():.0%})")):
        side.plot(100 * rows["centroid_z_m"], 100 * rows["centroid_y_m"], "s", markersize=1.9, color=color, label=words)
    side.set_aspect("equal")
    side.set_xlabel("z [cm]", labelpad=1)
    side.set_ylabel("y [cm]", labelpad=0)
    side.legend(loc="upper left", markerscale=2.5, bbox_to_anchor=(-0.03, 1.19), ncol=2, handletextpad=0.1)
    return figure
