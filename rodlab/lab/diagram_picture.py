"""A whole bifurcation diagram as one picture: every branch with its index, mirror images beside it, special points marked."""

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rodlab.analysis.diagram import Diagram
from rodlab.lab.picture import DASHES, LABELS, curve, figure

ODD = ("tip_angle",)  # measures that change sign in the mirror


def diagram_picture(d: Diagram, measure: str = "tip_angle", label: str = r"load $\lambda$") -> Figure:
    """A measure against the load: black what is connected to the start, grey what is not; the index in a circle."""
    fig, axes = figure(7.4, 5.0)
    low, high = d.window
    for i, branch in enumerate(d.branches):
        style = {"color": "k" if d.components[i] == 0 else "0.5", "lw": 1.4}
        for side in (1, -1) if d.copies[i] > 1 and measure in ODD else (1,):
            curve(axes, branch, measure, high, side=side, label_at=0.6 if side == 1 else None, **style)
    axes.margins(y=0.08)
    axes.set_xlim(low, high)
    axes.set_xlabel(label)
    axes.set_ylabel(LABELS.get(measure, measure))
    handles = [
        Line2D([], [], color="k", lw=1.4, label="stable"),
        Line2D([], [], color="k", lw=1.4, ls=DASHES, label="unstable"),
        Line2D([], [], color="k", marker="o", mfc="w", ls="none", ms=5, label="branch point"),
        Line2D([], [], color="k", marker="s", ls="none", ms=4, label="fold"),
        Line2D([], [], color="k", marker=r"$\bigcirc$", mew=0.2, ls="none", ms=8, label="index"),
    ]
    if any(d.components):
        handles.append(Line2D([], [], color="0.5", lw=1.4, label="not connected"))
    fig.legend(handles=handles, fontsize=8, frameon=False, ncols=len(handles), loc="outside upper center")
    return fig
