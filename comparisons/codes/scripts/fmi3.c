/* The sheet as an FMI 3.0 co-simulation unit: a value's number is its place among time, forces, gravity, factors of
   natural states, displacements, reactions, energies. */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include "sheet.h"
#ifdef _WIN32
#define API __declspec(dllexport)
#else
#define API __attribute__((visibility("default")))
#endif
enum { OK = 0, ERROR = 3, FORCES = 1, GRAVITY = FORCES + 3 * SHEET_POINTS, FACTORS = GRAVITY + 3 };
enum { OUTPUTS = FACTORS + SHEET_SOURCES, REACTIONS = OUTPUTS + 3 * SHEET_POINTS };
enum { ENERGIES = REACTIONS + 3 * SHEET_BODIES, ALL = ENERGIES + 3 };
typedef struct { sheet s; double now; } unit;
typedef unsigned number;
API const char *fmi3GetVersion(void) { return "3.0"; }
API void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *path, bool visible, bool log, bool events,
    bool early, const number *between, size_t count, void *environment, void *logged, void *updated) {
  unit *u = calloc(1, sizeof *u);
  if (u) sheet_reset(&u->s);
  return u;
}
API void fmi3FreeInstance(void *u) { free(u); }
API int fmi3EnterInitializationMode(void *u, bool given, double tolerance, double start, bool ends, double stop) {
  return ((unit *)u)->now = start, OK;
}
API int fmi3ExitInitializationMode(void *u) { return u ? OK : ERROR; }
API int fmi3Terminate(void *u) { return u ? OK : ERROR; }
API int fmi3Reset(void *u) { return sheet_reset(&((unit *)u)->s), ((unit *)u)->now = 0, OK; }
API int fmi3SetDebugLogging(void *u, bool on, size_t count, const char *const *of) { return u ? OK : ERROR; }
static sheet_real *input(sheet *s, int n) {
  if (n < GRAVITY) return &s->force[(n - FORCES) / 3][(n - FORCES) % 3];
  return n < FACTORS ? &s->gravity[n - GRAVITY] : &s->factor[n - FACTORS];
}
API int fmi3SetFloat64(void *of, const number *at, size_t count, const double *x, size_t values) {
  for (size_t k = 0; k < count; k++) {
    const int n = (int)at[k];
    if (n < FORCES || n >= OUTPUTS) return ERROR;
    if (n < FACTORS) *input(of, n) = (sheet_real)x[k];
    else sheet_set_curvature(of, n - FACTORS, (sheet_real)x[k]);
  }
  return OK;
}
API int fmi3GetFloat64(void *of, const number *at, size_t count, double *x, size_t values) {
  sheet *s = of;
  for (size_t k = 0; k < count; k++) {
    const int n = (int)at[k];
    sheet_real three[3];
    if (n >= ALL) return ERROR;
    if (n == 0) x[k] = ((unit *)of)->now;
    else if (n < OUTPUTS) x[k] = (double)*input(s, n);
    else if (n < REACTIONS) sheet_probe(s, (n - OUTPUTS) / 3, three), x[k] = (double)three[(n - OUTPUTS) % 3];
    else if (n < ENERGIES) sheet_reaction(s, (n - REACTIONS) / 3, three), x[k] = (double)three[(n - REACTIONS) % 3];
    else x[k] = (double)sheet_energy(s, n - ENERGIES);
  }
  return OK;
}
API int fmi3DoStep(void *of, double now, double h, bool keep, bool *event, bool *ends, bool *early, double *last) {
  unit *u = of; /* as many steps of one length as it takes, none above SHEET_STEP */
  const int count = (int)ceil(h / (double)SHEET_STEP - 1e-9);
  if (count > 0) u->s.step = (sheet_real)(h / count), sheet_step(&u->s, count);
  *event = *ends = *early = false, *last = u->now = now + h;
  return isfinite((double)sheet_energy(&u->s, SHEET_KINETIC)) ? OK : ERROR;
}
/* what a unit of this kind is not called for */
#define NOT(name) API int fmi3##name(void) { return ERROR; }
#define BOTH(kind) NOT(Get##kind) NOT(Set##kind)
BOTH(Float32) BOTH(Int8) BOTH(UInt8) BOTH(Int16) BOTH(UInt16) BOTH(Int32) BOTH(UInt32) BOTH(Int64) BOTH(UInt64)
BOTH(Boolean) BOTH(String) BOTH(Binary) BOTH(Clock) BOTH(FMUState) BOTH(IntervalDecimal) BOTH(IntervalFraction)
BOTH(ShiftDecimal) BOTH(ShiftFraction) BOTH(ContinuousStates) NOT(ActivateModelPartition) NOT(CompletedIntegratorStep)
NOT(EnterConfigurationMode) NOT(ExitConfigurationMode) NOT(EnterContinuousTimeMode) NOT(EnterEventMode) NOT(EnterStepMode)
NOT(EvaluateDiscreteStates) NOT(UpdateDiscreteStates) NOT(GetAdjointDerivative) NOT(GetDirectionalDerivative)
NOT(GetContinuousStateDerivatives) NOT(GetNominalsOfContinuousStates) NOT(GetEventIndicators) NOT(FreeFMUState)
NOT(SerializedFMUStateSize) NOT(SerializeFMUState) NOT(DeserializeFMUState) NOT(GetNumberOfContinuousStates)
NOT(GetNumberOfEventIndicators) NOT(GetNumberOfVariableDependencies) NOT(GetVariableDependencies) NOT(GetOutputDerivatives)
NOT(SetTime)
API void *fmi3InstantiateModelExchange(void) { return NULL; }
API void *fmi3InstantiateScheduledExecution(void) { return NULL; }
