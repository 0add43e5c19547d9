"""Laws of springs: energy, stress and stiffness as functions of a measure of shape.

A link's measure is g = r·r of its relative position r, a cell's the Gram matrix g = (a·a, b·b, a·b) of its
mean sides a and b. A law is an energy W(g) [J]; its stress is S = dW/dg [N/m], its stiffness D = d²W/dg²
[N/m³]. The forces follow from the measure alone: on a link's end 2 S r, on a cell's sides

    2 S₁ a + S₃ b   and   2 S₂ b + S₃ a,

and so does the tangent (`lumped.springs.links`, `lumped.springs.cells`). D is M + (D − M) with the material
part M = Σ k ∇ε ∇εᵀ of the strains ε in an energy ½ Σ k ε²; dampers of coefficients c in place of k have the
stress M ġ. Laws take the change δg since rest, not g alone: where it is small no digits are lost.

Laws of cells have one more measure, s = q·q of the corners' deviation from mean sides
(`lumped.springs.cells`); they are the rows of `lumped.springs.law_table.LAWS`.

The energy of a rubber membrane per volume, at any strain, is a function of the cell's deformation tensor C in
its plane, T = tr C, A = det C and θ = t², t the thickness stretch without normal stress
(`sheetbench.scenes.objects.material` has f, c₀₁ and Λ),

    W = f(x) + c₀₁ (A + θ T − 3) − p/2 ln(A θ) + Λ/8 ln²(A θ),  x = T + θ − 3,  p = 2 f′(0) + 4 c₀₁,
    0 = θ (f′ + c₀₁ T) − p/2 + Λ/4 ln(A θ).

Its derivatives are W_T = f′ + c₀₁ θ and W_A = c₀₁ + M/A with M = −θ (f′ + c₀₁ T). The second derivatives, θ
eliminated, are for B = Λ/4 − M and N = B + θ² f″

    W_TT = (f″ B − θ² c₀₁ (2 f″ + c₀₁))/N,   W_TA = −(f″ + c₀₁) Λ θ/4AN,   W_AA = (M² − M Λ/2 + B θ² f″)/A²N.

Cells have right angles at rest. C follows from the mean ḡ of g in a bilinear cell, δg + s/12 (1, 1, 0). The
cell's law subtracts ½ k₁₀ (√ĝ₁₁ − L₁)² + ½ k₁₁ (√ĝ₂₂ − L₂)², ĝ = g + s/4 the mean of its sides' squares, the
energy of the links along them if opposite sides are equal, and adds ½ k₁₂ δg₁₂². Constants: k₀ to k₃, the
springs of its small strains, which define M; k₄ to k₉: c₁₀, c₀₁, c₂₀, c₃₀, Λ, all times its volume [J], and
Gent's limit; k₁₀, k₁₁ [N/m]; k₁₂ [N/m³].
"""

import math

import numpy as np

from sheetbench.numerics.options import inner

Vector = tuple[float, float, float]  # kept in registers, where small arrays are in memory
Three = tuple[float, float, float]
Four = tuple[float, float, float, float]
Constants = tuple[float, ...]
Six = tuple[float, float, float, float, float, float]  # 11, 22, 33, 12, 13, 23 of a symmetric matrix
Memory = tuple[float, float]
# own, constant, S and δg (m, n) of springs of n measures: with Maxwell branches the stress of the force is
# own · S + constant [N/m]; the loops set S and δg
Branches = tuple[float, np.ndarray, np.ndarray, np.ndarray]


@inner()
def plus(a: Vector, b: Vector) -> Vector:
    """Return a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@inner()
def less(a: Vector, b: Vector) -> Vector:
    """Return a − b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@inner()
def times(k: float, a: Vector) -> Vector:
    """Return k a."""
    return k * a[0], k * a[1], k * a[2]


