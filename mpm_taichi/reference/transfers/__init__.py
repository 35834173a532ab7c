"""Transfers: see mpm_taichi/transfers/__init__.py for what a transfer gives."""

from .apic import APIC
from .flip import FLIP
from .flip_blend import FLIPBlend
from .mls import MLS
from .pic import PIC
from .tpic import TPIC
from .xpic import XPIC

TRANSFERS = (PIC, FLIP, FLIPBlend, XPIC, APIC, TPIC, MLS)
