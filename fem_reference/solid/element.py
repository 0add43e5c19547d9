"""Twenty-seven-node brick with assumed strains and a projected change of volume.

Covariant Green–Lagrange strains E_ab = ½ (x,a · x,b − X,a · X,b) are sampled and interpolated in the plane
(ξ, η) and not changed through the thickness (ζ, three Gauss points), MITC9 in every layer:

    ξξ, ξζ at 2 × 3      ηη, ηζ at 3 × 2      ξη at 2 × 2      ζζ at 3 × 3 Gauss points,

so that neither membrane nor transverse shear locks in a thin sheet. ξη is taken at 3 × 3 points and
projected on the bilinear functions of the 2 × 2; in a distorted brick that changes the mean of the Cartesian
strain, which the patch test requires, and the difference is added back, level by level. Constant strains
are exact in any brick with straight edges.

The 2 × 2 points miss the shear of a motion along η that goes like P₂(η) and varies along ξ, but the
stress along ξ, at 2 × 3, does: in a brick b ≫ l, with l along ξ, only the stretch along η holds it, and a
compression −ε along ξ outweighs that where ε (b/l)² > 5 or so (measured), though no sheet would buckle. So
bricks much longer than wide keep a share α of the dropped shear, α² = `RETAINED_SHEAR`² − 2.5 (l/b)²: stable
while ε < α²/2(1 + ν). All of it would lock the thin twisted sheet, and near-square bricks need none.

The k = 126 samples are quadratic forms of the positions, e_k = ½ (x H_k x − X H_k X), with equal H_k in all
elements, and B_k = H_k x.

The volumetric energy is ½ Λ (π ϑ)² with π the projection on {1, ξ, η} ⊗ {1, ζ}, element by element: the
pressure Λ π ϑ of a perturbed Lagrangian, condensed. As ν → ½ a pointwise ϑ locks; the L² projection
is the one of Q2/P−1, with ζ ξ and ζ η added because in bending the pressure is odd in ζ and varies along the
sheet. It is a function of strain only, so that the laws keep their form and the tangent is symmetric.
Sources: Bucalem & Bathe (1993) for the tying; Sussman & Bathe (1987) for the projection.
"""

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Self

import numpy as np
from scipy.linalg import block_diag
from skfem import ElementHex2
from skfem.quadrature import get_quadrature
from skfem.refdom import RefHex

from fem_reference.solid.materials import SolidLaw
from fem_reference.surface.biquadratic import IN_SPACE, THREE, TYING, lagrange, pulled_back
from fem_reference.surface.materials import green, stretched
from sheetbench.numerics.cache import frozen
from sheetbench.scenes import Constants, Material, Scene
from sheetbench.scenes.meaning.natural_state import NaturalState, natural_at

NODES = 27
RETAINED_SHEAR = 0.3  # largest share of the dropped shear: bent strips are stable to strains of 0.045 (ν = 0)
# For the covariant components ξξ, ηη, ζζ, ξη, ηζ, ξζ (the order of IN_SPACE): points of [−1, 1]² between
# which the strain is interpolated (_TYING), and at which it is sampled (_SITES).
_EVERY = (THREE, THREE)
_TYING = (TYING["rr"], TYING["ss"], _EVERY, TYING["rs"], TYING["ss"], TYING["rr"])
_SITES = (*_TYING[:3], _EVERY, *_TYING[4:])
SAMPLED = [[[x, y, z] for x in sites[0] for y in sites[1] for z in THREE] for sites in _SITES]


