"""A PI controller holds the tip of a sheet: python docs/hold_tip.py tip/sheet.fmu"""

import sys

import fmpy

path, wanted, h = sys.argv[1], -0.010, 1e-3  # m, s
about = fmpy.read_model_description(path)
number = {v.name: v.valueReference for v in about.modelVariables}
unit = fmpy.instantiate_fmu(fmpy.extract(path), about)
unit.enterInitializationMode()
unit.exitInitializationMode()
proportional, integral, summed, time = 1.0, 20.0, 0.0, 0.0  # N/m, N/(m s)
while time < 6.0:
    (tip,) = unit.getFloat64([number["tip.uz"]])
    summed += (wanted - tip) * h
    force = proportional * (wanted - tip) + integral * summed
    unit.setFloat64([number["tip.Fz"]], [force])
    unit.doStep(currentCommunicationPoint=time, communicationStepSize=h)
    time += h
unit.terminate()
unit.freeInstance()
print(f"tip at {1e3 * tip:.2f} mm where {1e3 * wanted:.2f} mm were wanted, held by {force:.4f} N")