@inner()
def dot(a: Vector, b: Vector) -> float:
    """Return a·b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inner()
def elongation(change: float, square: float, rest_length: float, k: float) -> Four:
    """Return W = ½ k (r − L)², r = √g, S = ½ k (r − L)/r, M = ¼ k/g and D − M = −½ S/g."""
    length = math.sqrt(square)
    strain = change / ((length + rest_length) * length)
    stress = 0.5 * k * strain
    inverse = 0.5 / square
    return stress * strain * square, stress, 0.5 * k * inverse, -stress * inverse


@inner()
def times_six(d: Constants, x: Three) -> Three:
    """Return a symmetric matrix times a vector."""
    return (
        d[0] * x[0] + d[3] * x[1] + d[4] * x[2],
        d[3] * x[0] + d[1] * x[1] + d[5] * x[2],
        d[4] * x[0] + d[5] * x[1] + d[2] * x[2],
    )


@inner()
def area_and_strains(d: Four, g: Three, area: float, q: Constants) -> tuple[float, Memory, Four]:
    """Return energy W, memory (t, A²) and stress S of an area spring and springs against the sides' Green
    strains: W = ½ q₀ (A − A₀)² + ½ δg·Q δg. A² = det g, and Q consists of q₁ to q₆ (11, 22, 33, 12, 13, 23),
    with couplings by fibres.

    d: δg; g: at rest; area: A₀; q: [N/m³] (`of_stiffness`). t = ½ q₀ (A − A₀)/A is the area spring's stress
    over n = (g₂₂, g₁₁, −2 g₁₂).
    """
    d1, d2, d3 = d[0], d[1], d[2]
    turned = g[2] * d3
    change = g[1] * d1 + g[0] * d2 + d1 * d2 - (turned + turned) - d3 * d3  # of det g
    square = area * area + change
    now = math.sqrt(square)
    grown = change / (now + area)
    t = 0.5 * q[0] * grown / now
    s1, s2, s3 = times_six(q[1:], (d1, d2, d3))
    energy = 0.5 * (q[0] * grown * grown + s1 * d1 + s2 * d2 + s3 * d3)
    s1, s2, turned = s1 + t * (g[1] + d2), s2 + t * (g[0] + d1), t * (g[2] + d3)
    return energy, (t, square), (s1, s2, s3 - (turned + turned), 0.0)


@inner()
def stiffness_of_area_and_strains(
    d: Four, g: Three, area: float, memory: Memory, share: float, q: Constants
) -> tuple[Six, Four]:
    """Return M + share (D − M) of `area_and_strains` with its memory t and A², and zeros for s:

    M = ¼ q₀ n nᵀ/A² + Q,   D − M = t (N − ½ n nᵀ/A²),   N = ∂n/∂g.
    """
    t, square = share * memory[0], memory[1]
    along = (0.25 * q[0] - 0.5 * t) / square
    n1, n2, n3 = g[1] + d[1], g[0] + d[0], -2.0 * (g[2] + d[2])
    return (
        along * n1 * n1 + q[1],
        along * n2 * n2 + q[2],
        along * n3 * n3 + q[3] - 2.0 * t,
        along * n1 * n2 + q[4] + t,
        along * n1 * n3 + q[5],
        along * n2 * n3 + q[6],
    ), (0.0, 0.0, 0.0, 0.0)


@inner()
def extrapolated_area_and_strains(
    d: Four, g: Three, area: float, memory: Memory, stress: Four, q: Constants, rate: Four
) -> Four:
    """Return Q δg and ½ q₀ (A − A₀), each linear in the rate of g."""
    now = math.sqrt(memory[1])
    grown = (g[1] + d[1]) * rate[0] + (g[0] + d[0]) * rate[1] - 2.0 * (g[2] + d[2]) * rate[2]
    s1, s2, s3 = times_six(q[1:], (d[0] + rate[0], d[1] + rate[1], d[2] + rate[2]))
    return s1, s2, s3, 0.5 * q[0] * (now - area + 0.5 * grown / now)


@inner()
def area_and_strains_of_extrapolated(d: Four, g: Three, memory: Memory, p: Four) -> tuple[Memory, Four]:
    """Return the memory t and A² of `stiffness_of_area_and_strains`, and S, from extrapolated quantities
    p."""
    t = p[3] / math.sqrt(memory[1])
    s = p[0] + t * (g[1] + d[1]), p[1] + t * (g[0] + d[0]), p[2] - 2.0 * t * (g[2] + d[2]), 0.0
    return (t, memory[1]), s


@inner()
def area_and_strains_by_constants(
    d: Four, g: Three, area: float, memory: Memory, q: Constants, rate: Four, out: np.ndarray
) -> None:
    """Set the derivatives of the power S·ġ by q₀ to q₆, and by the natural change of g, with A₀² = det g, in
    `out` (10,)."""
    now = math.sqrt(memory[1])
    turned = g[2] * d[2]
    grown = (g[1] * d[0] + g[0] * d[1] + d[0] * d[1] - (turned + turned) - d[2] * d[2]) / (now + area)
    swept = (g[1] + d[1]) * rate[0] + (g[0] + d[0]) * rate[1] - 2.0 * (g[2] + d[2]) * rate[2]  # of A²
    out[0] = 0.5 * grown / now * swept
    out[1], out[2], out[3] = d[0] * rate[0], d[1] * rate[1], d[2] * rate[2]
    out[4] = d[0] * rate[1] + d[1] * rate[0]
    out[5] = d[0] * rate[2] + d[2] * rate[0]
    out[6] = d[1] * rate[2] + d[2] * rate[1]
    s1, s2, s3 = times_six(q[1:], (rate[0], rate[1], rate[2]))
    by_area = -0.25 * q[0] * swept / (now * area)
    out[7], out[8], out[9] = by_area * g[1] - s1, by_area * g[0] - s2, -2.0 * by_area * g[2] - s3


def of_stiffness(k: np.ndarray, sides: np.ndarray, area: np.ndarray) -> np.ndarray:
    """Return the constants q (c, 7) [N/m³] of `area_and_strains` from stiffnesses k (c, 4 or 7) [N/m]. Four
    resist the change of area A/A₀ − 1 and the Green strains ε1 = δg₁₁/2g₁₁, ε2 = δg₂₂/2g₂₂, γ = δg₁₂/√(g₁₁
    g₂₂), each with the energy ½ k ε² A₀; three more couple ε1 ε2, ε1 γ and ε2 γ, with k ε ε A₀. sides: (c, 2,
    3) [m] and area: (c,) [m²] of the cells at rest."""
    a, b = (sides**2).sum(axis=2).T
    first, second, shear = 0.5 / a, 0.5 / b, 1.0 / np.sqrt(a * b)
    products = first * second, first * shear, second * shear
    squares = 1.0 / area**2, first**2, second**2, shear**2, *products
    constants = np.zeros((len(k), len(squares)))
    count = k.shape[1]
    constants[:, :count] = k * area[:, None] * np.stack(squares[:count], axis=1)
    return constants


@inner()
def less_logarithm(x: float, logarithm: float) -> float:
    """Return x − ln(1 + x), without loss of digits where x is small; logarithm: ln(1 + x)."""
    if abs(x) < 3e-3:
        fourth = 1.0 / 4.0 - x * (1.0 / 5.0 - x * (1.0 / 6.0 - x / 7.0))
        return x * x * (1.0 / 2.0 - x * (1.0 / 3.0 - x * fourth))
    return x - logarithm


@inner(cache=True, forceinline=True)
def of_trace(x: float, k: Constants) -> Four:
    """Return f − c₁₀ x, f′ − c₁₀, f″ and f‴; not a number from Gent's limit on."""
    c10, c20, c30, limit = k[4], k[6], k[7], k[9]
    if limit == 0.0:
        rise, second = x * (2.0 * c20 + 3.0 * x * c30), 2.0 * c20 + 6.0 * x * c30
        return x * x * (c20 + x * c30), rise, second, 6.0 * c30
    left = 1.0 - x / limit if x < limit else math.nan
    second = c10 / (limit * left * left)
    return (
        c10 * limit * less_logarithm(-x / limit, math.log1p(-x / limit)),
        c10 * (x / limit) / left,
        second,
        2.0 * second / (limit * left),
    )


