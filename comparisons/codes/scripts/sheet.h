/* $title
   Written by sheetbench $version; C99, no library but sqrt, no allocation. SI units, axes x, y, z. */
#ifndef SHEET_H
#define SHEET_H
#ifdef __cplusplus
extern "C" {
#endif
typedef $real sheet_real;
$names
#define SHEET_STEP $step /* s; the limit about the start is $largest s, this is $safety of it, tried over $steps steps */
enum { SHEET_MASSES = $masses, SHEET_LAYERS = $layers, SHEET_COLUMNS_X = $nx, SHEET_COLUMNS_Y = $ny };
enum { SHEET_KINETIC, SHEET_ELASTIC, SHEET_POTENTIAL }; /* energies */
/* one sheet; several may be in one program */
typedef struct {
  sheet_real time, step;                      /* s; a step may be shorter than SHEET_STEP */
  sheet_real gravity[3];                      /* m/s^2, may be written to */
  sheet_real u[SHEET_MASSES][3], v[SHEET_MASSES][3], a[SHEET_MASSES][3]; /* of the masses: m, m/s, m/s^2 */
  sheet_real f[SHEET_MASSES][3], w[SHEET_MASSES][3], stored, fallen; /* the rest is the steps' own */
  sheet_real area[$dragged][3], touch[$touching][6], grown[$grown]; /* of masses in air, points, links and cells */
  sheet_real force[SHEET_POINTS + 1][3];
  sheet_real place[SHEET_BODIES + 1][3], rate[SHEET_BODIES + 1][3], bend[SHEET_BODIES + 1][3];
  sheet_real target[SHEET_BODIES + 1][3], aimed[SHEET_BODIES + 1][3], pressed[SHEET_BODIES + 1][3];
  sheet_real factor[SHEET_SOURCES + 1];
  unsigned char moved[SHEET_BODIES + 1], set[SHEET_SOURCES + 1];
} sheet;
extern const sheet_real SHEET_REST[SHEET_MASSES][3]; /* m: layer by layer in a column, columns along x first */

void sheet_reset(sheet *s);           /* to the start at t = 0; before anything else */
void sheet_step(sheet *s, int count); /* so many steps of s->step on */
/* a force [N] at a point from now on, beside the scene's loads */
void sheet_set_force(sheet *s, int point, const sheet_real force[3]);
/* so many times the natural strain and curvature that the scene gives a source */
void sheet_set_curvature(sheet *s, int source, sheet_real factor);
/* where a support or obstacle is at the end of the next step, beside its rest, and its velocity from then on */
void sheet_move_support(sheet *s, int body, const sheet_real displacement[3], const sheet_real velocity[3]);
void sheet_probe(const sheet *s, int point, sheet_real displacement[3]);
void sheet_reaction(sheet *s, int body, sheet_real force[3]); /* of a support or obstacle on the sheet */
sheet_real sheet_energy(sheet *s, int kind); /* J, of the last step; potential: of gravity and forces that do not follow */
#ifdef __cplusplus
}
#endif
#endif
