"""What all laws have: answers that most laws share."""

from .invariants import volume_strain


class MaterialLaw:
    """A law whose deformation is all stored: nothing flows, nothing is lost."""

    @staticmethod
    def volume_ratio(c, H, s):
        return 1 + volume_strain(H)

    @staticmethod
    def dissipated_energy(c, H, s):
        return 0.0

    @staticmethod
    def plastic_strain(c, H, s):
        return 0.0
