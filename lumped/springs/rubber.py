"""The law of rubber membranes: energy, stress and stiffness of a cell at any strain.

Per volume and with C the cell's deformation tensor in its plane, T = tr C, A = det C and θ = t² of the
thickness stretch t at which nothing pulls there (`sheetbench.scenes.material` has f, c₀₁ and Λ),

    W = f(x) + c₀₁ (A + θ T − 3) − p/2 ln(A θ) + Λ/8 ln²(A θ),  x = T + θ − 3,  p = 2 f′(0) + 4 c₀₁,
    0 = θ (f′ + c₀₁ T) − p/2 + Λ/4 ln(A θ).

With M = −θ (f′ + c₀₁ T) its derivatives are W_T = f′ + c₀₁ θ and W_A = c₀₁ + M/A, and with B = Λ/4 − M and
N = B + θ² f″, θ eliminated from the second ones too,

    W_TT = (f″ B − θ² c₀₁ (2 f″ + c₀₁))/N,   W_TA = −(f″ + c₀₁) Λ θ/4AN,   W_AA = (M² − M Λ/2 + B θ² f″)/A²N.

Cells are of right angles. C is that of the mean ḡ of g in a bilinear cell, δg + s/12 (1, 1, 0), s = q·q of
what its corners have beside mean sides. Less ½ k₁₀ (√ĝ₁₁ − L₁)² + ½ k₁₁ (√ĝ₂₂ − L₂)², ĝ = g + s/4 the mean of
its sides', which links along them store unless opposite ones differ; with ½ k₁₂ δg₁₂². Constants: k₀ to k₃,
the springs of its small strains, whose M it has (`lumped.springs.laws`); k₄ to k₉: c₁₀, c₀₁, c₂₀, c₃₀, Λ, all
times its volume [J], and Gent's limit; k₁₀, k₁₁ [N/m]; k₁₂ [N/m³].
"""

from __future__ import annotations

import math

from numba import njit

from lumped.springs.laws import Constants, Four, Six, Three, elongation, stiffness_of_area_and_strains

Memory = tuple[float, float]


@njit(cache=True, error_model="numpy")
def less_logarithm(x: float, logarithm: float) -> float:
    """x − ln(1 + x), no digits lost where x is small; logarithm: ln(1 + x)."""
    if abs(x) < 3e-3:
        return (
            x
            * x
            * (1.0 / 2.0 - x * (1.0 / 3.0 - x * (1.0 / 4.0 - x * (1.0 / 5.0 - x * (1.0 / 6.0 - x / 7.0)))))
        )
    return x - logarithm


@njit(cache=True, error_model="numpy", forceinline=True)
def of_trace(x: float, c10: float, c20: float, c30: float, limit: float) -> Four:
    """f − c₁₀ x, f′ − c₁₀, f″ and f‴; not a number from Gent's limit on."""
    if limit == 0.0:
        return (
            x * x * (c20 + x * c30),
            x * (2.0 * c20 + 3.0 * x * c30),
            2.0 * c20 + 6.0 * x * c30,
            6.0 * c30,
        )
    left = 1.0 - x / limit if x < limit else math.nan
    second = c10 / (limit * left * left)
    return (
        c10 * limit * less_logarithm(-x / limit, math.log1p(-x / limit)),
        c10 * (x / limit) / left,
        second,
        2.0 * second / (limit * left),
    )


@njit(cache=True, error_model="numpy")
def logarithm_of_thickness(
    growth: float, excess: float, c10: float, c01: float, c20: float, c30: float, volume: float, limit: float
) -> tuple[float, float]:
    """ln θ and θ − 1, from growth, ln A, and excess, T − 2: Halley's method, of third order, from what small
    strains have; with a limit from no further than half of what it leaves. volume: Λ."""
    volume, trace = 0.25 * volume, 2.0 + excess
    lame = volume + c01 + 2.0 * c20 + (c10 / limit if limit != 0.0 else 0.0)  # ¼ λ
    x, theta, thinning, step = -lame / (lame + c10 + c01) * growth, 1.0, 0.0, 0.0
    most = limit + 1.0 - excess
    for _ in range(30):
        if limit != 0.0 and math.exp(x) >= most:
            x = math.log(0.5 * most)
        thinning = math.expm1(x)
        theta = 1.0 + thinning
        _, f1, f2, f3 = of_trace(excess + thinning, c10, c20, c30, limit)
        value = f1 + thinning * (c10 + f1) + c01 * (excess + thinning * trace) + volume * (growth + x)
        pulls = theta * (c10 + f1 + c01 * trace)
        slope = pulls + theta * theta * f2 + volume
        second = pulls + theta * theta * (3.0 * f2 + theta * f3)
        step = 2.0 * value * slope / (2.0 * slope * slope - value * second)
        x -= step
        if abs(step) <= 1e-5 * abs(x):
            break
    return x, thinning - theta * step * (1.0 - 0.5 * step)


