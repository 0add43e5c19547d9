static double value(const double *c, int n, double t) { return n < 0 ? 0 : c[0] + t * value(c + 1, n - 1, t); }
static int roots(const double *c, int n, double *out) { /* where a polynomial of degree n changes its sign in (-1, 1) */
  double slope[4], end[6] = {-1};
  int inside = 0, count = 0;
  for (int k = 0; k < n; k++) slope[k] = (k + 1) * c[k + 1];
  if (n > 1) inside = roots(slope, n - 1, end + 1);
  end[inside + 1] = 1;
  for (int j = 0; j <= inside; j++) { /* between those of its derivative */
    double a = end[j], b = end[j + 1], at = value(c, n, a);
    if (at * value(c, n, b) >= 0) continue;
    for (int turn = 0; turn < 52; turn++) *(at * value(c, n, (a + b) / 2) > 0 ? &a : &b) = (a + b) / 2;
    out[count++] = b;
  }
  return count;
}
static void parabolas(double t, double *f) { f[0] = t * (t - 1) / 2, f[1] = 1 - t * t, f[2] = t * (t + 1) / 2; }
/* Gauss points of the part of a line at y between two ends where a depth d is positive: adds to loads of nine points */
static double line(const double *d, const double *k, double y, double weight, double low, double high, double *load) {
  double energy = 0, over[3], up[3];
  low = low < -1 ? -1 : low, high = high > 1 ? 1 : high;
  for (int g = 0; g < 4 && high > low; g++) {
    double deep = 0, stiff = 0;
    parabolas((low + high) / 2 + (high - low) / 2 * ALONG[g][0], over), parabolas(y, up);
    for (int n = 0; n < 9; n++) deep += up[n / 3] * over[n % 3] * d[n], stiff += up[n / 3] * over[n % 3] * k[n];
    stiff *= weight * (high - low) / 2 * ALONG[g][1], energy += stiff * deep * deep * deep / 6;
    for (int n = 0; n < 9; n++) load[n] += stiff * deep * deep / 2 * up[n / 3] * over[n % 3];
  }
  return energy;
}
static double inside(const double *d, const double *k, double *load) { /* over the patch of a cell where its depth is positive */
  static const double power[3][3] = {{0, 1, 0}, {-0.5, 0, 0.5}, {0.5, -1, 0.5}};
  double c[3][3] = {{0}}, end[8] = {-1}, p[3], r[5] = {0}, energy = 0;
  int n = 1;
  for (int i = 0; i < 81; i++) c[i / 27][i / 9 % 3] += power[i / 27][i % 9 / 3] * power[i / 9 % 3][i % 3] * d[i % 9];
  for (int s = -1; s < 2; s += 2) { /* where the border passes a side */
    for (int i = 0; i < 3; i++) p[i] = c[i][0] + s * c[i][1] + c[i][2];
    n += roots(p, 2, end + n);
  }
  for (int i = 0; i < 9; i++) r[i / 3 + i % 3] += c[i / 3][1] * c[i % 3][1] - 4 * c[i / 3][2] * c[i % 3][0];
  n += roots(r, 4, end + n), end[n] = 1; /* and where two meet */
  for (int i = 2; i < n; i++)
    for (int j = i; j > 1 && end[j] < end[j - 1]; j--) p[0] = end[j], end[j] = end[j - 1], end[j - 1] = p[0];
  for (int m = 0; m < 16 * n; m++) {
    const double half = (end[m / 16 + 1] - end[m / 16]) / 2, y = (end[m / 16 + 1] + end[m / 16]) / 2 + half * ACROSS[m % 16][0];
    const double w = half * ACROSS[m % 16][1], a = c[0][0] + y * (c[1][0] + y * c[2][0]), b = c[0][1] + y * (c[1][1] + y * c[2][1]);
    const double q = c[0][2] + y * (c[1][2] + y * c[2][2]), square = b * b - 4 * q * a;
    if (half <= 0 || (square <= 0 && a <= 0)) continue;
    const double t = -(b + (b < 0 ? -1 : 1) * sqrt(square > 0 ? square : 0)) / 2, low = t / q < a / t ? t / q : a / t, high = t / q + a / t - low;
    if (square <= 0) energy += line(d, k, y, w, -1, 1, load);
    else if (q < 0) energy += line(d, k, y, w, low, high, load);
    else energy += line(d, k, y, w, -1, low, load) + line(d, k, y, w, high, 1, load);
  }
  return energy;
}
static real patch(sheet *s, const int *of) { /* sets the loads of the nine points of a block of a cell; returns the energy */
  double d[9], k[9], load[9], energy = 0, most = s->touch[of[0]][3], least = most;
  for (int n = 0; n < 9; n++) d[n] = s->touch[of[n]][3], most = d[n] > most ? d[n] : most, least = d[n] < least ? d[n] : least;
  if (most + least + 1.5625 * (most - least) <= 0) return 0; /* nowhere deeper than the mean by more than this */
  for (int turn = 0; turn < 2; turn++) { /* k (d^3 - (d - over)^3) / 6 over */
    const double over = POINT_ROW[POINT_OF[of[0]]][6], sign = 1 - 2 * turn;
    for (int n = 0; n < 9; n++) load[n] = 0, k[n] = sign * (double)POINT_ROW[POINT_OF[of[n]]][5] / over, d[n] -= turn * over;
    energy += inside(d, k, load);
    for (int n = 0; n < 9; n++) {
      s->touch[of[n]][4] += (real)load[n];
      for (int j = 0; j < 9; j += j == 2 ? 4 : 2) { /* shared among corners: none pulls there */
        const real aside = n % 3 == 1 ? (real)0.5 : n % 3 == j % 3, up = n / 3 == 1 ? (real)0.5 : n / 3 == j / 3;
        s->touch[of[j]][5] += (real)load[n] * aside * up;
      }
    }
  }
  return (real)energy;
}