@inner()
def logarithm_of_thickness(growth: float, excess: float, k: Constants) -> tuple[float, float]:
    """Return ln θ and θ − 1 from growth, ln A, and excess, T − 2, by Halley's method, of third order, started
    with the value of small strains; with Gent's limit at most half of the way to it."""
    c10, c01, volume, limit, trace = k[4], k[5], 0.25 * k[8], k[9], 2.0 + excess
    lame = volume + c01 + of_trace(0.0, k)[2]  # ¼ λ
    x, theta, thinning, step = -lame / (lame + c10 + c01) * growth, 1.0, 0.0, 0.0
    most = limit + 1.0 - excess
    for _ in range(30):
        if limit != 0.0 and math.exp(x) >= most:
            x = math.log(0.5 * most)
        thinning = math.expm1(x)
        theta = 1.0 + thinning
        _, f1, f2, f3 = of_trace(excess + thinning, k)
        value = f1 + thinning * (c10 + f1) + c01 * (excess + thinning * trace) + volume * (growth + x)
        pulls = theta * (c10 + f1 + c01 * trace)
        slope = pulls + theta * theta * f2 + volume
        second = pulls + theta * theta * (3.0 * f2 + theta * f3)
        step = 2.0 * value * slope / (2.0 * slope * slope - value * second)
        x -= step
        if abs(step) <= 1e-5 * abs(x):
            break
    return x, thinning - theta * step * (1.0 - 0.5 * step)


