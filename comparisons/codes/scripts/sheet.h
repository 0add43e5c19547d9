/* $title
   Written by sheetbench $version; C99, no library but $libm, no allocation, no globals. SI units; x, y in the sheet, z up.
   cc -O3 main.c sheet.c -lm && ./a.out    steps a sheet and compares it with check.csv of sheetbench's own steps */
#ifndef SHEET_H
#define SHEET_H
#ifdef __cplusplus
extern "C" {
#endif
typedef $real sheet_real;
enum { $numbers };
#define SHEET_STEP $step /* s; the limit about the start is $largest s, this is $safety of it, tried over $steps steps; large
   tension or stretch wants shorter ones */
/* numbers of inputs: forces [N] of points by x, y, z, gravity [m/s^2], factors of natural states */
enum { SHEET_GRAVITY = 3 * SHEET_POINTS, SHEET_FACTORS = SHEET_GRAVITY + 3, SHEET_INPUTS = SHEET_FACTORS + SHEET_SOURCES };
/* of outputs, the columns of check.csv behind time: displacements [m] of points, forces [N] of bodies, energies [J] */
enum { SHEET_REACTIONS = 3 * SHEET_POINTS, SHEET_ENERGIES = SHEET_REACTIONS + 3 * SHEET_BODIES, SHEET_OUTPUTS = SHEET_ENERGIES + 3 };
enum { SHEET_KINETIC, SHEET_ELASTIC, SHEET_POTENTIAL }; /* potential: of gravity and forces that do not follow */
/* one sheet; several may be in one program; rows of masses, layer by layer in a column, then of columns' middles */
typedef struct {
  double time;                                /* s */
  sheet_real step, input[SHEET_INPUTS + SHEET_LOADS]; /* s, may be shorter than SHEET_STEP; gravity may be written to */
  double u[SHEET_ROWS][3], v[SHEET_ROWS][3], a[SHEET_MASSES][3]; /* m, m/s, m/s^2; in double numbers always */
  double f[SHEET_ROWS][3], w[SHEET_ROWS][3], area[SHEET_AIR + 1][3], stored, fallen; /* the rest is the steps' own */
  sheet_real touch[SHEET_CONTACTS + 1][6], grown[SHEET_GROWN + 1];
  double path[SHEET_BODIES + 1][3][3], pressed[SHEET_BODIES + 1][3];
  unsigned char moved[SHEET_BODIES + 1], set[SHEET_SOURCES + SHEET_LOADS + 1], changed;
} sheet;
extern const sheet_real SHEET_REST[SHEET_ROWS][3]; /* m: places at rest, columns along x first */

void sheet_reset(sheet *s);           /* to the start at t = 0; before anything else */
void sheet_step(sheet *s, int count); /* so many steps of s->step */
void sheet_set(sheet *s, int input, sheet_real value); /* from now on, in place of a history; forces are beside the scene's loads */
sheet_real sheet_get(sheet *s, int output);
void sheet_set_force(sheet *s, int point, const sheet_real force[3]);
void sheet_set_curvature(sheet *s, int source, sheet_real factor); /* times the scene's natural strain and curvature */
/* where a support or obstacle is at the end of the next step, beside its rest, and its velocity from then on */
void sheet_move_support(sheet *s, int body, const sheet_real displacement[3], const sheet_real velocity[3]);
void sheet_probe(sheet *s, int point, sheet_real displacement[3]);
void sheet_reaction(sheet *s, int body, sheet_real force[3]); /* of a support or obstacle on the sheet */
sheet_real sheet_energy(sheet *s, int kind);                  /* J, of the last step */
#ifdef __cplusplus
}
#endif
#endif
