/* $title: velocity Verlet of a spring lattice. Written by sheetbench $version; see sheet.h. */
#include "sheet.h"
typedef sheet_real real;
typedef real field[SHEET_MASSES][3];
double sqrt(double x);
enum { P = SHEET_LAYERS, N = SHEET_MASSES };
$tables
static real root(real x) { return (real)sqrt((double)x); }
static real dot(const real *x, const real *y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }
#if COURSES
/* a course at a time, or its derivative of an order: cubics between knots {time, value, slope after, before} */
static real course(int k, real t, int order) {
  const int first = FIRST[k], last = FIRST[k + 1];
  const real late = order ? (KNOT[last - 1][0] - KNOT[first][0]) * (real)1e-9 : 0;
  int n = first;
  while (n < last && KNOT[n][0] <= t + late) n++;
  if (n == first || n == last) return order ? 0 : KNOT[n == first ? n : n - 1][1];
  const real *p = KNOT[n - 1], *q = KNOT[n], h = q[0] - p[0], x = t - p[0], mean = (q[1] - p[1]) / h;
  const real c = (3 * mean - 2 * p[2] - q[3]) / h, d = (p[2] + q[3] - 2 * mean) / (h * h);
  if (order == 2) return 2 * c + 6 * d * x;
  return order ? p[2] + x * (2 * c + 3 * d * x) : p[1] + x * (p[2] + x * (c + x * d));
}
#endif
#if SHEET_SOURCES
static void grow(sheet *s) { /* what springs measure where nothing pulls: quadratic in the sources' factors */
  for (int n = 0; n < LINKS + 3 * CELLS; n++) s->grown[n] = 0;
  for (int n = 0; n < GROWTHS; n++) {
    const int other = GROWTH_OF[n][1];
    s->grown[GROWTH_AT[n]] += GROWTH[n] * s->factor[GROWTH_OF[n][0]] * (other == 255 ? 1 : s->factor[other]);
  }
}
#endif
static void sides(const entry *c, int p, field x, real a[3], real b[3]) { /* mean ones of a cell, as x has them */
  const real share = (real)1 / (real)(2 * p);
  for (int e = 0; e < 3; e++) {
    real g = 0, h = 0;
    for (int n = 0; n < p; n++) g += x[c[2 * p + n]][e] - x[c[n]][e], h += x[c[3 * p + n]][e] - x[c[p + n]][e];
    a[e] = (g - h) * share, b[e] = (g + h) * share;
  }
}
/* adds forces of springs to f, where elastic, and of dampers at a velocity; returns the energy */
static real springs(sheet *s, field f, field velocity, int elastic) {
  real energy = 0;
#if !DAMPED
  (void)velocity;
#endif
  for (int m = 0; m < LINKS; m++) {
    const int i = LINK[m][0], j = LINK[m][1];
    const real *k = LINK_ROW[LINK_OF[m]]; /* offset, length, stiffness, damping */
    real d[3], r[3], change = 0, pull = 0, length = k[3];
    for (int e = 0; e < 3; e++) d[e] = s->u[j][e] - s->u[i][e], r[e] = k[e] + d[e], change += (k[e] + r[e]) * d[e];
    const real square = dot(r, r);
#if SHEET_SOURCES
    change -= s->grown[m], length = root(length * length + s->grown[m]);
#endif
    if (elastic) {
      const real now = root(square), longer = change / (now + length);
      pull = k[4] * longer / now, energy += k[4] * longer * longer / 2;
    }
#if DAMPED
    real q[3];
    for (int e = 0; e < 3; e++) q[e] = velocity[j][e] - velocity[i][e];
    pull += k[5] * dot(r, q) / square;
#endif
    for (int e = 0; e < 3; e++) f[i][e] -= pull * r[e], f[j][e] += pull * r[e];
  }
  for (int m = 0; m < CELLS; m++) {
    const int p = m < SINGLE || m >= JOINED ? 1 : P; /* masses of a corner */
    const entry *c = CELL + (m < SINGLE ? 4 * m : m < JOINED ? 4 * (SINGLE + P * (m - SINGLE)) : 4 * (SINGLE + P * (JOINED - SINGLE) + m - JOINED));
    const real *k = CELL_ROW[CELL_OF[m]], *q = k + 6; /* sides, stiffness of area and strains, damping time */
    const real share = (real)1 / (real)(2 * p);
    real da[3], db[3], a[3], b[3];
    sides(c, p, s->u, da, db);
    for (int e = 0; e < 3; e++) a[e] = k[e] + da[e], b[e] = k[3 + e] + db[e];
    real d1 = 2 * dot(k, da) + dot(da, da), d2 = 2 * dot(k + 3, db) + dot(db, db), d3 = dot(da, k + 3) + dot(a, db);
    real g1 = dot(k, k), g2 = dot(k + 3, k + 3), g3 = dot(k, k + 3);
#if SHEET_SOURCES
    const real *grown = s->grown + LINKS + 3 * m;
    d1 -= grown[0], d2 -= grown[1], d3 -= grown[2], g1 += grown[0], g2 += grown[1], g3 += grown[2];
#endif
    real s1 = 0, s2 = 0, s3 = 0, e1 = elastic ? d1 : 0, e2 = elastic ? d2 : 0, e3 = elastic ? d3 : 0;
#if DAMPED
    real va[3], vb[3];
    sides(c, p, velocity, va, vb);
    const real tau = k[13], r1 = 2 * dot(a, va), r2 = 2 * dot(b, vb), r3 = dot(a, vb) + dot(b, va);
    e1 += tau * r1, e2 += tau * r2, e3 += tau * r3;
#endif
    if (m >= JOINED) { /* shear of the director b against the chord a */
      const real stiff = elastic ? q[3] * g1 / (g1 + d1) : 0, work = stiff * d3 * d3 / 2;
      s1 = -work / (g1 + d1), s3 = stiff * d3 + (elastic ? q[3] * (e3 - d3) : q[3] * e3), energy += work;
    } else { /* area and Green strains of the sides */
      const real change = g2 * d1 + g1 * d2 + d1 * d2 - 2 * g3 * d3 - d3 * d3, rest = g1 * g2 - g3 * g3;
      const real square = rest + change, n1 = g2 + d2, n2 = g1 + d1, n3 = -2 * (g3 + d3);
      real t = 0;
      if (elastic) {
        const real now = root(square), more = change / (now + root(rest));
        t = q[0] * more / (2 * now), energy += q[0] * more * more / 2;
        energy += (q[1] * d1 * d1 + q[2] * d2 * d2 + q[3] * d3 * d3) / 2 + q[4] * d1 * d2 + q[5] * d1 * d3 + q[6] * d2 * d3;
      }
#if DAMPED
      t += tau * q[0] * (n1 * r1 + n2 * r2 + n3 * r3) / (4 * square);
#endif
      s1 = t * n1 + q[1] * e1 + q[4] * e2 + q[5] * e3, s2 = t * n2 + q[4] * e1 + q[2] * e2 + q[6] * e3;
      s3 = t * n3 + q[5] * e1 + q[6] * e2 + q[3] * e3;
    }
    for (int e = 0; e < 3; e++) {
      const real fa = (2 * s1 * a[e] + s3 * b[e]) * share, fb = (2 * s2 * b[e] + s3 * a[e]) * share;
      for (int n = 0; n < p; n++) {
        f[c[n]][e] -= fa + fb, f[c[2 * p + n]][e] += fa + fb;
        f[c[p + n]][e] -= fb - fa, f[c[3 * p + n]][e] += fb - fa;
      }
    }
  }
  return energy;
}
#if PRESSABLE
/* adds to f what planes press with, where elastic, and sign times what resists a velocity; returns the energy */
static real contact(sheet *s, field f, field velocity, int elastic, real sign) {
  real energy = 0;
  for (int m = 0; m < PRESSABLE; m++) {
    const int o = TOUCHED[m], first = TOUCHING[m];
    const real *k = TOUCH[m], *n = PLANE[o - SHEET_SUPPORTS] + 3; /* stiffness, offset, rounded depth */
    const real tau = n[3], mu = n[4], share = (real)1 / (real)P;
    real x[3], y[3], slip = (real)1e-6;
    for (int e = 0; e < 3; e++) {
      x[e] = -PLANE[o - SHEET_SUPPORTS][e] - s->place[o][e], y[e] = -s->rate[o][e];
      for (int q = 0; q < P; q++)
        x[e] += (SHEET_REST[first + q][e] + s->u[first + q][e]) * share, y[e] += velocity[first + q][e] * share;
    }
    const real depth = k[1] - dot(x, n), leaving = dot(y, n);
    if (depth <= 0) continue;
    const real curved = depth < k[2] ? depth : k[2], sure = depth > k[2] ? depth - k[2] : 0;
    const real load = k[0] * (curved * curved / (2 * k[2]) + sure);
    if (elastic) energy += k[0] * (curved * curved * curved / (6 * k[2]) + sure * (sure + k[2]) / 2);
    for (int e = 0; e < 3; e++) y[e] -= leaving * n[e], slip += y[e] * y[e];
    const real along = load * (tau * leaving < 1 ? tau * leaving : 1), rubbed = mu * load / root(slip);
    for (int e = 0; e < 3; e++) {
      const real on = sign * (along * n[e] + rubbed * y[e]) - (elastic ? load * n[e] : 0);
      s->pressed[o][e] -= on;
      for (int q = 0; q < P; q++) f[first + q][e] += on * share;
    }
  }
  return energy;
}
#endif
static void loads(sheet *s) {
#if HISTORIES
  real factor[HISTORIES];
  for (int n = 0; n < HISTORIES; n++) factor[n] = HISTORY[n] < 0 ? 1 : course(HISTORY[n], s->time, 0);
#endif
  for (int i = 0; i < N; i++)
    for (int e = 0; e < 3; e++) s->load[i][e] = WEIGHT[i] * s->gravity[e];
  for (int p = 0; p < SHEET_POINTS; p++)
    for (int n = NEAR[p]; n < NEAR[p + 1]; n++)
      for (int e = 0; e < 3; e++) s->load[NEAR_AT[n]][e] += NEAR_SHARE[n] * s->force[p][e];
#if LOADS
  for (int n = 0; n < LOADS; n++) s->load[LOAD_AT[n][0]][LOAD_AT[n][1]] += LOAD[n]$of_load;
#endif
#if PRESSES
  for (int m = 0; m < PRESSES; m++) { /* pressure on a bilinear cell: p (c + d x e) / 12 on a corner */
    const real p = PRESS[m]$of_press / 12, share = (real)1 / (real)P;
    real x[4][3], d[3], t[3], g[3];
    for (int o = 0; o < 4; o++)
      for (int e = 0; e < 3; e++) {
        x[o][e] = 0;
        for (int q = 0; q < P; q++) x[o][e] += (SHEET_REST[PRESS_AT[m][o] + q][e] + s->u[PRESS_AT[m][o] + q][e]) * share;
      }
    for (int e = 0; e < 3; e++) d[e] = x[2][e] - x[0][e], t[e] = x[3][e] - x[1][e], g[e] = x[1][e] - x[0][e];
    for (int e = 0; e < 3; e++) {
      const int a = (e + 1) % 3, b = (e + 2) % 3;
      const real both = p * (d[a] * t[b] - d[b] * t[a]), one = p * (g[a] * t[b] - g[b] * t[a]), two = p * (g[a] * d[b] - g[b] * d[a]);
      const real on[4] = {both + one, both + two, 2 * both - one, 2 * both - two};
      for (int o = 0; o < 4; o++)
        for (int q = 0; q < P; q++) s->load[PRESS_AT[m][o] + q][e] += on[o] * share;
    }
  }
#endif
#if COUPLES
  for (int m = 0; m < COUPLES; m++) { /* an edge's moment, about the chord of the columns beside */
    const entry *c = COUPLE_AT[m];
    real t[3], d[3];
    for (int e = 0; e < 3; e++) {
      t[e] = 0, d[e] = SHEET_REST[c[0] + P - 1][e] + s->u[c[0] + P - 1][e] - SHEET_REST[c[0]][e] - s->u[c[0]][e];
      for (int q = 0; q < P; q++) t[e] += SHEET_REST[c[2] + q][e] + s->u[c[2] + q][e] - SHEET_REST[c[1] + q][e] - s->u[c[1] + q][e];
    }
    const real scale = COUPLE[m]$of_couple / (root(dot(t, t)) * dot(d, d));
    for (int e = 0; e < 3; e++) {
      const int a = (e + 1) % 3, b = (e + 2) % 3;
      const real on = scale * (t[a] * d[b] - t[b] * d[a]);
      s->load[c[0] + P - 1][e] += on, s->load[c[0]][e] -= on;
    }
  }
#endif
}
static void accelerate(sheet *s, real half) { /* and v by half a step of it */
  for (int i = 0; i < N; i++)
    for (int e = 0; e < 3; e++) s->a[i][e] = HELD[i][e] & 1 ? 0 : (s->load[i][e] - s->f[i][e]) * INVERSE[i];
#if MEANS
  for (int m = 0; m < MEANS; m++) { /* columns whose mean is held */
    const int first = MEAN[m][0], e = MEAN[m][1];
    real mean = 0, weight = 0;
    for (int q = 0; q < P; q++) mean += s->a[first + q][e], weight += INVERSE[first + q];
    for (int q = 0; q < P; q++) s->a[first + q][e] -= mean / weight * INVERSE[first + q];
  }
#endif
  for (int i = 0; i < N; i++)
    for (int e = 0; e < 3; e++) s->v[i][e] += half * s->a[i][e];
}
static void resist(sheet *s) { /* adds what damps each mass at the velocity w */
#if RATED
  for (int i = 0; i < N; i++)
    for (int e = 0; e < 3; e++) s->f[i][e] += RATE[i] * s->w[i][e];
#else
  (void)s;
#endif
}
static void clear(sheet *s) {
  for (int i = 0; i < N; i++)
    for (int e = 0; e < 3; e++) s->f[i][e] = 0;
  for (int b = 0; b < SHEET_BODIES; b++)
    for (int e = 0; e < 3; e++) s->pressed[b][e] = 0;
}
#if SHEET_SOURCES
static void follow(sheet *s) { /* histories of natural states */
#if COURSES
  int new = 0;
  for (int k = 0; k < SHEET_SOURCES; k++) {
    if (s->set[k] || SOURCE_COURSE[k] < 0) continue;
    s->factor[k] = course(SOURCE_COURSE[k], s->time, 0), new = 1;
  }
  if (new) grow(s);
#else
  (void)s;
#endif
}
#endif
void sheet_reset(sheet *s) {
  static const real gravity[3] = $gravity;
  s->time = 0, s->step = SHEET_STEP;
  for (int p = 0; p < SHEET_POINTS; p++)
    for (int e = 0; e < 3; e++) s->force[p][e] = 0;
  for (int b = 0; b < SHEET_BODIES; b++) {
    s->moved[b] = 0;
    for (int e = 0; e < 3; e++) {
      s->place[b][e] = s->rate[b][e] = s->bend[b][e] = 0;
#if MOVING
      if (MOTION[b] >= 0) {
        s->place[b][e] = course(MOTION[b] + e, 0, 0), s->rate[b][e] = course(MOTION[b] + e, 0, 1);
        s->bend[b][e] = course(MOTION[b] + e, 0, 2);
      }
#endif
    }
  }
#if SHEET_SOURCES
  for (int k = 0; k < SHEET_SOURCES; k++) s->set[k] = 0, s->factor[k] = 1;
  grow(s), follow(s);
#endif
  for (int i = 0; i < N; i++)
    for (int e = 0; e < 3; e++) {
      s->u[i][e] = $start, s->v[i][e] = HELD[i][e] ? s->rate[(HELD[i][e] - 1) / 2][e] : 0;
      s->w[i][e] = s->v[i][e], s->gravity[e] = gravity[e];
    }
  clear(s), loads(s), springs(s, s->f, s->w, 1), resist(s);
#if PRESSABLE
  contact(s, s->f, s->w, 1, 1);
#endif
  accelerate(s, 0);
}
void sheet_step(sheet *s, int count) {
  const real h = s->step;
  for (; count > 0; count--) {
    for (int i = 0; i < N; i++)
      for (int e = 0; e < 3; e++) {
        s->w[i][e] = s->v[i][e] + h * s->a[i][e];
        s->v[i][e] += h / 2 * s->a[i][e], s->u[i][e] += h * s->v[i][e];
      }
    s->time += h;
    for (int b = 0; b < SHEET_BODIES; b++) {
      int still = !s->moved[b];
      real jump[3] = {0, 0, 0}, kick[3] = {0, 0, 0};
      for (int e = 0; e < 3; e++) {
        const real before = s->place[b][e], rate = s->rate[b][e];
        if (s->moved[b]) {
          s->place[b][e] = s->moved[b] == 2 ? s->target[b][e] : before + h * rate;
          s->rate[b][e] = s->aimed[b][e], s->bend[b][e] = 0;
        }
#if MOVING
        else if (MOTION[b] >= 0) {
          s->place[b][e] = course(MOTION[b] + e, s->time, 0), s->rate[b][e] = course(MOTION[b] + e, s->time, 1);
          s->bend[b][e] = course(MOTION[b] + e, s->time, 2), still = 0;
        }
#endif
        jump[e] = s->place[b][e] - before - h * rate, kick[e] = s->rate[b][e] - rate;
      }
      if (s->moved[b]) s->moved[b] = 1;
      for (int i = 0; i < N && !still; i++)
        for (int e = 0; e < 3; e++)
          if (HELD[i][e] && (HELD[i][e] - 1) / 2 == b) s->u[i][e] += jump[e], s->v[i][e] += kick[e];
    }
#if SHEET_SOURCES
    follow(s);
#endif
    clear(s), loads(s), springs(s, s->f, s->w, 1), resist(s);
#if PRESSABLE
    contact(s, s->f, s->w, 1, 1);
#endif
    accelerate(s, h / 2);
#if PRESSABLE
    contact(s, s->f, s->w, 0, -1), contact(s, s->f, s->v, 0, 1);
#endif
#if DAMPED || RATED || PRESSABLE
    for (int i = 0; i < N; i++)
      for (int e = 0; e < 3; e++) s->w[i][e] = s->v[i][e] - s->w[i][e];
#if DAMPED
    springs(s, s->f, s->w, 0);
#endif
    resist(s);
    accelerate(s, 0);
#endif
  }
}
void sheet_set_force(sheet *s, int point, const real force[3]) {
  for (int e = 0; e < 3; e++) s->force[point][e] = force[e];
}
void sheet_set_curvature(sheet *s, int source, real factor) {
  s->factor[source] = factor, s->set[source] = 1;
#if SHEET_SOURCES
  grow(s);
#endif
}
void sheet_move_support(sheet *s, int body, const real displacement[3], const real velocity[3]) {
  for (int e = 0; e < 3; e++) s->target[body][e] = displacement[e], s->aimed[body][e] = velocity[e];
  s->moved[body] = 2;
}
void sheet_probe(const sheet *s, int point, real displacement[3]) {
  for (int e = 0; e < 3; e++) displacement[e] = 0;
  for (int n = PROBE[point]; n < PROBE[point + 1]; n++)
    for (int e = 0; e < 3; e++) displacement[e] += PROBE_SHARE[n] * s->u[PROBE_AT[n]][e];
}
void sheet_reaction(const sheet *s, int body, real force[3]) {
  for (int e = 0; e < 3; e++) {
    force[e] = s->pressed[body][e];
    if (body >= SHEET_SUPPORTS) continue;
    for (int n = SUMMED[3 * body + e]; n < SUMMED[3 * body + e + 1]; n++) {
      const int i = (int)SUMMED_AT[n] / 3, code = HELD[i][e];
      const real a = s->a[i][e] + (code ? s->bend[(code - 1) / 2][e] : 0);
      force[e] += SUMMED_SHARE[n] * (MASS[i] * a + s->f[i][e] - s->load[i][e]);
    }
  }
}
real sheet_energy(sheet *s, int kind) {
  real sum = 0;
  if (kind == SHEET_ELASTIC) {
    for (int i = 0; i < N; i++)
      for (int e = 0; e < 3; e++) s->w[i][e] = 0;
#if PRESSABLE
    real pressed[SHEET_BODIES][3];
    for (int b = 0; b < SHEET_BODIES; b++)
      for (int e = 0; e < 3; e++) pressed[b][e] = s->pressed[b][e];
    sum = contact(s, s->w, s->v, 1, 0);
    for (int b = 0; b < SHEET_BODIES; b++)
      for (int e = 0; e < 3; e++) s->pressed[b][e] = pressed[b][e];
#endif
    return sum + springs(s, s->w, s->v, 1);
  }
  for (int i = 0; i < N; i++)
    for (int e = 0; e < 3; e++)
      sum += kind == SHEET_KINETIC ? MASS[i] * s->v[i][e] * s->v[i][e] / 2 : -WEIGHT[i] * s->gravity[e] * s->u[i][e];
  if (kind == SHEET_KINETIC) return sum;
  for (int p = 0; p < SHEET_POINTS; p++)
    for (int n = NEAR[p]; n < NEAR[p + 1]; n++)
      for (int e = 0; e < 3; e++) sum -= NEAR_SHARE[n] * s->force[p][e] * s->u[NEAR_AT[n]][e];
#if LOADS
  for (int n = 0; n < LOADS; n++) sum -= $still * s->u[LOAD_AT[n][0]][LOAD_AT[n][1]];
#endif
  return sum;
}
