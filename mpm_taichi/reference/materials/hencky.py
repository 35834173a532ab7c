"""St. Venant-Kirchhoff solid in logarithmic strain: Hencky (1928), Z. Tech. Phys. 9; Klar et al.
(2016), Drucker-Prager elastoplasticity for sand animation, section 6."""

from .law import MaterialLaw
from .principal import assembled, logarithmic_strains


class Hencky(MaterialLaw):
    """psi = mu sum e_i^2 + lam/2 (sum e_i)^2 with e_i = ln s_i;  tau_i = 2 mu e_i + lam sum e."""

    @staticmethod
    def principal_stress(c, e):
        return 2 * c.mu * e + c.lam * e.sum()

    @staticmethod
    def energy_of(c, e):
        return c.mu * (e**2).sum() + 0.5 * c.lam * e.sum() ** 2

    @staticmethod
    def update(c, H, L, dt, s):
        e, V = logarithmic_strains(H, 0.0)
        return H, s, assembled(Hencky.principal_stress(c, e), V)

    @staticmethod
    def energy_density(c, H, s):
        return Hencky.energy_of(c, logarithmic_strains(H, 0.0)[0])

    @staticmethod
    def out_of_plane_stress(c, H, s):
        return c.lam * logarithmic_strains(H, 0.0)[0].sum()
