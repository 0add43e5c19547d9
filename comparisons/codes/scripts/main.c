/* Steps the sheet and compares it with check.csv, what sheetbench's own steps found. Status 0: all alike. */
#include <stdio.h>
#include "sheet.h"
enum { COUNT = 3 * (SHEET_POINTS + SHEET_BODIES) + 3 };
int main(int words, char **word) {
  static sheet s;
  static const char *const name[3] = {"displacement", "force", "energy"};
  double peak[3] = {0, 0, 0}, off[3] = {0, 0, 0}, at = 0;
  int rows = 0, held = 1, letter;
  FILE *file = fopen(words > 1 ? word[1] : "check.csv", "r");
  if (!file) return fprintf(stderr, "no check.csv\n"), 2;
  while ((letter = fgetc(file)) != '\n' && letter != EOF) continue;
  sheet_reset(&s);
  for (; fscanf(file, "%lf", &at) == 1; rows++) {
    while ((double)s.time + (double)s.step / 2 < at) sheet_step(&s, 1);
    for (int n = 0; n < COUNT; n++) {
      const int kind = n < 3 * SHEET_POINTS ? 0 : n < COUNT - 3 ? 1 : 2;
      sheet_real three[3];
      double known = 0, gap;
      if (kind == 0) sheet_probe(&s, n / 3, three);
      else if (kind == 1) sheet_reaction(&s, n / 3 - SHEET_POINTS, three);
      else three[n % 3] = sheet_energy(&s, n % 3);
      if (fscanf(file, ",%lf", &known) != 1) return fprintf(stderr, "check.csv breaks off\n"), 2;
      gap = (double)three[n % 3] > known ? (double)three[n % 3] - known : known - (double)three[n % 3];
      if (!(gap <= off[kind])) off[kind] = gap;
      if (known > peak[kind] || -known > peak[kind]) peak[kind] = known > 0 ? known : -known;
    }
  }
  for (int k = 0; k < 3; k++) {
    printf("%s: off by %.2g of %.3g\n", name[k], off[k], peak[k]);
    held = held && off[k] <= (sizeof(sheet_real) == 8 ? 1e-8 : k == 1 ? 0.1 : 1e-3) * peak[k]; /* rounding grows */
  }
  printf("%d moments until %g s: %s\n", rows, at, held && rows > 1 ? "as check.csv has it" : "NOT as check.csv has it");
  return !(held && rows > 1);
}