@inner()
def rubber(d: Four, g: Three, area: float, k: Constants) -> tuple[float, Memory, Four]:
    """Return W since rest; the memory θ − 1 and A of `stiffness_of_rubber`; S."""
    if k[4] + k[5] == 0.0:  # absent cell
        return 0.0, (0.0, 1.0), (0.0, 0.0, 0.0, 0.0)
    e1, e2 = (d[0] + d[3] / 12.0) / g[0], (d[1] + d[3] / 12.0) / g[1]
    square = d[2] * d[2] / (area * area)
    product = e1 * e2 - square
    change = e1 + e2 + product  # of A
    sheared = k[12] * d[2]
    excess, growth = e1 + e2, math.log1p(change)
    x, thinning = logarithm_of_thickness(growth, excess, k)
    theta, volume, c01 = 1.0 + thinning, growth + x, k[5]
    f0, f1, _, _ = of_trace(excess + thinning, k)
    f1 += k[4]
    curved = less_logarithm(change, growth) + less_logarithm(thinning, x)
    stored = f0 + k[4] * (curved - product) + c01 * (curved + curved - product + thinning * excess)
    d1, d2 = d[0] + 0.25 * d[3], d[1] + 0.25 * d[3]
    w1, p1, _, _ = elongation(d1, g[0] + d1, math.sqrt(g[0]), k[10])
    w2, p2, _, _ = elongation(d2, g[1] + d2, math.sqrt(g[1]), k[11])
    energy = 0.5 * sheared * d[2] + stored + 0.125 * k[8] * volume * volume - w1 - w2
    turned = c01 * theta * square
    inverse = 1.0 / (1.0 + change)
    m1 = inverse / g[0] * ((f1 + c01 * (1.0 + e2)) * (e1 + product - thinning * (1.0 + e2)) - turned)
    m2 = inverse / g[1] * ((f1 + c01 * (1.0 + e1)) * (e2 + product - thinning * (1.0 + e1)) - turned)
    m3 = 2.0 * d[2] / (area * area) * (theta * (f1 + c01 * (2.0 + excess)) * inverse - c01)
    stress = m1 - p1, m2 - p2, m3 + sheared, (m1 + m2) / 12.0 - 0.25 * (p1 + p2)
    return energy, (thinning, 1.0 + change), stress


@inner()
def stiffness_of_rubber(
    d: Four, g: Three, area: float, memory: Memory, share: float, k: Constants
) -> tuple[Six, Four]:
    """Return M + share (D − M) of `rubber`, 11 22 33 12 13 23 and 14 24 34 44."""
    o = _stiffness_of_membrane(d, g, area, memory, k)
    d1, d2 = d[0] + 0.25 * d[3], d[1] + 0.25 * d[3]
    _, _, m1, r1 = elongation(d1, g[0] + d1, math.sqrt(g[0]), k[10])
    _, _, m2, r2 = elongation(d2, g[1] + d2, math.sqrt(g[1]), k[11])
    c1, c2 = m1 + r1, m2 + r2
    square = (g[0] + d[0]) * (g[1] + d[1]) - d[2] * d[2]
    springs = k[0], k[1], k[2], k[3], 0.0, 0.0, 0.0
    m, _ = stiffness_of_area_and_strains(d, g, area, (0.0, square), 0.0, springs)
    return (
        m[0] + share * (o[0] - c1 - m[0]),
        m[1] + share * (o[1] - c2 - m[1]),
        m[2] + share * (o[2] + k[12] - m[2]),
        m[3] + share * (o[3] - m[3]),
        m[4] + share * (o[4] - m[4]),
        m[5] + share * (o[5] - m[5]),
    ), (
        share * ((o[0] + o[3]) / 12.0 - 0.25 * c1),
        share * ((o[1] + o[3]) / 12.0 - 0.25 * c2),
        share * (o[4] + o[5]) / 12.0,
        share * ((o[0] + 2.0 * o[3] + o[1]) / 144.0 - 0.0625 * (c1 + c2)),
    )


