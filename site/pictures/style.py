"""How the pictures of the site look. Text and axes have a colour that write() turns into the page's own, so that one file
serves light and dark pages; curves have colours that stand out on both."""

import pathlib
import re

import matplotlib
import matplotlib.pyplot as plt

# Okabe and Ito, "Color universal design", 2008, without the darkest.
VERMILLION, GREEN, SKY, ORANGE, PURPLE = "#D55E00", "#009E73", "#56B4E9", "#E69F00", "#CC79A7"
GREY = "#808890"
TEXT = "#010203"  # stands for the page's colour of text


def use() -> None:
    matplotlib.use("Agg")
    plt.rcParams.update(
        {
            "svg.fonttype": "none",
            "font.family": "sans-serif",
            "font.size": 10,
            "axes.titlesize": 10,
            "axes.titlelocation": "left",
            "text.color": TEXT,
            "axes.labelcolor": TEXT,
            "axes.edgecolor": GREY,
            "axes.titlecolor": TEXT,
            "xtick.color": GREY,
            "ytick.color": GREY,
            "xtick.labelcolor": TEXT,
            "ytick.labelcolor": TEXT,
            "axes.facecolor": "none",
            "figure.facecolor": "none",
            "axes.spines.top": False,
            "axes.spines.right": False,
            "grid.color": GREY,
            "grid.alpha": 0.25,
            "legend.frameon": False,
            "lines.linewidth": 1.6,
        }
    )


def write(figure: plt.Figure, path: pathlib.Path) -> None:
    plt.rcParams["svg.hashsalt"] = path.stem  # names inside differ between pictures of one page, and not between builds
    figure.savefig(
        path, transparent=True, bbox_inches="tight", pad_inches=0.05, metadata={"Date": None, "Creator": None}
    )
    plt.close(figure)
    text = path.read_text(encoding="utf-8").replace(TEXT, "currentColor")
    text = re.sub(
        r'(<svg [^>]*?)width="[\d.]+pt" height="[\d.]+pt"', r"\1", text, count=1
    )  # as wide as the page lets it be
    text = re.sub(r"font: ([^;\"]*?)'?[\w -]*'?, ?[^;\"]*sans-serif", r"font: \1 system-ui, sans-serif", text)
    path.write_text(text[text.index("<svg") :], encoding="utf-8")
