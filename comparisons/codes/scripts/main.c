/* Steps the sheet and compares it with check.csv, what sheetbench's own steps found. Status 0: all alike. */
#include <math.h>
#include <stdio.h>
#include "sheet.h"
int main(int words, char **word) {
  static sheet s;
  static const char *const name[3] = {"displacement", "force", "energy"};
  double peak[3] = {0, 0, 0}, off[3] = {0, 0, 0}, at = 0, known = 0;
  int rows = 0, held = 1;
  FILE *file = fopen(words > 1 ? word[1] : "check.csv", "r");
  if (!file || fscanf(file, "%*[^\n]") == EOF) return fprintf(stderr, "no check.csv\n"), 2;
  sheet_reset(&s);
  for (; fscanf(file, "%lf", &at) == 1; rows++) {
    while (s.time + (double)s.step / 2 < at) sheet_step(&s, 1);
    for (int n = 0; n < SHEET_OUTPUTS; n++) {
      const int kind = n < SHEET_REACTIONS ? 0 : n < SHEET_ENERGIES ? 1 : 2;
      if (fscanf(file, ",%lf", &known) != 1) return fprintf(stderr, "check.csv breaks off\n"), 2;
      const double gap = fabs((double)sheet_get(&s, n) - known);
      if (!(gap <= off[kind])) off[kind] = gap;
      if (fabs(known) > peak[kind]) peak[kind] = fabs(known);
    }
  }
  for (int k = 0; k < 3; k++) {
    printf("%s: off by %.2g of %.3g\n", name[k], off[k], peak[k]);
    held = held && off[k] <= (sizeof(sheet_real) == 8 ? 1e-8 : k == 1 ? 0.1 : 1e-3) * peak[k]; /* rounding grows */
  }
  printf("%d moments until %g s: %s\n", rows, at, held && rows > 1 ? "as check.csv has it" : "NOT as check.csv has it");
  return !(held && rows > 1);
}