@njit(cache=True, error_model="numpy")
def rubber(half: float, d: Four, g: Three, area: float, k: Constants) -> tuple[float, Memory, Four]:
    """Return W since rest; θ − 1 and A, which `stiffness_of_rubber` takes; S."""
    if k[4] + k[5] == 0.0:  # there is no cell
        return 0.0 * half, (0.0, 1.0), (0.0 * half, 0.0 * half, 0.0 * half, 0.0 * half)
    e1, e2 = (d[0] + d[3] / 12.0) / g[0], (d[1] + d[3] / 12.0) / g[1]
    square = d[2] * d[2] / (area * area)
    product = e1 * e2 - square
    change = e1 + e2 + product  # of A
    sheared = k[12] * d[2]
    excess, growth = e1 + e2, math.log1p(change)
    x, thinning = logarithm_of_thickness(growth, excess, k[4], k[5], k[6], k[7], k[8], k[9])
    theta, volume, c01 = 1.0 + thinning, growth + x, k[5]
    f0, f1, _, _ = of_trace(excess + thinning, k[4], k[6], k[7], k[9])
    f1 += k[4]
    curved = less_logarithm(change, growth) + less_logarithm(thinning, x)
    stored = f0 + k[4] * (curved - product) + c01 * (curved + curved - product + thinning * excess)
    d1, d2 = d[0] + 0.25 * d[3], d[1] + 0.25 * d[3]
    w1, p1, _, _ = elongation(half, d1, g[0] + d1, math.sqrt(g[0]), k[10])
    w2, p2, _, _ = elongation(half, d2, g[1] + d2, math.sqrt(g[1]), k[11])
    energy = half * sheared * d[2] + stored + 0.125 * k[8] * volume * volume - w1 - w2
    turned = c01 * theta * square
    inverse = 1.0 / (1.0 + change)
    m1 = inverse / g[0] * ((f1 + c01 * (1.0 + e2)) * (e1 + product - thinning * (1.0 + e2)) - turned)
    m2 = inverse / g[1] * ((f1 + c01 * (1.0 + e1)) * (e2 + product - thinning * (1.0 + e1)) - turned)
    m3 = 2.0 * d[2] / (area * area) * (theta * (f1 + c01 * (2.0 + excess)) * inverse - c01)
    stress = (
        m1 - p1,
        m2 - p2,
        m3 + sheared,
        (m1 + m2) / 12.0 - 0.25 * (p1 + p2),
    )
    return energy, (thinning, 1.0 + change), stress


@njit(cache=True, error_model="numpy")
def stiffness_of_rubber(
    d: Four, g: Three, area: float, memory: Memory, share: float, k: Constants
) -> tuple[Six, Four]:
    """M + share (D − M) of `rubber`, its 11 22 33 12 13 23 and 14 24 34 44."""
    o = _stiffness_of_membrane(d, g, area, memory, k)
    d1, d2 = d[0] + 0.25 * d[3], d[1] + 0.25 * d[3]
    _, _, m1, r1 = elongation(0.5, d1, g[0] + d1, math.sqrt(g[0]), k[10])
    _, _, m2, r2 = elongation(0.5, d2, g[1] + d2, math.sqrt(g[1]), k[11])
    c1, c2 = m1 + r1, m2 + r2
    square = (g[0] + d[0]) * (g[1] + d[1]) - d[2] * d[2]
    m, _ = stiffness_of_area_and_strains(d, g, area, (0.0, square), 0.0, k)
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


@njit(cache=True, error_model="numpy", forceinline=True)
def _stiffness_of_membrane(d: Four, g: Three, area: float, memory: Memory, k: Constants) -> Six:
    """The second derivatives of W by ḡ, times the volume."""
    (thinning, a), c01, inverse = memory, k[5], 1.0 / (area * area)
    theta, volume = 1.0 + thinning, 0.25 * k[8]
    c11, c22 = 1.0 + (d[0] + d[3] / 12.0) / g[0], 1.0 + (d[1] + d[3] / 12.0) / g[1]
    trace = c11 + c22
    _, f1, f2, _ = of_trace(trace + theta - 3.0, k[4], k[6], k[7], k[9])
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


@njit(cache=True, error_model="numpy")
def mean_rubber(d0: Four, d1: Four, g: Three, area: float, k: Constants) -> Four:
    """The stress over a step whose work is the energy stored: that in its middle, and along the step what is
    left of the energy (Gonzalez 1996)."""
    middle = 0.5 * (d0[0] + d1[0]), 0.5 * (d0[1] + d1[1]), 0.5 * (d0[2] + d1[2]), 0.5 * (d0[3] + d1[3])
    s = rubber(0.5, middle, g, area, k)[2]
    m1, m2, m3, m4 = d1[0] - d0[0], d1[1] - d0[1], d1[2] - d0[2], d1[3] - d0[3]
    length = m1 * m1 + m2 * m2 + m3 * m3 + m4 * m4
    if length <= 1e-12 * area * area:  # what is left is rounding
        return s
    stored = rubber(0.5, d1, g, area, k)[0] - rubber(0.5, d0, g, area, k)[0]
    left = (stored - s[0] * m1 - s[1] * m2 - s[2] * m3 - s[3] * m4) / length
    return s[0] + left * m1, s[1] + left * m2, s[2] + left * m3, s[3] + left * m4
