#include <math.h>
static double beyond(double x, double logarithm) { /* x - ln(1 + x), no digits lost */
  const double rest = 1. / 4 - x * (1. / 5 - x * (1. / 6 - x / 7));
  return x < 3e-3 && -x < 3e-3 ? x * x * (1. / 2 - x * (1. / 3 - x * rest)) : x - logarithm;
}
/* c: c10, c01, c20, c30, volume, limit; sets f - c10 x, f' - c10, f'', f''' */
static void of_trace(double x, const double *c, double f[4]) {
  const double left = c[5] > 0 && x >= c[5] ? sqrt(-1.0) : c[5] > 0 ? 1 - x / c[5] : 1;
  f[0] = c[5] > 0 ? c[0] * c[5] * beyond(-x / c[5], log1p(-x / c[5])) : x * x * (c[2] + x * c[3]);
  f[1] = c[5] > 0 ? c[0] * (x / c[5]) / left : x * (2 * c[2] + 3 * x * c[3]);
  f[2] = c[5] > 0 ? c[0] / (c[5] * left * left) : 2 * c[2] + 6 * x * c[3];
  f[3] = c[5] > 0 ? 2 * f[2] / (c[5] * left) : 6 * c[3];
}
static double thickness(double growth, double excess, const double *c, double *thinning) { /* its logarithm; Halley's method */
  const double volume = c[4] / 4, trace = 2 + excess, most = c[5] + 1 - excess;
  double f[4], theta = 1, step = 0, x;
  of_trace(0, c, f);
  x = -(volume + c[1] + f[2]) / (volume + c[1] + f[2] + c[0] + c[1]) * growth;
  for (int turn = 0; turn < 30; turn++) {
    if (c[5] > 0 && exp(x) >= most) x = log(most / 2);
    *thinning = expm1(x), theta = 1 + *thinning;
    of_trace(excess + *thinning, c, f);
    const double value = f[1] + *thinning * (c[0] + f[1]) + c[1] * (excess + *thinning * trace) + volume * (growth + x);
    const double pulls = theta * (c[0] + f[1] + c[1] * trace), slope = pulls + theta * theta * f[2] + volume;
    step = 2 * value * slope / (2 * slope * slope - value * (pulls + theta * theta * (3 * f[2] + theta * f[3])));
    x -= step;
    if (step * step <= 1e-10 * x * x) break;
  }
  *thinning -= theta * step * (1 - step / 2);
  return x;
}
/* sets a membrane's stress on d, changes of the measures g and the warp's square; returns the energy */
static real rubber(const real *d, const real *g, const real *k, real on[4]) {
  double c[6], f[4], more[3], thinning, pull[2], energy = 0; /* k: c, stiffness of links along sides, of shear */
  for (int n = 0; n < 6; n++) c[n] = k[n];
  const double area = (double)g[0] * g[1] - (double)g[2] * g[2], e[2] = {(d[0] + d[3] / 12.0) / g[0], (d[1] + d[3] / 12.0) / g[1]};
  const double sheared = k[8] * (double)d[2], square = (double)d[2] * d[2] / area, product = e[0] * e[1] - square;
  const double excess = e[0] + e[1], change = excess + product, growth = log1p(change), x = thickness(growth, excess, c, &thinning);
  of_trace(excess + thinning, c, f);
  const double curved = beyond(change, growth) + beyond(thinning, x), theta = 1 + thinning, first = f[1] + c[0];
  for (int n = 0; n < 2; n++) { /* less links along the sides */
    const double by = d[n] + d[3] / 4.0, now = sqrt(g[n] + by), longer = by / (now + sqrt((double)g[n]));
    pull[n] = k[6 + n] * longer / (2 * now), energy -= k[6 + n] * longer * longer / 2;
    more[n] = (first + c[1] * (1 + e[1 - n])) * (e[n] + product - thinning * (1 + e[1 - n])) - c[1] * theta * square;
    more[n] /= (1 + change) * g[n], on[n] = (real)(more[n] - pull[n]);
  }
  on[2] = (real)(2 * d[2] / area * (theta * (first + c[1] * (2 + excess)) / (1 + change) - c[1]) + sheared);
  on[3] = (real)((more[0] + more[1]) / 12 - (pull[0] + pull[1]) / 4);
  energy += sheared * d[2] / 2 + f[0] + c[0] * (curved - product) + c[1] * (curved + curved - product + thinning * excess);
  return (real)(energy + c[4] / 8 * (growth + x) * (growth + x));
}
