"""Materials by name: the constants of a source, and what they hold for."""

from typing import NamedTuple

from . import (
    DruckerPrager,
    FixedCorotated,
    Fluid,
    Gas,
    Hypoelastic,
    Material,
    NeoHookean,
    Snow,
    VonMises,
)


class Preset(NamedTuple):
    """`source` says where the numbers are from, `remark` where they hold, what they leave out."""

    material: Material
    source: str
    remark: str


PRESETS = {
    "steel": Preset(
        Hypoelastic(type="hypoelastic", density=7850.0, youngs_modulus=200e9, poissons_ratio=0.3),
        source="disk of Sulsky, Zhou and Schreyer (1995), as in Sinaie et al. (2017), section 4.3",
        remark="elastic only: strains up to the yield strain of the steel, about 0.1 %",
    ),
    "mild_steel": Preset(
        VonMises(
            type="von_mises", density=7850.0, youngs_modulus=200e9, poissons_ratio=0.3,
            yield_stress=250e6,
        ),
        source="elastic constants of preset steel; yield stress: least of ASTM A36",
        remark="at rest and slow: the yield stress rises neither with strain nor with its rate",
    ),
    "aluminium_6061_t6": Preset(
        VonMises(
            type="von_mises", density=2700.0, youngs_modulus=78.2e9, poissons_ratio=0.3,
            yield_stress=300e6,
        ),
        source="target of Sulsky, Zhou and Schreyer (1995), as in Sinaie et al. (2017), section "
        "4.3",
        remark="perfectly plastic, at any rate; no equation of state, no fracture",
    ),
    "copper": Preset(
        VonMises(
            type="von_mises", density=8930.0, youngs_modulus=117e9, poissons_ratio=0.35,
            yield_stress=400e6, hardening=100e6,
        ),
        source="classic Taylor bar of Wilkins and Guinan (1973), constants as in Tesserae.jl",
        remark="impact at 227 m/s; no equation of state",
    ),
    "copper_ofhc": Preset(
        VonMises(
            type="von_mises", density=8930.0, youngs_modulus=117e9, poissons_ratio=0.35,
            yield_stress=157e6, hardening=425e6,
        ),
        source="Taylor bar of Johnson and Holmquist (1988), constants as in MPM3D-F90",
        remark="impact at 190 m/s; MPM3D-F90 adds an equation of state",
    ),
    "rubber": Preset(
        NeoHookean(
            type="neo_hookean", density=930.0, youngs_modulus=1.131e6, poissons_ratio=0.45
        ),
        source="natural rubber, shear modulus 0.39 MPa: Treloar (1975), The Physics of Rubber "
        "Elasticity, chapter 5",
        remark="stretches up to 1.5; true Poisson's ratio is 0.4999, lowered for larger time steps",
    ),
    "jelly": Preset(
        FixedCorotated(
            type="fixed_corotated", density=1000.0, youngs_modulus=3e5, poissons_ratio=0.2
        ),
        source="Hu et al. (2018), demo mpm99 of Taichi, where density and modulus are 1000 times "
        "less",
        remark="for pictures: no measurement stands behind it",
    ),
    "snow": Preset(
        Snow(
            type="snow", density=400.0, youngs_modulus=1.4e5, poissons_ratio=0.2,
            critical_compression=0.025, critical_stretch=0.0075, hardening=10.0,
        ),
        source="Stomakhin et al. (2013), table 2",
        remark="smaller critical strains make it powdery, larger chunky; more hardening, icy",
    ),
    "dry_sand": Preset(
        DruckerPrager(
            type="drucker_prager", density=2200.0, youngs_modulus=3.537e5, poissons_ratio=0.3,
            friction_angle=30.0,
        ),
        source="Klar et al. (2016)",
        remark="softer than sand, for larger time steps; in the paper 25 degrees harden to 35",
    ),
    "aluminium_bars": Preset(
        DruckerPrager(
            type="drucker_prager", density=2650.0, youngs_modulus=0.84e6, poissons_ratio=0.3,
            friction_angle=19.8, cone="plane_strain",
        ),
        source="Bui, Fukagawa, Sako and Ohno (2008), column of aluminium bars",
        remark="plane strain: bars are the grains of a two-dimensional soil; slow, dense flow",
    ),
    "water": Preset(
        Fluid(type="fluid", density=998.0, bulk_modulus=2.19e9, viscosity=1.0e-3),
        source="at 20 C: White, Fluid Mechanics, appendix A; exponent 7: Batchelor (1967), 1.8",
        remark="speed of sound 1481 m/s, which makes time steps small; bears no tension",
    ),
    "water_reduced_stiffness": Preset(
        Fluid(type="fluid", density=1000.0, bulk_modulus=2e6, viscosity=1.0e-3),
        source="preset water, its bulk modulus a thousandth: Monaghan (1994), section 2",
        remark="speed of sound 45 m/s: flows of up to 4.5 m/s keep their density to about 1 %",
    ),
    "air": Preset(
        Gas(type="gas", density=1.2, pressure=101325.0),
        source="dry air at 20 C and 1 atm: White, Fluid Mechanics, appendix A",
        remark="specific heats do not change: up to about 600 K; no viscosity but the artificial",
    ),
}  # fmt: skip
