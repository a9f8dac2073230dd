"""Frequency spectra S(omega), one family a file."""

from fftocean.physics.spectra.base import SPECTRA as SPECTRA
from fftocean.physics.spectra.base import FrequencySpectrum as FrequencySpectrum
from fftocean.physics.spectra.base import require_spectrum as require_spectrum
from fftocean.physics.spectra.bretschneider import Bretschneider as Bretschneider
from fftocean.physics.spectra.custom import CustomSpectrum as CustomSpectrum
from fftocean.physics.spectra.elfouhaily import Elfouhaily as Elfouhaily
from fftocean.physics.spectra.gamma import GammaSpectrum as GammaSpectrum
from fftocean.physics.spectra.jonswap import JONSWAP as JONSWAP
from fftocean.physics.spectra.jonswap import fetch_limited as fetch_limited
from fftocean.physics.spectra.kitaigorodskii import kitaigorodskii as kitaigorodskii
from fftocean.physics.spectra.ochi_hubble import OchiHubble as OchiHubble
from fftocean.physics.spectra.phillips import Phillips as Phillips
from fftocean.physics.spectra.pierson_moskowitz import FULLY_DEVELOPED_PEAK as FULLY_DEVELOPED_PEAK
from fftocean.physics.spectra.pierson_moskowitz import PiersonMoskowitz as PiersonMoskowitz
from fftocean.physics.spectra.tabulated import TabulatedSpectrum as TabulatedSpectrum
from fftocean.physics.spectra.tma import TMA as TMA
from fftocean.physics.spectra.torsethaugen import Torsethaugen as Torsethaugen
