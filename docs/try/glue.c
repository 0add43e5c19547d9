/* What the page calls of a sheet. */
#include "sheet.h"
static sheet s;
#define OUT(name) __attribute__((export_name(#name)))
OUT(reset) void reset(void) { sheet_reset(&s); }
OUT(step) void step(int count) { sheet_step(&s, count); }
OUT(force) void force(int p, double x, double y, double z) { const double f[3] = {x, y, z}; sheet_set_force(&s, p, f); }
OUT(gravity) void gravity(double z) { s.gravity[2] = z; }
OUT(slow) void slow(double by) { for (int i = 0; i < SHEET_MASSES; i++) for (int e = 0; e < 3; e++) s.v[i][e] *= by; }
OUT(probe) double probe(int p, int axis) { double u[3]; sheet_probe(&s, p, u); return u[axis]; }
OUT(place) double place(int column, int axis) {
  double sum = 0;
  for (int q = 0; q < SHEET_LAYERS; q++) sum += SHEET_REST[column * SHEET_LAYERS + q][axis] + s.u[column * SHEET_LAYERS + q][axis];
  return sum / SHEET_LAYERS; }
OUT(kinetic) double kinetic(void) { return sheet_energy(&s, SHEET_KINETIC); }
OUT(steps) double steps(void) { return SHEET_STEP; }
OUT(columns) int columns(void) { return SHEET_COLUMNS_X; }