def shape(local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return triquadratic shape functions (27, n) and gradients (27, 3, n) at local coordinates (3, n)."""
    element = ElementHex2()
    values = [element.lbasis(local, a) for a in range(NODES)]
    return np.array([v[0] for v in values]), np.array([np.array(v[1]) for v in values])


@dataclass(frozen=True)
class Reference:
    """Arrays that all elements share. points: (3, q) Gauss points, q = 27; weights: (q,); forms: H (k, 27,
    27); assumed, omitted: (q, 6, k) covariant strains at Gauss points, engineering shears, from the samples:
    the part that interpolation keeps and the part that it drops; levels: (q, q) 1 where two points are of one
    height; modes: (q, 6) of the projection."""

    points: np.ndarray
    weights: np.ndarray
    forms: np.ndarray
    assumed: np.ndarray
    omitted: np.ndarray
    levels: np.ndarray
    modes: np.ndarray


@lru_cache(maxsize=1)
def reference() -> Reference:
    """Return sampling points, forms and interpolation on the reference brick 0 ≤ ξ, η, ζ ≤ 1."""
    points, weights = get_quadrature(RefHex, 5)
    x, y, z = 2.0 * points - 1.0
    forms, kept, dropped = [], [], []
    for (a, b), tying, sites, sampled in zip(IN_SPACE, _TYING, _SITES, SAMPLED, strict=True):
        _, slope = shape((np.array(sampled).T + 1.0) / 2.0)
        form = np.einsum("it,jt->tij", slope[:, a], slope[:, b])
        forms.append(0.5 * (form + form.swapaxes(1, 2)) * (1.0 if a == b else 2.0))
        axes = [*zip(tying, sites, (x, y), strict=True), (THREE, THREE, z)]
        kept.append(_product([lagrange(tie, at) @ lagrange(site, tie) for tie, site, at in axes]))
        dropped.append(_product([lagrange(site, at) for _, site, at in axes]) - kept[-1])
    modes = np.array([np.ones_like(x), x, y, z, z * x, z * y]).T
    levels = np.isclose(points[2][:, None], points[2]).astype(float)
    assumed, omitted = (  # (q, 6, k): the weights of a component act on its own samples
        np.array([block_diag(*(w[[q]] for w in of_components)) for q in range(len(weights))])
        for of_components in (kept, dropped)
    )
    return frozen(Reference(points, weights, np.concatenate(forms), assumed, omitted, levels, modes))


@dataclass(frozen=True)
class Bricks:
    """m elements of one material, or of constants (m, 1) of their own. positions: X (m, 27, 3) [m].
    to_strain: (m, q, 6, k) Cartesian strain of the samples; volumes: (m, q) [m³]."""

    positions: np.ndarray
    law: SolidLaw
    material: Material | Constants
    to_strain: np.ndarray
    volumes: np.ndarray

    @classmethod
    def build(cls, positions: np.ndarray, law: SolidLaw, material: Material | Constants) -> Self:
        """Return elements with nodes at positions (m, 27, 3), in scikit-fem's order of `ElementHex2`."""
        ref = reference()
        _, slope = shape(ref.points)
        jacobian = np.einsum("eac,abq->eqcb", positions, slope)  # X_c,ξ_b
        volumes = ref.weights * np.abs(np.linalg.det(jacobian))
        pull_back = pulled_back(np.linalg.inv(jacobian), IN_SPACE)
        share = volumes[:, None, :] * ref.levels / (volumes @ ref.levels)[:, :, None]
        retained = _retained_share(jacobian)[:, None, None, None]
        omitted = pull_back @ ref.omitted
        to_strain = pull_back @ ref.assumed + retained * omitted
        to_strain += np.einsum("eqp,epik->eqik", share, (1.0 - retained) * omitted, optimize=True)
        return cls(positions, law, material, to_strain, volumes)

    @cached_property
    def bulk(self) -> np.ndarray:
        """Return Λ [Pa], (1,) or (m, 1)."""
        return np.atleast_1d(self.law.bulk(self.material))

    def strain(self, change: np.ndarray) -> np.ndarray:
        """Return sampled strains (m, k) of displacements (m, 27, 3), ½ (x H x − X H X) = ½ u H (2X + u)."""
        return 0.5 * np.einsum("ekic,eic->ek", self.gradient(self.positions + change), change)

    def gradient(self, change: np.ndarray) -> np.ndarray:
        """Return B = ∂e/∂u (m, k, 27, 3) at displacements (m, 27, 3)."""
        forms = reference().forms
        product = forms.reshape(-1, NODES) @ (self.positions + change)
        return product.reshape(len(change), len(forms), NODES, 3)

    operator = gradient

    def step(self, operator: np.ndarray, step: np.ndarray) -> np.ndarray:
        """Return B δu (m, k) of a step (m, 27, 3)."""
        return np.einsum("ekic,eic->ek", operator, step)

    def forces(self, operator: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Return Bᵀ s (m, 27, 3) [N] of stresses (m, k)."""
        return np.einsum("ekic,ek->eic", operator, stress)

    def geometric(self, step: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Return Σ s_k H_k ⊗ I δu (m, 27, 3) [N] of a step (m, 27, 3) under stresses (m, k)."""
        return _under(stress) @ step

    def magnitudes(self, operator: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Return Σ |B| |s| (27,) by node, of stresses (m, k)."""
        return np.einsum("ekic,ek->i", np.abs(operator), np.abs(stress))

    def products(self) -> np.ndarray:
        """Return ∫ ρ N_i N_j dV (m, 27, 27) [kg]."""
        values, _ = shape(reference().points)
        weighed = self.material.density * self.volumes
        return np.einsum("eq,iq,jq->eij", weighed, values, values, optimize=True)

    def volume_ratio(self, change: np.ndarray) -> np.ndarray:
        """Return det F at the Gauss points (m, q) of displacements (m, 27, 3)."""
        _, slope = shape(reference().points)
        places = self.positions + change, self.positions
        current, initial = (np.linalg.det(np.einsum("eac,abq->eqcb", x, slope)) for x in places)
        return current / initial

    def energies(self, samples: np.ndarray) -> dict[str, float]:
        """Return ∫ W₀ dV and ∫ ½ Λ (π ϑ)² dV [J] of sampled strains (m, k), by part."""
        strain = self._at_points(samples)
        distortion = np.sum(self.volumes * self.law.distortion(self.material, strain).value)
        pressure = self._pressure(self.law.volume(strain).value)
        stretch = np.einsum("eq,eq,eq->", self.volumes, pressure, self.law.volume(strain).value)
        return {"distortion": float(distortion), "volumetric": 0.5 * float(stretch)}

    def stress(self, samples: np.ndarray) -> np.ndarray:
        """Return ∂W/∂e (m, k) [J] of sampled strains (m, k)."""
        if self.law.quadratic:
            return np.einsum("ekl,el->ek", self._constant_stiffness, samples)
        strain = self._at_points(samples)
        volume = self.law.volume(strain)
        stress = self.law.distortion(self.material, strain).first
        stress = stress + self._pressure(volume.value)[..., None] * volume.first
        return np.einsum("eqik,eq,eqi->ek", self.to_strain, self.volumes, stress, optimize=True)

    def pressure(self, samples: np.ndarray, step: np.ndarray) -> np.ndarray:
        """Return Λ π ϑ (m, q) [Pa] at the Gauss points, linear in a step (m, k) from strains (m, k)."""
        volume = self.law.volume(self._at_points(samples))
        return self._pressure(volume.value + np.einsum("eqi,eqi->eq", volume.first, self._at_points(step)))

    def moduli(self, samples: np.ndarray, pressure: np.ndarray | None = None) -> np.ndarray:
        """Return ∂²W/∂e² (m, k, k) [J] of sampled strains (m, k), at their own or a given pressure (m, q)."""
        return self._constant_stiffness if self.law.quadratic else self._stiffness(samples, pressure)

    @cached_property
    def _constant_stiffness(self) -> np.ndarray:
        return self._stiffness(np.zeros((len(self.positions), self.to_strain.shape[-1])))

    def _stiffness(self, samples: np.ndarray, pressure: np.ndarray | None = None) -> np.ndarray:
        strain = self._at_points(samples)
        volume = self.law.volume(strain)
        pressure = self._pressure(volume.value) if pressure is None else pressure
        tangent = self.law.distortion(self.material, strain).second
        tangent = tangent + pressure[..., None, None] * volume.second
        tangent = (tangent * self.volumes[..., None, None]) @ self.to_strain
        m, q, _, k = tangent.shape
        flat = self.to_strain.reshape(m, q * 6, k).swapaxes(1, 2)
        slope = np.einsum("eqi,eqik->eqk", volume.first, self.to_strain)
        projected = self._projector @ slope  # orthonormal modes: (m, 6, k)
        of_volume = self.bulk[..., None] * projected.swapaxes(1, 2) @ projected
        return flat @ tangent.reshape(m, q * 6, k) + of_volume

    def _at_points(self, samples: np.ndarray) -> np.ndarray:
        return np.einsum("eqik,ek->eqi", self.to_strain, samples)

    def _pressure(self, change_of_volume: np.ndarray) -> np.ndarray:
        """Return Λ π ϑ (m, q) of ϑ (m, q) at the Gauss points."""
        coefficients = np.einsum("erq,eq->er", self._projector, change_of_volume)
        return self.bulk * np.einsum("er,erq->eq", coefficients, self._projector) / self.volumes

    @cached_property
    def _projector(self) -> np.ndarray:
        """Return P (m, 6, q): ∫ φ_r ϑ dV = P ϑ for modes φ_r orthonormal over the element."""
        modes = reference().modes
        gram = np.einsum("qr,eq,qs->ers", modes, self.volumes, modes)
        return np.linalg.solve(np.linalg.cholesky(gram), (modes * self.volumes[..., None]).swapaxes(1, 2))


def at_rest(drawn: Bricks, scene: Scene) -> tuple[Bricks, NaturalState | None]:
    """Return the bricks of a scene's natural state, from bricks of the drawn sheet, and their natural strains
    (m, k). Natural strains are of the stretch U(z) = 1 + e0 − z k0, z from the middle, which keeps the
    thickness."""
    sampled = np.concatenate([np.array(sites) for sites in SAMPLED]).T
    sites = shape((sampled + 1.0) / 2.0)[0].T @ drawn.positions  # (m, k, 3)
    points = shape(reference().points)[0].T @ drawn.positions[..., :2]
    scene = stretched(scene)
    state, mid_surface = natural_at(scene, sites[..., :2]), natural_at(scene, points)
    if state is None or mid_surface is None:
        return drawn, None
    height = sites[..., 2, None, None]
    centre = drawn.positions.mean(axis=1, keepdims=True)  # positions relative to it lose no digits
    sides, plan = drawn.gradient(-centre)[..., :2], (drawn.positions - centre)[..., :2]

    def sample(strain: np.ndarray, curvature: np.ndarray) -> np.ndarray:
        return np.einsum("ekic,ekcd,eid->ek", sides, green(strain - height * curvature), plan, optimize=True)

    stretch = np.tile(np.eye(3), (*points.shape[:2], 1, 1))
    stretch[..., :2, :2] += mid_surface.at()[0]
    to_strain = pulled_back(np.linalg.inv(stretch), IN_SPACE) @ drawn.to_strain
    volumes = np.linalg.det(stretch) * drawn.volumes
    return replace(drawn, to_strain=to_strain, volumes=volumes), state.made(sample)


def tangent(gradient: np.ndarray, moduli: np.ndarray, stress: np.ndarray) -> np.ndarray:
    """Return Bᵀ D B + Σ s_k H_k ⊗ I (m, 27, 3, 27, 3) [N/m] of B (m, k, 27, 3), D (m, k, k) and s (m, k)."""
    flat, geometric = gradient.reshape(*stress.shape, 3 * NODES), _under(stress)
    out = (flat.swapaxes(1, 2) @ (moduli @ flat)).reshape(-1, NODES, 3, NODES, 3)
    for axis in range(3):
        out[:, :, axis, :, axis] += geometric
    return out


def _under(stress: np.ndarray) -> np.ndarray:
    """Return Σ s_k H_k (m, 27, 27) of stresses (m, k)."""
    forms = reference().forms
    return (stress @ forms.reshape(len(forms), -1)).reshape(-1, NODES, NODES)


def _retained_share(jacobian: np.ndarray) -> np.ndarray:
    """Return α (m,), the retained share of dropped in-plane shear, of bricks with X_c,ξ_b (m, q, c, b)."""
    sides = np.linalg.norm(jacobian[..., :2], axis=-2).mean(axis=1)
    return np.sqrt(np.maximum(RETAINED_SHEAR**2 - 2.5 * (sides.min(axis=1) / sides.max(axis=1)) ** 2, 0.0))


def _product(axes: list[np.ndarray]) -> np.ndarray:
    """Return products (q, k) of weights (q, k_axis) along ξ, η, ζ, the last axis fastest."""
    return np.einsum("qa,qb,qc->qabc", *axes).reshape(len(axes[0]), -1)
