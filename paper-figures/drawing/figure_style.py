"""How all figures look: colors, sizes, panels with a scale bar, files."""

import io
import math
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.patches import Patch  # noqa: E402

# Okabe and Ito's colors, told apart by most color-blind readers.
ORANGE, SKY, GREEN, YELLOW = "#E69F00", "#56B4E9", "#009E73", "#F0E442"
BLUE, VERMILION, PURPLE, BLACK = "#0072B2", "#D55E00", "#CC79A7", "#000000"
SOFT = "#5f666d"
CYCLE = [BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY, BLACK]
MARKERS = ["o", "s", "^", "D", "v", "P", "X"]
SCORE_MAP = "viridis"  # low scores dark, high ones bright, in gray print as well

plt.rcParams.update(
    {
        "font.family": "DejaVu Sans",
        "font.size": 8,
        "axes.titlesize": 8.5,
        "axes.labelsize": 8,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.prop_cycle": matplotlib.cycler(color=CYCLE),
        "axes.grid": True,
        "grid.color": "#e3e5e8",
        "grid.linewidth": 0.6,
        "axes.axisbelow": True,
        "legend.frameon": False,
        "legend.fontsize": 7.5,
        "lines.linewidth": 1.4,
        "lines.markersize": 4.5,
        "xtick.labelsize": 7.5,
        "ytick.labelsize": 7.5,
        "pdf.fonttype": 42,
        "svg.hashsalt": "graspfit",
    }
)


def page(title, width, height, note=None):
    """An empty figure of so many inches with its title, and a note in small print below."""
    figure = plt.figure(figsize=(width, height))
    figure.suptitle(title, x=0.01, y=1.0 - 0.06 / height, ha="left", va="top", fontsize=9.5, weight="bold")
    if note:
        figure.text(0.01, 0.05 / height, note, fontsize=6.5, color=SOFT, ha="left", va="bottom")
    return figure


def panels(title, rows, columns, width, height, note=None, **options):
    """A page with a grid of axes under the title: figure, axes [rows][columns]."""
    figure = page(title, width, height, note)
    margin = 0.12 + (0.13 * (note.count("\n") + 1) if note else 0.0)
    grid = figure.add_gridspec(
        rows,
        columns,
        left=options.pop("left", 0.01),
        right=options.pop("right", 0.99),
        top=1.0 - options.pop("head", 0.5) / height,
        bottom=(margin + options.pop("foot", 0.0)) / height,
        wspace=options.pop("wspace", 0.05),
        hspace=options.pop("hspace", 0.15),
        **options,
    )
    return figure, [[figure.add_subplot(grid[r, c]) for c in range(columns)] for r in range(rows)]


def round_length(most):
    """The largest of 1, 2, 5 times a power of ten that is not above `most`."""
    power = 10.0 ** math.floor(math.log10(most))
    return next(k * power for k in (5, 2, 1) if k * power <= most * (1 + 1e-9))


def show_picture(axes, picture, title=None, below=None, scale=True):
    """A rendered picture (see grasp_scene.py) without axes, with a scale bar."""
    image, meters_per_pixel = picture
    height, width = image.shape[:2]
    axes.imshow(image, interpolation="antialiased", aspect="equal")
    axes.set_xlim(-0.5, width - 0.5)
    axes.set_ylim(height - 0.5, -0.5)
    axes.set_axis_off()
    if title:
        axes.set_title(title, pad=3)
    if below:
        axes.text(0.5, -0.02, below, transform=axes.transAxes, ha="center", va="top", fontsize=7)
    if scale:
        length = round_length(0.25 * width * meters_per_pixel)
        right, y = 0.97 * width, 0.975 * height
        left = right - length / meters_per_pixel
        axes.plot([left, right], [y, y], color=SOFT, linewidth=1.2, solid_capstyle="butt")
        words = f"{1000 * length:g} mm" if length < 0.01 else f"{100 * length:g} cm"
        axes.text(0.5 * (left + right), y - 0.012 * height, words, ha="center", va="bottom", fontsize=6, color=SOFT)


def color_legend(figure, entries, **placement):
    """Patches with words: [(color, words)]."""
    handles = [Patch(facecolor=color, edgecolor="none", label=words) for color, words in entries]
    figure.legend(handles=handles, ncol=len(entries), handlelength=1.0, handleheight=1.0, **placement)


def file_bytes(figure, suffix):
    """The figure as PNG or PDF, the same bytes for the same figure."""
    buffer = io.BytesIO()
    metadata = {"CreationDate": None} if suffix == ".pdf" else {"Software": None}
    figure.savefig(buffer, format=suffix[1:], dpi=200, metadata=metadata)
    return buffer.getvalue()


def write(figure, folder, slug):
    """<slug>.png and <slug>.pdf, each under a temporary name first."""
    paths = []
    for suffix in (".png", ".pdf"):
        path = folder / f"{slug}{suffix}"
        part = path.with_name(f".{path.name}.{os.getpid()}")
        part.write_bytes(file_bytes(figure, suffix))
        os.replace(part, path)
        paths.append(path)
    plt.close(figure)
    return paths
