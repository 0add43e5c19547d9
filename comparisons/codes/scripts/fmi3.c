/* The sheet as an FMI 3.0 co-simulation unit: a value's number is its place among time, inputs and outputs. */
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
enum { OK = 0, ERROR = 3 };
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
API int fmi3Reset(void *u) { return sheet_reset(&((unit *)u)->s), ((unit *)u)->now = 0, OK; }
API int fmi3SetFloat64(void *u, const number *at, size_t count, const double *x, size_t values) {
  for (size_t k = 0; k < count; k++) {
    if (at[k] < 1 || at[k] > SHEET_INPUTS) return ERROR;
    sheet_set(u, (int)at[k] - 1, (sheet_real)x[k]);
  }
  return OK;
}
API int fmi3GetFloat64(void *of, const number *at, size_t count, double *x, size_t values) {
  unit *u = of;
  for (size_t k = 0; k < count; k++) {
    const int n = (int)at[k] - 1;
    if (n >= SHEET_INPUTS + SHEET_OUTPUTS) return ERROR;
    x[k] = n < 0 ? u->now : (double)(n < SHEET_INPUTS ? u->s.input[n] : sheet_get(&u->s, n - SHEET_INPUTS));
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
#define DONE(name) API int fmi3##name(void) { return OK; }
DONE(ExitInitializationMode) DONE(Terminate) DONE(SetDebugLogging)
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