@inner()
def rubber_by_constants(
    d: Four, g: Three, area: float, memory: Memory, k: Constants, rate: Four, out: np.ndarray
) -> None:
    """Set the derivatives of the power S·ġ by k₀ to k₁₂ in `out` (13,), the rates of ∂W/∂k with W stationary
    in θ and θ̇ = −(F_T Ṫ + F_A Ȧ)/F_θ from the condition F = 0."""
    if k[4] + k[5] == 0.0:
        return
    theta, a, c01, limit = 1.0 + memory[0], memory[1], k[5], k[9]
    e1, e2 = (d[0] + d[3] / 12.0) / g[0], (d[1] + d[3] / 12.0) / g[1]
    r1, r2 = (rate[0] + rate[3] / 12.0) / g[0], (rate[1] + rate[3] / 12.0) / g[1]
    trace, growing = 2.0 + e1 + e2, r1 + r2
    swept = r1 * (1.0 + e2) + r2 * (1.0 + e1) - 2.0 * d[2] * rate[2] / (area * area)
    x = e1 + e2 + memory[0]
    _, f1, f2, _ = of_trace(x, k)
    slope = k[4] + f1 + c01 * trace + theta * f2 + 0.25 * k[8] / theta
    thinning = -(theta * (f2 + c01) * growing + 0.25 * k[8] * swept / a) / slope
    stretching, by_volume = growing + thinning, swept / a + thinning / theta
    remaining = 1.0 if limit == 0.0 else 1.0 - x / limit
    out[4] = stretching / remaining - by_volume
    out[5] = swept + theta * growing + trace * thinning - 2.0 * by_volume
    if limit == 0.0:
        out[6], out[7] = 2.0 * x * stretching, 3.0 * x * x * stretching
    else:
        out[9] = -k[4] * x * stretching / (limit * limit * remaining * remaining)
    out[8] = 0.25 * math.log(a * theta) * by_volume
    d1, d2 = d[0] + 0.25 * d[3], d[1] + 0.25 * d[3]
    out[10] = -elongation(d1, g[0] + d1, math.sqrt(g[0]), 1.0)[1] * (rate[0] + 0.25 * rate[3])
    out[11] = -elongation(d2, g[1] + d2, math.sqrt(g[1]), 1.0)[1] * (rate[1] + 0.25 * rate[3])
    out[12] = d[2] * rate[2]


@inner(cache=True, forceinline=True)
def _stiffness_of_membrane(d: Four, g: Three, area: float, memory: Memory, k: Constants) -> Six:
    """Return the second derivatives of W by ḡ, times the volume."""
    (thinning, a), c01, inverse = memory, k[5], 1.0 / (area * area)
    theta, volume = 1.0 + thinning, 0.25 * k[8]
    c11, c22 = 1.0 + (d[0] + d[3] / 12.0) / g[0], 1.0 + (d[1] + d[3] / 12.0) / g[1]
    trace = c11 + c22
    _, f1, f2, _ = of_trace(trace + theta - 3.0, k)
    m = -theta * (k[4] + f1 + c01 * trace)
    b = volume - m
    n = 1.0 / (b + theta * theta * f2)
    tt = n * (f2 * b - theta * theta * c01 * (2.0 * f2 + c01))
    ta = -n * (f2 + c01) * volume * theta / a
    aa = n * (m * m - 2.0 * m * volume + b * theta * theta * f2) / (a * a)
    by_area = (c01 + m / a) * inverse
    t1, t2, n1, n2, n3 = 1.0 / g[0], 1.0 / g[1], c22 / g[0], c11 / g[1], -2.0 * inverse * d[2]
    return (
        tt * t1 * t1 + 2.0 * ta * t1 * n1 + aa * n1 * n1,
        tt * t2 * t2 + 2.0 * ta * t2 * n2 + aa * n2 * n2,
        aa * n3 * n3 - 2.0 * by_area,
        tt * t1 * t2 + ta * (t1 * n2 + t2 * n1) + aa * n1 * n2 + by_area,
        ta * t1 * n3 + aa * n1 * n3,
        ta * t2 * n3 + aa * n2 * n3,
    )
