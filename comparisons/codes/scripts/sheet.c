/* $title: velocity Verlet of a spring lattice. Written by sheetbench $version; see sheet.h. */
#include "sheet.h"
typedef sheet_real real;
typedef double (*field)[3];
double sqrt(double x);
enum { P = SHEET_LAYERS, N = SHEET_MASSES, ROWS = SHEET_ROWS, LOADED = SHEET_SUPPORTS };
#define EACH(e) for (int e = 0; e < 3; e++)
#define MASSES(i) for (int i = 0; i < N; i++)
#define FROM(i, j, e) (real)(SHEET_REST[j][e] - SHEET_REST[i][e] + (s->u[j][e] - s->u[i][e]))
enum { $sizes };
static const unsigned char SYMMETRIC[3][3] = {{1, 4, 5}, {4, 2, 6}, {5, 6, 3}}; /* stiffness of strains in a cell's row */
$tables
static real root(real x) { return (real)sqrt((double)x); }
static real dot(const real *x, const real *y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }
static void cross(const real *x, const real *y, real *z) {
  EACH(e) z[e] = x[(e + 1) % 3] * y[(e + 2) % 3] - x[(e + 2) % 3] * y[(e + 1) % 3];
}
/* sets a curve's value and two derivatives at a time: cubics {since when, from, coefficients}, constant before and after */
static void curve(int n, double t, double to[3]) {
  while (n < KNOTS - 1 && KNOT[n + 1][0] <= t) n++;
  const double *c = KNOT[n] + 1, x = t - c[0];
  to[0] = c[1] + x * (c[2] + x * (c[3] + x * c[4])), to[1] = c[2] + x * (2 * c[3] + 3 * x * c[4]), to[2] = 2 * c[3] + 6 * x * c[4];
}
static void average(field x) { /* the middles of columns */
  for (int i = N; i < ROWS; i++) EACH(e) x[i][e] = 0;
  MASSES(i) EACH(e) x[N + i / P][e] += x[i][e] / (double)P;
}
static void press(const sheet *s, const entry *c, real p, field f) { /* on a bilinear cell: p (c + d x e) / 12 a corner */
  real d[3], t[3], g[3], both[3], one[3], two[3];
  EACH(e) d[e] = FROM(c[0], c[2], e), t[e] = FROM(c[1], c[3], e), g[e] = FROM(c[0], c[1], e);
  cross(d, t, both), cross(g, t, one), cross(g, d, two);
  EACH(e) {
    const real on[4] = {both[e] + one[e], both[e] + two[e], 2 * both[e] - one[e], 2 * both[e] - two[e]};
    for (int n = 0; n < 4; n++) f[c[n]][e] += p * on[n] / 12;
  }
}
$rubber
static void sides(const entry *c, field x, real a[3], real b[3], real q[3]) { /* of a cell, as x has them, and its warp */
  EACH(e) {
    const double k = x[c[0]][e], l = x[c[1]][e], m = x[c[2]][e], o = x[c[3]][e];
    a[e] = (real)(m - k - (o - l)) / 2, b[e] = (real)(m - k + (o - l)) / 2, q[e] = (real)(k - l + (m - o));
  }
}
/* adds forces of springs to f, where elastic, and of dampers at a velocity; returns the energy */
static double springs(sheet *s, field velocity, int elastic) {
  double energy = 0;
  for (int m = 0; m < LINKS; m++) {
    const int i = LINK[m][0], j = LINK[m][1];
    const real *k = LINK_ROW[LINK_OF[m]]; /* offset, length, stiffness, damping */
    real d[3], r[3], v[3], change = 0, pull = 0, length = k[3];
    EACH(e) d[e] = (real)(s->u[j][e] - s->u[i][e]), r[e] = k[e] + d[e], change += (k[e] + r[e]) * d[e];
    const real square = dot(r, r);
    if (SHEET_GROWN) change -= s->grown[m], length = root(length * length + s->grown[m]);
    if (elastic) {
      const real now = root(square), longer = change / (now + length);
      pull = k[4] * longer / now, energy += k[4] * longer * longer / 2;
    }
    if (DAMPED) {
      EACH(e) v[e] = (real)(velocity[j][e] - velocity[i][e]);
      pull += k[5] * dot(r, v) / square;
    }
    EACH(e) s->f[i][e] -= pull * r[e], s->f[j][e] += pull * r[e];
  }
  for (int m = 0; m < CELLS; m++) {
    const entry *c = CELL[m];
    const real *k = CELL_ROW[CELL_OF[m]], *q = k + 6; /* sides, stiffness of area and strains, damping time */
    real da[3], db[3], dq[3], a[3], b[3], t = 0, rate[3] = {0, 0, 0}, on[4] = {0, 0, 0, 0}, x[3];
    sides(c, s->u, da, db, dq);
    EACH(e) a[e] = k[e] + da[e], b[e] = k[3 + e] + db[e];
    real d[4] = {2 * dot(k, da) + dot(da, da), 2 * dot(k + 3, db) + dot(db, db), dot(da, k + 3) + dot(a, db), dot(dq, dq)};
    real g[3] = {dot(k, k), dot(k + 3, k + 3), dot(k, k + 3)};
    if (SHEET_GROWN) EACH(e) d[e] -= s->grown[LINKS + 3 * m + e], g[e] += s->grown[LINKS + 3 * m + e];
    if (DAMPED) {
      real va[3], vb[3], vq[3];
      sides(c, velocity, va, vb, vq);
      rate[0] = 2 * dot(a, va) * q[7], rate[1] = 2 * dot(b, vb) * q[7], rate[2] = (dot(a, vb) + dot(b, va)) * q[7];
    }
    EACH(e) x[e] = elastic ? d[e] : 0;
    if (m >= UPRIGHT) { /* shear of the director b against the chord a */
      const real stiff = elastic ? q[3] * g[0] / (g[0] + d[0]) : 0, work = stiff * d[2] * d[2] / 2;
      on[0] = -work / (g[0] + d[0]), on[2] = stiff * d[2] + q[3] * rate[2], energy += work;
    } else { /* area and Green strains of the sides */
      const real change = g[1] * d[0] + g[0] * d[1] + d[0] * d[1] - 2 * g[2] * d[2] - d[2] * d[2];
      const real rest = g[0] * g[1] - g[2] * g[2], square = rest + change;
      const real n[3] = {g[1] + d[1], g[0] + d[0], -2 * (g[2] + d[2])};
      if (RUBBER && q[8] + q[9] > 0) {
        EACH(e) x[e] = 0;
        if (elastic) energy += rubber(d, g, q + 8, on);
      } else if (elastic) {
        const real now = root(square), more = change / (now + root(rest));
        t = q[0] * more / (2 * now), energy += q[0] * more * more / 2;
      }
      if (DAMPED) t += q[0] * dot(n, rate) / (4 * square);
      EACH(e) {
        on[e] += t * n[e];
        EACH(l) on[e] += q[SYMMETRIC[e][l]] * (x[l] + rate[l]), energy += q[SYMMETRIC[e][l]] * x[e] * x[l] / 2;
      }
    }
    EACH(e) {
      const real warp = RUBBER ? 2 * on[3] * dq[e] : 0, fa = on[0] * a[e] + on[2] * b[e] / 2, fb = on[1] * b[e] + on[2] * a[e] / 2;
      s->f[c[0]][e] += warp - fa - fb, s->f[c[1]][e] += fa - fb - warp;
      s->f[c[2]][e] += warp + fa + fb, s->f[c[3]][e] += fb - fa - warp;
    }
  }
  return energy;
}
$patch
static void push(sheet *s, int m, const real on[3]) { /* a point of the sheet, with an obstacle's force */
  EACH(e) s->pressed[CONTACT[m] + LOADED][e] += on[e];
  for (int c = 0; c < 4; c++) EACH(e) s->f[POINT_AT[m][c]][e] -= POINT_ROW[POINT_OF[m]][c] * on[e];
}
static double contact(sheet *s) { /* adds to f what obstacles press with; returns the energy */
  double energy = 0;
  for (int m = 0; m < SHEET_CONTACTS; m++) {
    const int o = CONTACT[m];
    const real *k = POINT_ROW[POINT_OF[m]], *body = OBSTACLE[o]; /* shares of columns, offset, stiffness, rounded depth */
    real *to = s->touch[m]; /* -d depth/dx, depth, load, load as friction has it */
    const int is_round = body[6] > 0; /* of planes the offset is from where the point rests */
    double y[3], along = 0, square = 0, reach = (double)k[4] + body[6];
    EACH(e) {
      y[e] = (is_round ? -body[e] : 0) - s->path[o + LOADED][e][0];
      for (int c = 0; c < 4; c++) y[e] += k[c] * ((is_round ? SHEET_REST[POINT_AT[m][c]][e] : 0) + s->u[POINT_AT[m][c]][e]);
    }
    EACH(e) along += y[e] * body[3 + e];
    EACH(e) y[e] -= is_round ? along * body[3 + e] : 0, square += y[e] * y[e], to[e] = is_round ? (real)(y[e] / reach) : body[3 + e];
    to[3] = (real)(is_round ? (reach - square / reach) / 2 : k[4] - along), to[4] = to[5] = 0;
    if (is_round || to[3] <= 0) continue;
    const real curved = to[3] < k[6] ? to[3] : k[6], sure = to[3] > k[6] ? to[3] - k[6] : 0;
    to[4] = to[5] = k[5] * (curved * curved / (2 * k[6]) + sure);
    energy += k[5] * (curved * curved * curved / (6 * k[6]) + sure * (sure + k[6]) / 2);
  }
  for (int m = 0; m < BLOCKS; m++) energy += patch(s, BLOCK[m]);
  for (int m = 0; m < SHEET_CONTACTS; m++) {
    const real load = s->touch[m][4], on[3] = {load * s->touch[m][0], load * s->touch[m][1], load * s->touch[m][2]};
    if (load != 0) push(s, m, on);
  }
  return energy;
}
static void resist(sheet *s, field velocity, real sign) { /* adds to f, so many times, what resists a velocity beside springs */
  average(velocity);
  if (RATED) MASSES(i) EACH(e) s->f[i][e] += (double)(sign * RATE[i]) * velocity[i][e];
  if (SHEET_AIR) MASSES(i) {
    real area[3], v[3];
    EACH(e) area[e] = (real)s->area[N + i / P][e], v[e] = (real)velocity[i][e];
    const real size = root(dot(area, area)), speed = size > 0 ? dot(v, area) / size : 0;
    EACH(e) s->f[i][e] += sign * DRAG[i] * (speed < 0 ? -speed : speed) * speed * area[e];
  }
  for (int m = 0; m < SHEET_CONTACTS; m++) {
    const int o = CONTACT[m];
    const real *to = s->touch[m], *k = POINT_ROW[POINT_OF[m]], size = root(dot(to, to)), tau = OBSTACLE[o][7];
    if (to[5] == 0) continue;
    real y[3], on[3], slip = (real)$slip;
    EACH(e) y[e] = -(real)s->path[o + LOADED][e][1];
    for (int c = 0; c < 4; c++) EACH(e) y[e] += k[c] * (real)velocity[POINT_AT[m][c]][e];
    const real leaving = dot(y, to) / size, along = to[5] * (tau * leaving < 1 ? tau * leaving : 1);
    EACH(e) y[e] -= leaving * to[e] / size, slip += y[e] * y[e];
    EACH(e) on[e] = -sign * (along * to[e] / size + OBSTACLE[o][8] * to[5] / root(slip) * y[e]);
    push(s, m, on);
  }
}
static void forces(sheet *s) { /* of all that acts, inwards, at the velocity w */
  average(s->u), s->fallen = 0;
  for (int i = 0; i < ROWS; i++) EACH(e) s->f[i][e] = 0;
  for (int b = 0; b < SHEET_BODIES; b++) EACH(e) s->pressed[b][e] = 0;
  for (int p = 0; p <= SHEET_POINTS; p++) /* at points, at last the weight */
    for (int n = NEAR[p]; n < NEAR[p + 1]; n++) EACH(e) s->f[NEAR_AT[n]][e] -= NEAR_SHARE[n] * s->input[3 * p + e];
  for (int p = 0; p <= SHEET_LOADS; p++) { /* those of a history, first those without one */
    const real factor = p ? s->input[SHEET_INPUTS + p - 1] : 1;
    for (int n = DEAD[p]; n < DEAD[p + 1]; n++) s->f[DEAD_AT[n] / 3][DEAD_AT[n] % 3] -= DEAD_SHARE[n] * factor;
    for (int i = 0; p == 0 && i < ROWS; i++) EACH(e) s->fallen += s->f[i][e] * s->u[i][e];
    for (int n = PRESSURE[p]; n < PRESSURE[p + 1]; n++) press(s, MIDDLE[PRESSURE_AT[n]], -PRESSURE_SHARE[n] * factor, s->f);
    for (int n = MOMENT[p]; n < MOMENT[p + 1]; n++) { /* of an edge, about the chord of the columns beside */
      const entry *c = EDGE[MOMENT_AT[n]];
      const int low = c[0], high = low + P - 1;
      real t[3], d[3], on[3];
      EACH(e) t[e] = FROM(c[1], c[2], e), d[e] = FROM(low, high, e);
      cross(t, d, on);
      const real scale = MOMENT_SHARE[n] * factor / (root(dot(t, t)) * dot(d, d));
      EACH(e) s->f[high][e] -= scale * on[e], s->f[low][e] += scale * on[e];
    }
  }
  for (int i = 0; i < SHEET_AIR; i++) EACH(e) s->area[i][e] = 0;
  for (int m = 0; SHEET_AIR > 0 && m < MIDDLES; m++) press(s, MIDDLE[m], COVER[m], s->area);
  s->stored = contact(s), resist(s, s->w, 1), s->stored += springs(s, s->w, 1);
}
static double across(field x, int i, int e, int from) { /* a row of a column's inverse, from P on of its matrix, of masses */
  const real *row = COLUMN_ROW[COLUMN_OF[i / P * 3 + e]] + (from + i % P) * P;
  double sum = 0;
  for (int q = 0; q < P; q++) sum += row[q] * x[i - i % P + q][e];
  return sum;
}
static void accelerate(sheet *s, real half) { /* and v by half a step of it */
  MASSES(i) EACH(e) s->f[i][e] += s->f[N + i / P][e] / (double)P;
  for (int i = N; i < ROWS; i++) EACH(e) s->f[i][e] = 0;
  MASSES(i) EACH(e) s->a[i][e] = -across(s->f, i, e, 0), s->v[i][e] += half * s->a[i][e];
}
static void follow(sheet *s) { /* histories of factors, and what springs measure at rest, quadratic in natural ones */
  real *factor = s->input + SHEET_FACTORS;
  double to[3];
  for (int k = 0; k < HISTORYS; k++)
    if (!s->set[k] && HISTORY[k] >= 0) curve(HISTORY[k], s->time, to), factor[k] = (real)to[0], s->changed = 1;
  for (int n = 0; s->changed && n < SHEET_GROWN; n++) s->grown[n] = 0;
  for (int k = 0, m = 0; s->changed && k < SHEET_SOURCES; k++)
    for (int l = -1; l <= k; l++, m++) /* alone, then times another */
      for (int n = 0; n < SHEET_GROWN; n++) s->grown[n] += GROWTH[m][n] * factor[k] * (l < 0 ? 1 : factor[l]);
  s->changed = 0;
}
/* a support or obstacle with the masses that it holds to a place, with a rate and an acceleration */
static void move(sheet *s, int body, int e, const double to[3]) {
  MASSES(i) if (OWNER[i][e] == body + 1) s->u[i][e] += to[0] - s->path[body][e][0], s->v[i][e] += to[1] - s->path[body][e][1];
  EACH(k) s->path[body][e][k] = to[k];
}
static void move_all(sheet *s, real h) { /* a step on, over which masses have kept their velocity */
  double to[3];
  for (int b = 0; b < SHEET_BODIES; b++) EACH(e) {
    s->path[b][e][0] += h * s->path[b][e][1];
    if (!s->moved[b] && MOTION[b][e] >= 0) curve(MOTION[b][e], s->time, to), move(s, b, e, to);
  }
}
void sheet_reset(sheet *s) {
  for (unsigned n = 0; n < sizeof *s; n++) ((unsigned char *)s)[n] = 0;
  s->step = SHEET_STEP;
  for (int n = 0; n < SHEET_INPUTS; n++) s->input[n] = INPUT[n];
  s->changed = 1, follow(s), move_all(s, 0);
  MASSES(i) EACH(e) s->u[i][e] = START[i % STARTS][e], s->w[i][e] = s->v[i][e];
  forces(s), accelerate(s, 0);
}
void sheet_step(sheet *s, int count) {
  const real h = s->step;
  for (; count > 0; count--) {
    MASSES(i) EACH(e) {
      s->w[i][e] = s->v[i][e] + h * s->a[i][e];
      s->v[i][e] += h / 2 * s->a[i][e], s->u[i][e] += h * s->v[i][e];
    }
    s->time += (double)h;
    move_all(s, h), follow(s), forces(s), accelerate(s, h / 2);
    if (DAMPED + RATED + SHEET_AIR + SHEET_CONTACTS == 0) continue;
    resist(s, s->w, -1), resist(s, s->v, 1);
    for (int i = 0; i < ROWS; i++) EACH(e) s->w[i][e] = s->v[i][e] - s->w[i][e];
    if (DAMPED) springs(s, s->w, 0);
    accelerate(s, 0);
  }
}
void sheet_set(sheet *s, int input, real value) {
  s->input[input] = value;
  if (input >= SHEET_FACTORS) s->set[input - SHEET_FACTORS] = s->changed = 1;
}
void sheet_set_force(sheet *s, int point, const real force[3]) { EACH(e) s->input[3 * point + e] = force[e]; }
void sheet_set_curvature(sheet *s, int source, real factor) { sheet_set(s, SHEET_FACTORS + source, factor); }
void sheet_move_support(sheet *s, int body, const real displacement[3], const real velocity[3]) {
  s->moved[body] = 1;
  EACH(e) move(s, body, e, (double[3]){displacement[e] - s->step * velocity[e], velocity[e], 0});
}
real sheet_get(sheet *s, int output) {
  const int e = output % 3, part = output / 3, body = part - SHEET_POINTS;
  double sum = 0;
  if (body < 0) {
    for (int n = PROBE[part]; n < PROBE[part + 1]; n++) sum += PROBE_SHARE[n] * s->u[PROBE_AT[n]][e];
  } else if (body >= SHEET_BODIES) {
    if (e == SHEET_KINETIC) MASSES(i) EACH(x) sum += s->v[i][x] * across(s->v, i, x, P) / 2;
    else sum = e == SHEET_ELASTIC ? s->stored : s->fallen;
  } else {
    MASSES(i) s->w[i][e] = s->a[i][e] + (OWNER[i][e] ? s->path[OWNER[i][e] - 1][e][2] : 0);
    sum = s->pressed[body][e];
    if (body < SHEET_SUPPORTS)
      for (int n = SUMMED[3 * body + e]; n < SUMMED[3 * body + e + 1]; n++)
        sum += SUMMED_SHARE[n] * (across(s->w, (int)SUMMED_AT[n] / 3, e, P) + s->f[SUMMED_AT[n] / 3][e]);
  }
  return (real)sum;
}
void sheet_probe(sheet *s, int point, real displacement[3]) { EACH(e) displacement[e] = sheet_get(s, 3 * point + e); }
void sheet_reaction(sheet *s, int body, real force[3]) { EACH(e) force[e] = sheet_get(s, SHEET_REACTIONS + 3 * body + e); }
real sheet_energy(sheet *s, int kind) { return sheet_get(s, SHEET_ENERGIES + kind); }
