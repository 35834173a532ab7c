"""Transfers: see mpm_taichi/transfers/__init__.py for what a transfer gives."""

from .apic import APIC
from .flip import FLIP
from .mls import MLS
from .pic import PIC

TRANSFERS = (PIC, FLIP, APIC, MLS)
