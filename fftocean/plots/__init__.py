"""
Plots of a sea: its specified spectrum, the spectrum a tile realises, and the dispersion relation.

Each function returns a `matplotlib.figure.Figure` that is not registered with pyplot; `save` writes
it. matplotlib comes with the extra `plot`. Artists that carry data have a gid, such as "specified",
by which tests and readers of an SVG find them.
"""

from fftocean.plots.directions import plot_directions as plot_directions
from fftocean.plots.dispersion import plot_dispersion as plot_dispersion
from fftocean.plots.figures import SUFFIXES as SUFFIXES
from fftocean.plots.figures import encoded as encoded
from fftocean.plots.figures import save as save
from fftocean.plots.realised import plot_delivered as plot_delivered
from fftocean.plots.realised import plot_realised as plot_realised
from fftocean.plots.sheet import plot_job as plot_job
from fftocean.plots.spectrum import plot_spectrum as plot_spectrum
from fftocean.plots.theme import style as style

__all__ = [
    "SUFFIXES",
    "encoded",
    "plot_delivered",
    "plot_directions",
    "plot_dispersion",
    "plot_job",
    "plot_realised",
    "plot_spectrum",
    "save",
    "style",
]
