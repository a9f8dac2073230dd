"""
Directional spreadings D(omega, theta), one family a file.

Each of them integrates to 1 over the circle at every frequency.
"""

from fftocean.physics.spreading.base import SPREADINGS as SPREADINGS
from fftocean.physics.spreading.base import Spreading as Spreading
from fftocean.physics.spreading.base import require_spreading as require_spreading
from fftocean.physics.spreading.base import wrapped as wrapped
from fftocean.physics.spreading.blend import Blend as Blend
from fftocean.physics.spreading.cosine_n import CosineN as CosineN
from fftocean.physics.spreading.cosine_power import CosinePower as CosinePower
from fftocean.physics.spreading.cosine_squared import CosineSquared as CosineSquared
from fftocean.physics.spreading.custom import CustomSpreading as CustomSpreading
from fftocean.physics.spreading.donelan_banner import DonelanBanner as DonelanBanner
from fftocean.physics.spreading.elfouhaily import ElfouhailySpreading as ElfouhailySpreading
from fftocean.physics.spreading.goda_suzuki import GodaSuzuki as GodaSuzuki
from fftocean.physics.spreading.hasselmann import Hasselmann as Hasselmann
from fftocean.physics.spreading.long_crested import LongCrested as LongCrested
from fftocean.physics.spreading.mitsuyasu import Mitsuyasu as Mitsuyasu
from fftocean.physics.spreading.swell import SwellElongation as SwellElongation
from fftocean.physics.spreading.tabulated import TabulatedSpreading as TabulatedSpreading
from fftocean.physics.spreading.wrapped_normal import WrappedNormal as WrappedNormal
