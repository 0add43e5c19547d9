/* $title: velocity Verlet of a spring lattice. Written by sheetbench $version; see sheet.h. */
#include "sheet.h"
typedef sheet_real real;
typedef real (*field)[3];
double sqrt(double x);
enum { P = SHEET_LAYERS, N = SHEET_MASSES };
#define EACH(e) for (int e = 0; e < 3; e++)
#define MASSES(i) for (int i = 0; i < N; i++)
#define PART ((real)1 / (real)P)
$tables
static real root(real x) { return (real)sqrt((double)x); }
static real dot(const real *x, const real *y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }
static void cross(const real *x, const real *y, real *z) {
  EACH(e) z[e] = x[(e + 1) % 3] * y[(e + 2) % 3] - x[(e + 2) % 3] * y[(e + 1) % 3];
}
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
static void grow(sheet *s) { /* what springs measure where nothing pulls: quadratic in the sources' factors */
  for (int n = 0; n < GROWN; n++) s->grown[n] = 0;
  for (int n = 0; n < GROWTHS; n++) {
    const int other = GROWTH_OF[n][1];
    s->grown[GROWTH_AT[n]] += GROWTH[n] * s->factor[GROWTH_OF[n][0]] * (other == 255 ? 1 : s->factor[other]);
  }
}
static void column(const sheet *s, int first, real from, real x[3]) { /* where its middle is, from so many times rest */
  EACH(e) {
    x[e] = 0;
    for (int i = first; i < first + P; i++) x[e] += (from * SHEET_REST[i][e] + s->u[i][e]) * PART;
  }
}
static void press(const sheet *s, const entry *c, real p, field f) { /* on a bilinear cell: p (c + d x e) / 12 a corner */
  real x[4][3], d[3], t[3], g[3], both[3], one[3], two[3];
  for (int o = 0; o < 4; o++) column(s, c[o], 1, x[o]);
  EACH(e) d[e] = x[2][e] - x[0][e], t[e] = x[3][e] - x[1][e], g[e] = x[1][e] - x[0][e];
  cross(d, t, both), cross(g, t, one), cross(g, d, two);
  EACH(e) {
    const real on[4] = {both[e] + one[e], both[e] + two[e], 2 * both[e] - one[e], 2 * both[e] - two[e]};
    for (int n = 0; n < 4 * P; n++) f[c[n / P] + n % P][e] += p * on[n / P] * PART / 12;
  }
}
$rubber
static void sides(const entry *c, int p, field x, real a[3], real b[3], real q[3]) { /* of a cell, as x has them */
  const real share = (real)1 / (real)(2 * p);
  EACH(e) {
    real g = 0, h = 0;
    q[e] = 0;
    for (int n = 0; n < p; n++) {
      const real k = x[c[n]][e], l = x[c[p + n]][e], m = x[c[2 * p + n]][e], o = x[c[3 * p + n]][e];
      g += m - k, h += o - l;
      if (RUBBER) q[e] += 2 * share * ((k - l) + (m - o));
    }
    a[e] = (g - h) * share, b[e] = (g + h) * share;
  }
}
/* adds forces of springs to f, where elastic, and of dampers at a velocity; returns the energy */
static real springs(sheet *s, field velocity, int elastic) {
  real energy = 0;
  for (int m = 0; m < LINKS; m++) {
    const int i = LINK[m][0], j = LINK[m][1];
    const real *k = LINK_ROW[LINK_OF[m]]; /* offset, length, stiffness, damping */
    real d[3], r[3], v[3], change = 0, pull = 0, length = k[3];
    EACH(e) d[e] = s->u[j][e] - s->u[i][e], r[e] = k[e] + d[e], change += (k[e] + r[e]) * d[e];
    const real square = dot(r, r);
    if (GROWN) change -= s->grown[m], length = root(length * length + s->grown[m]);
    if (elastic) {
      const real now = root(square), longer = change / (now + length);
      pull = k[4] * longer / now, energy += k[4] * longer * longer / 2;
    }
    if (DAMPED) {
      EACH(e) v[e] = velocity[j][e] - velocity[i][e];
      pull += k[5] * dot(r, v) / square;
    }
    EACH(e) s->f[i][e] -= pull * r[e], s->f[j][e] += pull * r[e];
  }
  for (int m = 0; m < CELLS; m++) {
    const int p = m < SINGLE || m >= JOINED ? 1 : P; /* masses of a corner */
    const entry *c = CELL + 4 * (m < SINGLE ? m : m < JOINED ? SINGLE + P * (m - SINGLE) : SINGLE + P * (JOINED - SINGLE) + m - JOINED);
    const real *k = CELL_ROW[CELL_OF[m]], *q = k + 6; /* sides, stiffness of area and strains, damping time */
    real da[3], db[3], dq[3], a[3], b[3], t = 0, rate[3] = {0, 0, 0}, on[4] = {0, 0, 0, 0}, x[3];
    sides(c, p, s->u, da, db, dq);
    EACH(e) a[e] = k[e] + da[e], b[e] = k[3 + e] + db[e];
    real d[4] = {2 * dot(k, da) + dot(da, da), 2 * dot(k + 3, db) + dot(db, db), dot(da, k + 3) + dot(a, db), dot(dq, dq)};
    real g[3] = {dot(k, k), dot(k + 3, k + 3), dot(k, k + 3)};
    if (GROWN) EACH(e) d[e] -= s->grown[LINKS + 3 * m + e], g[e] += s->grown[LINKS + 3 * m + e];
    if (DAMPED) {
      real va[3], vb[3], vq[3];
      sides(c, p, velocity, va, vb, vq);
      rate[0] = 2 * dot(a, va) * q[7], rate[1] = 2 * dot(b, vb) * q[7], rate[2] = (dot(a, vb) + dot(b, va)) * q[7];
    }
    EACH(e) x[e] = rate[e] + (elastic ? d[e] : 0);
    if (m >= JOINED) { /* shear of the director b against the chord a */
      const real stiff = elastic ? q[3] * g[0] / (g[0] + d[0]) : 0, work = stiff * d[2] * d[2] / 2;
      on[0] = -work / (g[0] + d[0]), on[2] = stiff * d[2] + q[3] * rate[2], energy += work;
    } else { /* area and Green strains of the sides */
      const real change = g[1] * d[0] + g[0] * d[1] + d[0] * d[1] - 2 * g[2] * d[2] - d[2] * d[2];
      const real rest = g[0] * g[1] - g[2] * g[2], square = rest + change;
      const real n[3] = {g[1] + d[1], g[0] + d[0], -2 * (g[2] + d[2])};
#if RUBBER
      if (q[8] + q[9] > 0) {
        EACH(e) x[e] = rate[e];
        if (elastic) energy += rubber(d, g, q + 8, on);
      } else
#endif
      if (elastic) {
        const real now = root(square), more = change / (now + root(rest));
        t = q[0] * more / (2 * now), energy += q[0] * more * more / 2;
        energy += (q[1] * d[0] * d[0] + q[2] * d[1] * d[1] + q[3] * d[2] * d[2]) / 2;
        energy += q[4] * d[0] * d[1] + q[5] * d[0] * d[2] + q[6] * d[1] * d[2];
      }
      if (DAMPED) t += q[0] * dot(n, rate) / (4 * square);
      on[0] += t * n[0] + q[1] * x[0] + q[4] * x[1] + q[5] * x[2], on[1] += t * n[1] + q[4] * x[0] + q[2] * x[1] + q[6] * x[2];
      on[2] += t * n[2] + q[5] * x[0] + q[6] * x[1] + q[3] * x[2];
    }
    real by[4][3];
    EACH(e) {
      const real share = (real)1 / (real)(2 * p), warp = RUBBER ? 4 * on[3] * dq[e] : 0;
      const real fa = 2 * on[0] * a[e] + on[2] * b[e], fb = 2 * on[1] * b[e] + on[2] * a[e];
      by[0][e] = share * (warp - fa - fb), by[1][e] = share * (fa - fb - warp);
      by[2][e] = share * (warp + fa + fb), by[3][e] = share * (fb - fa - warp);
    }
    for (int o = 0; o < 4; o++)
      for (int n = o * p; n < o * p + p; n++) EACH(e) s->f[c[n]][e] += by[o][e];
  }
  return energy;
}
$patch
static void push(sheet *s, int m, const real on[3]) { /* a point of the sheet, with an obstacle's force */
  EACH(e) s->pressed[POINT_BODY[m] + SHEET_SUPPORTS][e] += on[e];
  for (int n = 0; n < 4 * P; n++) EACH(e) s->f[POINT_AT[m][n / P] + n % P][e] -= POINT_ROW[POINT_OF[m]][n / P] * on[e] * PART;
}
static real contact(sheet *s) { /* adds to f what obstacles press with; returns the energy */
  real energy = 0;
  for (int m = 0; m < POINTS; m++) {
    const int o = POINT_BODY[m];
    const real *k = POINT_ROW[POINT_OF[m]], *body = OBSTACLE[o]; /* shares of columns, offset, stiffness, rounded depth */
    real *to = s->touch[m], x[3], y[3]; /* -d depth/dx, depth, load, load as friction has it */
    const int is_round = body[6] > 0; /* of planes the offset is from where the point rests */
    EACH(e) y[e] = (is_round ? -body[e] : 0) - s->place[o + SHEET_SUPPORTS][e];
    for (int c = 0; c < 4; c++) {
      if (k[c] != 0) column(s, POINT_AT[m][c], (real)is_round, x);
      if (k[c] != 0) EACH(e) y[e] += k[c] * x[e];
    }
    const real along = dot(y, body + 3), reach = k[4] + body[6];
    EACH(e) y[e] -= is_round ? along * body[3 + e] : 0;
    EACH(e) to[e] = is_round ? y[e] / reach : body[3 + e];
    to[3] = is_round ? (reach - dot(y, y) / reach) / 2 : k[4] - along, to[4] = to[5] = 0;
    if (is_round || to[3] <= 0) continue;
    const real curved = to[3] < k[6] ? to[3] : k[6], sure = to[3] > k[6] ? to[3] - k[6] : 0;
    to[4] = to[5] = k[5] * (curved * curved / (2 * k[6]) + sure);
    energy += k[5] * (curved * curved * curved / (6 * k[6]) + sure * (sure + k[6]) / 2);
  }
#if PATCHES
  for (int m = 0; m < PATCHES; m++) energy += patch(s, PATCH[m]);
#endif
  for (int m = 0; m < POINTS; m++) {
    const real load = s->touch[m][4], on[3] = {load * s->touch[m][0], load * s->touch[m][1], load * s->touch[m][2]};
    if (load != 0) push(s, m, on);
  }
  return energy;
}
static void resist(sheet *s, field velocity, real sign) { /* adds to f, so many times, what resists a velocity beside springs */
  if (RATED) MASSES(i) EACH(e) s->f[i][e] += sign * RATE[i] * velocity[i][e];
  for (int i = 0; i < DRAGGED; i++) {
    const real *area = s->area[i], size = root(dot(area, area)), speed = size > 0 ? dot(velocity[i], area) / size : 0;
    EACH(e) s->f[i][e] += sign * DRAG * (speed < 0 ? -speed : speed) * speed * area[e];
  }
  for (int m = 0; m < POINTS; m++) {
    const int o = POINT_BODY[m];
    const real *to = s->touch[m], *k = POINT_ROW[POINT_OF[m]], size = root(dot(to, to)), tau = OBSTACLE[o][7];
    if (to[5] == 0) continue;
    real y[3], on[3], slip = (real)$slip;
    EACH(e) y[e] = -s->rate[o + SHEET_SUPPORTS][e];
    for (int n = 0; n < 4 * P; n++) EACH(e) y[e] += k[n / P] * velocity[POINT_AT[m][n / P] + n % P][e] * PART;
    const real leaving = dot(y, to) / size, along = to[5] * (tau * leaving < 1 ? tau * leaving : 1);
    EACH(e) y[e] -= leaving * to[e] / size, slip += y[e] * y[e];
    EACH(e) on[e] = -sign * (along * to[e] / size + OBSTACLE[o][8] * to[5] / root(slip) * y[e]);
    push(s, m, on);
  }
}
static void forces(sheet *s) { /* of all that acts, inwards, at the velocity w */
  real factor[HISTORIES];
  for (int n = 0; n < HISTORIES; n++) factor[n] = HISTORY[n] < 0 ? 1 : course(HISTORY[n], s->time, 0);
  MASSES(i) EACH(e) s->f[i][e] = -WEIGHT[i] * s->gravity[e];
  for (int b = 0; b < SHEET_BODIES; b++) EACH(e) s->pressed[b][e] = 0;
  for (int p = 0; p < SHEET_POINTS; p++)
    for (int n = NEAR[p]; n < NEAR[p + 1]; n++) EACH(e) s->f[NEAR_AT[n]][e] -= NEAR_SHARE[n] * s->force[p][e];
  for (int n = 0; n < STILL; n++) s->f[LOAD_AT[n][0]][LOAD_AT[n][1]] -= LOAD[n];
  s->fallen = 0;
  MASSES(i) EACH(e) s->fallen += s->f[i][e] * s->u[i][e];
  for (int n = STILL; n < LOADS; n++) s->f[LOAD_AT[n][0]][LOAD_AT[n][1]] -= LOAD[n] * factor[LOAD_PART[n]];
  for (int m = 0; m < PRESSES; m++) press(s, PRESS_AT[m], -PRESS[m] * factor[PRESS_PART[m]], s->f);
  for (int m = 0; m < COUPLES; m++) { /* an edge's moment, about the chord of the columns beside */
    const entry *c = COUPLE_AT[m];
    real x[3], t[3], d[3], on[3];
    column(s, c[1], 1, x), column(s, c[2], 1, t);
    EACH(e) t[e] -= x[e], d[e] = SHEET_REST[c[0] + P - 1][e] + s->u[c[0] + P - 1][e] - SHEET_REST[c[0]][e] - s->u[c[0]][e];
    cross(t, d, on);
    const real scale = COUPLE[m] * factor[COUPLE_PART[m]] / (root(dot(t, t)) * dot(d, d));
    EACH(e) s->f[c[0] + P - 1][e] -= scale * on[e], s->f[c[0]][e] += scale * on[e];
  }
  for (int i = 0; i < DRAGGED; i++) EACH(e) s->area[i][e] = 0;
  for (int m = 0; m < DRAG_CELLS; m++) press(s, DRAG_AT[m], DRAG_SHARE[m], s->area);
  for (int i = 0; i < DRAGGED; i++) EACH(e) s->area[i][e] *= DRAG_WEIGHT[i];
  s->stored = springs(s, s->w, 1), s->stored += contact(s), resist(s, s->w, 1);
}
static real across(field x, int i, int e, int from) { /* a row of a column's inverse, from P on of its matrix, of masses */
  const real *row = COLUMN_ROW[COLUMN_OF[i / P * 3 + e]] + (from + i % P) * P;
  real sum = 0;
  for (int q = 0; q < P; q++) sum += row[q] * x[i - i % P + q][e];
  return sum;
}
static void accelerate(sheet *s, real half) { /* and v by half a step of it */
  MASSES(i) EACH(e) s->a[i][e] = -across(s->f, i, e, 0), s->v[i][e] += half * s->a[i][e];
}
static void follow(sheet *s) { /* histories of natural states */
  int new = 0;
  for (int k = 0; k < SHEET_SOURCES; k++)
    if (!s->set[k] && SOURCE_COURSE[k] >= 0) s->factor[k] = course(SOURCE_COURSE[k], s->time, 0), new = 1;
  if (new) grow(s);
}
static void move(sheet *s, real h) { /* supports and obstacles, a step on, with the masses that they hold */
  for (int b = 0; b < SHEET_BODIES; b++) {
    if (!s->moved[b] && MOTION[b] < 0) continue;
    EACH(e) {
      const real before = s->place[b][e] + h * s->rate[b][e], rate = s->rate[b][e];
      if (s->moved[b]) s->place[b][e] = s->moved[b] == 2 ? s->target[b][e] : before, s->rate[b][e] = s->aimed[b][e], s->bend[b][e] = 0;
      else {
        s->place[b][e] = course(MOTION[b] + e, s->time, 0), s->rate[b][e] = course(MOTION[b] + e, s->time, 1);
        s->bend[b][e] = course(MOTION[b] + e, s->time, 2);
      }
      MASSES(i) if (OWNER[i][e] == b + 1) s->u[i][e] += s->place[b][e] - before, s->v[i][e] += s->rate[b][e] - rate;
    }
    if (s->moved[b]) s->moved[b] = 1;
  }
}
void sheet_reset(sheet *s) {
  static const real gravity[3] = $gravity;
  for (unsigned n = 0; n < sizeof *s; n++) ((unsigned char *)s)[n] = 0;
  s->step = SHEET_STEP;
  for (int k = 0; k < SHEET_SOURCES; k++) s->factor[k] = 1;
  EACH(e) s->gravity[e] = gravity[e];
  grow(s), follow(s), move(s, 0);
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
    s->time += h;
    move(s, h), follow(s), forces(s), accelerate(s, h / 2);
    if (DAMPED + RATED + DRAGGED + POINTS == 0) continue;
    resist(s, s->w, -1), resist(s, s->v, 1);
    MASSES(i) EACH(e) s->w[i][e] = s->v[i][e] - s->w[i][e];
    if (DAMPED) springs(s, s->w, 0);
    accelerate(s, 0);
  }
}
void sheet_set_force(sheet *s, int point, const real force[3]) { EACH(e) s->force[point][e] = force[e]; }
void sheet_set_curvature(sheet *s, int source, real factor) { s->factor[source] = factor, s->set[source] = 1, grow(s); }
void sheet_move_support(sheet *s, int body, const real displacement[3], const real velocity[3]) {
  EACH(e) s->target[body][e] = displacement[e], s->aimed[body][e] = velocity[e];
  s->moved[body] = 2;
}
void sheet_probe(const sheet *s, int point, real displacement[3]) {
  EACH(e) displacement[e] = 0;
  for (int n = PROBE[point]; n < PROBE[point + 1]; n++) EACH(e) displacement[e] += PROBE_SHARE[n] * s->u[PROBE_AT[n]][e];
}
void sheet_reaction(sheet *s, int body, real force[3]) {
  MASSES(i) EACH(e) s->w[i][e] = s->a[i][e] + (OWNER[i][e] ? s->bend[OWNER[i][e] - 1][e] : 0);
  EACH(e) {
    force[e] = s->pressed[body][e];
    for (int n = SUMMED[3 * body + e]; n < SUMMED[3 * body + e + 1]; n++)
      force[e] += SUMMED_SHARE[n] * (across(s->w, (int)SUMMED_AT[n] / 3, e, P) + s->f[SUMMED_AT[n] / 3][e]);
  }
}
real sheet_energy(sheet *s, int kind) {
  real sum = kind == SHEET_ELASTIC ? s->stored : kind == SHEET_POTENTIAL ? s->fallen : 0;
  if (kind == SHEET_KINETIC) MASSES(i) EACH(e) sum += s->v[i][e] * across(s->v, i, e, P) / 2;
  return sum;
}
